"""What a c3d file says about itself, checked before anything is sized by it."""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from armik_sym.errors import MotionFileError
from armik_sym.motion.c3d_parameters import BLOCK, Parameter, read_parameters

_MAGIC = 0x50
_PROCESSORS = {84: "<", 85: "<", 86: ">"}
_DEC = 85


@dataclass(frozen=True)
class C3DHeader:
    """The sizes of a c3d file that its length confirms.

    Attributes:
        points: Number of points in every frame.
        frames: Number of frames.
        first_frame: Number of the first frame, from 1.
        rate: Frames per second, in [Hz].
        parameters: The parameters by "GROUP:NAME".
        start: Byte at which the data start.
        analog: Number of analog values in every frame, after the points.
        scale: Length that 1 stands for if the data are whole numbers; negative if they are floating-point.
        order: Order of bytes, "<" or ">".
        dec: Whether floating-point numbers are those of DEC.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """

    points: int
    frames: int
    first_frame: int
    rate: float
    parameters: Mapping[str, Parameter]
    start: int
    analog: int
    scale: float
    order: str
    dec: bool


def read_c3d_header(path: Path) -> C3DHeader:
    """Read header and parameters of a c3d file and hold them against its length.

    frames · (points · 4 + analog) · bytes per value ≤ length of the file - start of the data.

    Args:
        path: The file.

    Returns:
        The sizes and parameters.

    Raises:
        MotionFileError: If the file is missing, unreadable, no c3d file, cut off, or a length field points
            out of it; names the byte.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """
    try:
        with path.open("rb") as file:
            size = file.seek(0, 2)
            return _checked(path, file, size)
    except FileNotFoundError:
        raise MotionFileError(f"{path}: no such file") from None
    except (OSError, ValueError) as error:
        if isinstance(error, MotionFileError):
            raise
        said = "is a folder, expected a file" if path.is_dir() else f"cannot be read: {error}"
        raise MotionFileError(f"{path}: {said}") from None


def _checked(path: Path, file: BinaryIO, size: int) -> C3DHeader:
    file.seek(0)
    head = file.read(BLOCK)
    if len(head) < 2 or head[1] != _MAGIC:
        said = f"byte 1 is 0x{head[1]:02x}" if len(head) > 1 else f"the file has {size} bytes"
        raise MotionFileError(f"{path}: {said}, expected 0x50: this is no c3d file")
    at = (head[0] - 1) * BLOCK
    if head[0] < 2 or at + BLOCK > size:
        raise MotionFileError(
            f"{path}: byte 0 puts the parameters at block {head[0]}, byte {at}, the file has {size} bytes: "
            "it is cut off or damaged"
        )
    file.seek(at + 3)
    processor = file.read(1)[0]
    if processor not in _PROCESSORS:
        raise MotionFileError(
            f"{path}: byte {at + 3}: processor type is {processor}, expected 84 (Intel), 85 (DEC) or "
            "86 (MIPS)"
        )
    order = _PROCESSORS[processor]
    points, analog, first, last = struct.unpack_from(f"{order}4H", head, 2)
    (data_block,) = struct.unpack_from(f"{order}H", head, 16)
    end = min(size, (data_block - 1) * BLOCK) if data_block > head[0] else size
    parameters = read_parameters(path, file, at, end, order, dec=processor == _DEC)
    scale = _number(path, parameters, "POINT:SCALE")
    rate = _number(path, parameters, "POINT:RATE")
    if not (math.isfinite(rate) and rate > 0):
        raise MotionFileError(f"{path}: POINT:RATE is {rate!r} Hz, expected a positive number")
    if not math.isfinite(scale) or scale == 0:
        raise MotionFileError(f"{path}: POINT:SCALE is {scale!r}, expected a number that is not 0")
    _same(path, "points", points, parameters, "POINT:USED", 2)
    _same(path, "first block of data", data_block, parameters, "POINT:DATA_START", 16)
    if points == 0:
        raise MotionFileError(f"{path}: byte 2: the file has no points, only analog channels or nothing")
    _check_analog(path, analog, struct.unpack_from(f"{order}H", head, 18)[0], parameters)
    start, frames = _frames(path, parameters, first, last)
    _check_length(path, size, data_block, frames, (points * 4 + analog) * (4 if scale < 0 else 2))
    place = ((data_block - 1) * BLOCK, analog, scale, order, processor == _DEC)
    return C3DHeader(points, frames, start, rate, parameters, *place)


