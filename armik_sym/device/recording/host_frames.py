"""What the recorder adds to a recording: frames like those of the device, of kinds no device sends.

All integers little endian; the first two bytes are version and kind, as in every frame.

    header (128)     u8 file version, u64 host clock [ns since 1970], u64 steady clock [ns],
                     8 bytes "armikrec"
    text piece (129) u8 topic, u16 piece, u16 pieces, up to 57 bytes of UTF-8
    stamp (130)      u64 host clock, u64 steady clock: when the bytes in front of it had been read
    gap (131)        u8 reason, u64 host clock, u64 steady clock: the line fell silent, or spoke again
    mark (132)       u8 warning, u8 channel, u32 sequence, u32 how many since the mark before, f32 value
    end (133)        u8 reason, u64 host clock, u64 steady clock, u64 samples, u64 lost, u64 damaged

The steady clock runs on when the host's clock is set; its zero means nothing.
"""

from __future__ import annotations

import struct
import time
from dataclasses import dataclass, fields
from enum import Enum
from typing import ClassVar, TypeAlias

from armik_sym.device.protocol import OtherFrame, encode_payload
from armik_sym.device.protocol.frames import FIRST_HOST_KIND, LONGEST_PAYLOAD, PREAMBLE, VERSION

MAGIC = b"armikrec"
FILE_VERSION = 1
_PIECE = struct.Struct("<BHH")
_PIECE_TEXT = LONGEST_PAYLOAD - PREAMBLE.size - _PIECE.size


class Topic(Enum):
    """What a text in a recording is about; the value is the one in the file."""

    PORT = 0
    PROGRAM = 1
    CALIBRATION = 2


class GapReason(Enum):
    """Why there is a gap, or that it ends; the value is the one in the file."""

    BACK = 0
    PORT_LOST = 1
    SILENCE = 2


class EndReason(Enum):
    """Why a recording ended; the value is the one in the file."""

    STOPPED = 0
    TIME_OVER = 1
    FAILED = 2


@dataclass(frozen=True, slots=True)
class Header:
    """First frame of a recording: its file version, and both clocks of the host, in [ns]."""

    file_version: int
    clock_ns: int
    steady_ns: int
    magic: bytes = MAGIC

    kind: ClassVar[int] = FIRST_HOST_KIND
    layout: ClassVar[struct.Struct] = struct.Struct("<BQQ8s")


@dataclass(frozen=True, slots=True)
class Stamp:
    """Both clocks of the host when all bytes in front of this frame had been read, in [ns]."""

    clock_ns: int
    steady_ns: int

    kind: ClassVar[int] = FIRST_HOST_KIND + 2
    layout: ClassVar[struct.Struct] = struct.Struct("<QQ")


@dataclass(frozen=True, slots=True)
class GapMark:
    """The line was lost, fell silent or came back; both clocks of the host, in [ns]."""

    reason: int
    clock_ns: int
    steady_ns: int

    kind: ClassVar[int] = FIRST_HOST_KIND + 3
    layout: ClassVar[struct.Struct] = struct.Struct("<BQQ")


@dataclass(frozen=True, slots=True)
class WarningMark:
    """Something odd in the counts: which warning, channel and sample, how often, and its value."""

    warning: int
    channel: int
    sequence: int
    times: int
    value: float

    kind: ClassVar[int] = FIRST_HOST_KIND + 4
    layout: ClassVar[struct.Struct] = struct.Struct("<BBIIf")


@dataclass(frozen=True, slots=True)
class EndMark:
    """Last frame of a recording that was ended, not torn off: why, when [ns], and what was counted."""

    reason: int
    clock_ns: int
    steady_ns: int
    samples: int
    lost: int
    damaged: int

    kind: ClassVar[int] = FIRST_HOST_KIND + 5
    layout: ClassVar[struct.Struct] = struct.Struct("<BQQQQQ")


@dataclass(frozen=True, slots=True)
class TextPiece:
    """A piece of a text: its topic, its number from 0, how many there are, and its bytes."""

    topic: int
    piece: int
    pieces: int
    text: bytes

    kind: ClassVar[int] = FIRST_HOST_KIND + 1


HostFrame: TypeAlias = Header | TextPiece | Stamp | GapMark | WarningMark | EndMark
_FIXED: dict[int, type[Header | Stamp | GapMark | WarningMark | EndMark]] = {
    each.kind: each for each in (Header, Stamp, GapMark, WarningMark, EndMark)
}


def clocks() -> tuple[int, int]:
    """Both clocks of the host.

    Returns:
        Nanoseconds since 1970, and of the clock that is never set.
    """
    return time.time_ns(), time.monotonic_ns()


def encode_host(frame: HostFrame) -> bytes:
    """A host frame as bytes of the file.

    Args:
        frame: The frame.

    Returns:
        Its bytes, both delimiters included.

    Raises:
        ProtocolError: If it does not fit a frame.

    Source:
        None (this package); docs/device.md.
    """
    head = PREAMBLE.pack(VERSION, frame.kind)
    if isinstance(frame, TextPiece):
        return encode_payload(head + _PIECE.pack(frame.topic, frame.piece, frame.pieces) + frame.text)
    values = [getattr(frame, each.name) for each in fields(frame)]
    return encode_payload(head + frame.layout.pack(*values))


def encode_text(topic: Topic, text: str) -> bytes:
    """A text of any length as frames, in pieces.

    Args:
        topic: What it is about.
        text: The text.

    Returns:
        The bytes of all its frames.

    Source:
        None (this package); docs/device.md.
    """
    data = text.encode("utf-8")
    pieces = [data[at : at + _PIECE_TEXT] for at in range(0, len(data), _PIECE_TEXT)] or [b""]
    return b"".join(
        encode_host(TextPiece(topic.value, number, len(pieces), piece)) for number, piece in enumerate(pieces)
    )


def decode_host(frame: OtherFrame) -> HostFrame | None:
    """What a frame of a recording says that is none of the device.

    Args:
        frame: A frame of kind 128 or above.

    Returns:
        The host frame; None if its kind is not known or its length is wrong, as a later version might write.

    Source:
        None (this package); docs/device.md.
    """
    if frame.kind == TextPiece.kind and len(frame.body) >= _PIECE.size:
        topic, piece, pieces = _PIECE.unpack_from(frame.body)
        return TextPiece(topic, piece, pieces, frame.body[_PIECE.size :])
    shape = _FIXED.get(frame.kind)
    if shape is None or len(frame.body) != shape.layout.size:
        return None
    return shape(*shape.layout.unpack(frame.body))
