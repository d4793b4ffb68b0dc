"""Reads recordings of a device, torn and damaged ones too."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from armik_sym.device.protocol import Frame, FrameParser
from armik_sym.device.recording.collector import Collector
from armik_sym.device.recording.device_recording import DeviceRecording
from armik_sym.errors import MotionFileError

_BLOCK = 1 << 18


def read_recording(path: str | os.PathLike[str]) -> DeviceRecording:
    """Read what `armik record` wrote: every frame that is whole, from wherever in the file.

    A file that was torn off, by kill -9 or a power cut, loses the frame that was being written. Bytes of the
    device that were captured by another program are read, too; they have no times of the host.

    Args:
        path: The recording, `.armikrec`.

    Returns:
        Samples in the order they came, and what is known about them.

    Raises:
        MotionFileError: If the file cannot be read, or holds neither a header nor any frame of a device.

    Source:
        None (this package); docs/device.md.
    """
    file = Path(path)
    parser = FrameParser(keep_others=True)
    collector = Collector()
    for frame in _frames(file, parser):
        collector.take(frame)
    # Where the file ends the last frame may be whole but for its delimiter.
    size, torn, damaged = parser.counts.bytes_read, parser.pending > 0, parser.counts.damaged
    for frame in parser.feed(b"\0"):
        collector.take(frame)
        torn = False
    counts = parser.counts
    if collector.header is None and not counts.samples and not counts.infos:
        raise MotionFileError(f"{file}: {_what_else(parser, size)}")
    return collector.recording(file, damaged + counts.malformed, counts.unknown_version, torn)


def _frames(file: Path, parser: FrameParser) -> Iterator[Frame]:
    try:
        with file.open("rb") as stream:
            while block := stream.read(_BLOCK):
                yield from parser.feed(block)
    except FileNotFoundError:
        raise MotionFileError(f"{file}: no such file") from None
    except OSError as error:
        raise MotionFileError(f"{file}: cannot be read: {error.strerror or error}") from None


def _what_else(parser: FrameParser, size: int) -> str:
    if not size:
        return "is empty: the recorder was ended before it wrote anything"
    if parser.counts.unknown_version:
        versions = ", ".join(map(str, sorted(parser.versions_seen)))
        return f"holds frames of protocol version {versions} only: read it with the package that wrote it"
    return "is no recording of a device: no frame in it is whole (expected a file written by armik record)"
