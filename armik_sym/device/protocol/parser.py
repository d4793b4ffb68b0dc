"""From the bytes of a line, whatever happened to them, to the frames that came through whole."""

from __future__ import annotations

from dataclasses import dataclass

from armik_sym.device.protocol import checksum, cobs
from armik_sym.device.protocol.decode import decode_info, decode_sample
from armik_sym.device.protocol.frames import (
    KIND_INFO,
    KIND_SAMPLE,
    LONGEST_PAYLOAD,
    PREAMBLE,
    VERSION,
    Frame,
    OtherFrame,
)

LONGEST_CHUNK = LONGEST_PAYLOAD + checksum.SIZE + 1
"""Bytes between two delimiters, at most; COBS adds one."""


@dataclass(slots=True)
class ParserCounts:
    """What a parser has seen so far. A chunk is what lies between two delimiters, if it is not empty.

    Attributes:
        samples: Samples handed out.
        infos: Infos handed out.
        damaged: Chunks that are no frame: too long, wrongly stuffed, or with a wrong checksum.
        malformed: Right checksum, but the content contradicts itself: an error of the sender.
        unknown_version: Right checksum, another version of the protocol.
        unknown_kind: Right checksum and version, a kind this version does not know.
        bytes_read: Bytes fed.
        bytes_dropped: Bytes of damaged chunks, and those in front of the first delimiter.
    """

    samples: int = 0
    infos: int = 0
    damaged: int = 0
    malformed: int = 0
    unknown_version: int = 0
    unknown_kind: int = 0
    bytes_read: int = 0
    bytes_dropped: int = 0


class FrameParser:
    """Takes bytes as they come, hands out frames; never raises, and holds at most 69 bytes.

    Bytes in front of the first delimiter are the rest of a frame that began before the line was opened:
    they are dropped, and do not count as damaged.

    Attributes:
        counts: What was seen so far.
        versions_seen: Versions of the protocol met in frames with a right checksum.
    """

    def __init__(self, keep_others: bool = False) -> None:
        """Start without a delimiter seen.

        Args:
            keep_others: Hand out frames of unknown kind too, as `OtherFrame`; they are counted always.
        """
        self.counts = ParserCounts()
        self.versions_seen: set[int] = set()
        self._keep_others = keep_others
        self._chunk = b""
        self._searching = True

    @property
    def pending(self) -> int:
        """Bytes held back: those behind the latest delimiter that may become a frame, at most 69."""
        return len(self._chunk)

    def feed(self, data: bytes) -> list[Frame]:
        """Take the next bytes.

        Args:
            data: Bytes as they came, cut anywhere.

        Returns:
            The frames these bytes completed, in their order.

        Source:
            None (this package); docs/device_protocol.md.
        """
        self.counts.bytes_read += len(data)
        pieces = bytes(data).split(b"\0")
        self._take(pieces[0])
        if len(pieces) == 1:
            return []
        last = pieces[-1]
        pieces[0] = self._chunk
        pieces.pop()
        self._chunk, self._searching = b"", False
        frames = [frame for piece in pieces if piece and (frame := self._frame(piece)) is not None]
        self._take(last)
        return frames

    def restart(self) -> None:
        """Forget the bytes held back, as after a line was closed; they count as dropped."""
        self.counts.bytes_dropped += len(self._chunk)
        self._chunk, self._searching = b"", True

    def _take(self, piece: bytes) -> None:
        """Hold bytes back until their delimiter comes, or drop them if they are too many."""
        if self._searching:
            self.counts.bytes_dropped += len(piece)
            return
        self._chunk += piece
        if len(self._chunk) > LONGEST_CHUNK:
            self._damaged(len(self._chunk))
            self._chunk, self._searching = b"", True

    def _damaged(self, length: int) -> None:
        self.counts.damaged += 1
        self.counts.bytes_dropped += length

    def _frame(self, chunk: bytes) -> Frame | None:
        """What a chunk says, if it is a frame."""
        sealed = cobs.decode(chunk) if len(chunk) <= LONGEST_CHUNK else None
        payload = checksum.unseal(sealed) if sealed is not None else None
        if payload is None:
            self._damaged(len(chunk))
            return None
        return self._read(payload)

    def _read(self, payload: bytes) -> Frame | None:
        """What a payload says; its checksum is right."""
        counts = self.counts
        if len(payload) < PREAMBLE.size:
            counts.malformed += 1
            return None
        version, kind = PREAMBLE.unpack_from(payload)
        self.versions_seen.add(version)
        if version != VERSION:
            counts.unknown_version += 1
            return None
        frame: Frame | None
        if kind == KIND_SAMPLE:
            frame = decode_sample(payload)
            counts.samples += frame is not None
        elif kind == KIND_INFO:
            frame = decode_info(payload)
            counts.infos += frame is not None
        else:
            counts.unknown_kind += 1
            return OtherFrame(kind, payload[2:]) if self._keep_others else None
        counts.malformed += frame is None
        return frame