def _number(path: Path, parameters: Mapping[str, Parameter], name: str) -> float:
    if name not in parameters or not parameters[name].numbers:
        raise MotionFileError(f"{path}: the parameter {name} is missing")
    return float(parameters[name].numbers[0])


def _same(
    path: Path, what: str, value: int, parameters: Mapping[str, Parameter], name: str, byte: int
) -> None:
    """Refuse a header and a parameter that contradict each other about the same number."""
    said = parameters.get(name)
    if said is None or not said.numbers:
        raise MotionFileError(f"{path}: the parameter {name} is missing")
    if _whole(path, name, said)[0] % 65536 != value:
        raise MotionFileError(
            f"{path}: byte {byte}: the header has {what} {value}, {name} (byte {said.at}) is "
            f"{said.numbers[0]:g}"
        )


def _check_analog(path: Path, values: int, per_frame: int, parameters: Mapping[str, Parameter]) -> None:
    """Analog values of a frame are channels times samples of each."""
    used = parameters.get("ANALOG:USED")
    channels = _whole(path, "ANALOG:USED", used)[0] % 65536 if used is not None and used.numbers else 0
    if values and channels * per_frame != values:
        raise MotionFileError(
            f"{path}: byte 4: the header has {values} analog values in a frame, but {channels} channels "
            f"(ANALOG:USED) of {per_frame} samples (byte 18)"
        )


def _frames(path: Path, parameters: Mapping[str, Parameter], first: int, last: int) -> tuple[int, int]:
    """First frame and number of frames; fields of 16 bits cannot tell more than 65535."""
    start, end = (_long(path, parameters, f"TRIAL:ACTUAL_{word}_FIELD") for word in ("START", "END"))
    if start and end >= start:
        count = end - start + 1
        if count != last - first + 1 and not (last == 65535 and count > 65535 - first):
            raise MotionFileError(
                f"{path}: byte 6: the header has frames {first} to {last}, TRIAL:ACTUAL_START_FIELD and "
                f"ACTUAL_END_FIELD say {start} to {end}"
            )
        return start, count
    if last < first:
        raise MotionFileError(f"{path}: byte 6: the last frame, {last}, is before the first, {first}")
    stated = parameters.get("POINT:FRAMES")
    if last == 65535 and stated is not None and stated.numbers and stated.numbers[0] > 0:
        return first, max(_whole(path, "POINT:FRAMES", stated)[0], 65536 - first)
    return first, last - first + 1


def _long(path: Path, parameters: Mapping[str, Parameter], name: str) -> int:
    """A number of 32 bits in two words; 0 if there is none."""
    parameter = parameters.get(name)
    if parameter is None or len(parameter.numbers) < 2:
        return 0
    low, high = (value % 65536 for value in _whole(path, name, parameter)[:2])
    return high * 65536 + low


def _whole(path: Path, name: str, parameter: Parameter) -> list[int]:
    """The values of a parameter that counts something."""
    if not all(math.isfinite(value) for value in parameter.numbers):
        raise MotionFileError(f"{path}: byte {parameter.at}: {name} is no number: the parameters are damaged")
    return [int(value) for value in parameter.numbers]


def _check_length(path: Path, size: int, block: int, frames: int, per_frame: int) -> None:
    start = (block - 1) * BLOCK
    if block < 2 or start >= size:
        raise MotionFileError(
            f"{path}: byte 16 puts the data at block {block}, byte {start}, the file has {size} bytes: it is "
            "cut off or damaged"
        )
    needed = start + frames * per_frame
    if needed > size:
        raise MotionFileError(
            f"{path}: the header promises {frames} frames of {per_frame} bytes from byte {start}, to byte "
            f"{needed}, the file has {size} bytes, {(size - start) // per_frame} frames: it is cut "
            "off or damaged"
        )
