"""Marker positions in `.c3d` files."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError, OptionError, UnitError
from armik_sym.motion.c3d_header import C3DHeader, read_c3d_header
from armik_sym.motion.c3d_points import read_points
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.nexus_csv import frame_numbers
from armik_sym.motion.promised_rows import warn
from armik_sym.motion.table_checks import check_table_names, errors_of_file
from armik_sym.motion.units import LENGTH_UNITS, length_unit

Array = NDArray[np.float64]

_LONGEST_NAME = 127
_WORDS = 2
# Normal 32-bit numbers.
_SMALLEST, _LARGEST = 1.2e-38, 3.4e38


def read_c3d(path: str | os.PathLike[str]) -> MarkerRecording:
    """Read the points of a `.c3d` file.

    All lengths the file states are held against its own length first. A point is missing where its
    residual is negative or a coordinate is NaN. t = (frame - 1) / rate. The rate is the shortest decimal
    that the file's 32-bit number stands for (59.94, not 59.93999863).

    Args:
        path: The file.

    Returns:
        The recording, in SI units, in the axes of the file.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or damaged; names the byte.
        UnitError: If it declares no unit of length, or an unknown one.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """
    file = Path(path)
    header = read_c3d_header(file)
    factor = _scale(file, header)
    names, odd = _names(file, header)
    position = read_points(file, header) / factor
    rate = float(str(np.float32(header.rate)))
    time = np.arange(header.first_frame - 1, header.first_frame - 1 + header.frames) / rate
    with errors_of_file(file):
        return MarkerRecording(np.asarray(time, dtype=np.float64), names, position, odd, file.name, rate)


def write_c3d(path: str | os.PathLike[str], recording: MarkerRecording, unit: str = "mm") -> None:
    """Write markers as a `.c3d` file; needs the package `ezc3d`.

    The format keeps positions and rate as 32-bit floating-point numbers (7 digits) and times as frame
    numbers. A gap gets the residual -1.

    Args:
        path: The file; its folder must exist.
        recording: The recording; its times must lie on a grid, frame = 1 + t·rate, without steps.
        unit: Unit to write lengths in, "m", "cm" or "mm".

    Raises:
        UnknownNameError: If the unit is another one.
        OptionError: If `ezc3d` is not installed.
        MotionFileError: If times lie between frames, a name cannot be written, or the file cannot.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """
    file, exponent = Path(path), length_unit(unit).shift
    check_table_names(file, recording.names, forbidden="\0")
    long = [name for name in recording.names if len(name.encode(errors="replace")) > _LONGEST_NAME]
    if long or len(recording.names) > 255:
        said = f"the name {long[0]!r} is too long" if long else f"{len(recording.names)} markers are too many"
        raise MotionFileError(f"{file}: {said}: at most 255 markers with {_LONGEST_NAME} bytes of name each")
    frames, rate = frame_numbers(file, recording)
    if frames[0] < 1 or frames[-1] - frames[0] + 1 != len(frames) or frames[-1] >= 2**31:
        raise MotionFileError(f"{file}: the frames {frames[0]} to {frames[-1]} have steps or start before 1")
    if not file.parent.is_dir():
        raise MotionFileError(f"{file}: cannot be written: there is no folder {file.parent}")
    missing = np.isnan(recording.position[..., 0])
    farthest = float(np.max(np.abs(recording.position[~missing]), initial=0.0)) * 10.0**-exponent
    if not (_SMALLEST <= rate <= _LARGEST and farthest <= _LARGEST):
        raise MotionFileError(
            f"{file}: the rate {rate:g} Hz or the coordinate {farthest:g} {unit} is no 32-bit number"
        )
    content = _ezc3d().c3d()
    point = content["parameters"]["POINT"]
    point["RATE"]["value"], point["UNITS"]["value"] = [rate], [unit]
    point["LABELS"]["value"] = tuple(recording.names)
    for word, frame in (("START", frames[0]), ("END", frames[-1])):
        low, high = frame % 65536, frame // 65536
        signed = [value - 65536 if value > 32767 else value for value in (low, high)]
        content.add_parameter("TRIAL", f"ACTUAL_{word}_FIELD", signed)
        # Added as floating-point numbers; the format wants two words of 16 bits.
        kept = content["parameters"]["TRIAL"][f"ACTUAL_{word}_FIELD"]
        kept["type"], kept["value"] = _WORDS, np.array(signed)
    values = np.ones((4, len(recording.names), recording.n))
    values[:3] = np.moveaxis(recording.position * 10.0**-exponent, (0, 1, 2), (2, 1, 0))
    content["data"]["points"] = values
    content["data"]["meta_points"]["residuals"] = np.where(missing.T, -1.0, 0.0)[None]
    content["data"]["meta_points"]["camera_masks"] = np.zeros((7, *missing.T.shape), dtype=bool)
    try:
        content.write(str(file))
    except (OSError, RuntimeError) as error:
        raise MotionFileError(f"{file}: cannot be written: {error}") from None


def _ezc3d() -> Any:
    try:
        import ezc3d
    except ImportError:
        raise OptionError(
            "writing c3d files needs the package ezc3d, which is not installed: pip install 'armik_sym[c3d]'"
        ) from None
    return ezc3d


def _scale(file: Path, header: C3DHeader) -> float:
    """What a length of the file is divided by to be in metres."""
    said = header.parameters.get("POINT:UNITS")
    unit = said.texts[0] if said is not None and said.texts else ""
    if unit.lower() not in LENGTH_UNITS:
        where = f"byte {said.at}: " if said is not None else ""
        raise UnitError(f"{file}: {where}POINT:UNITS is {unit!r}, allowed: {', '.join(LENGTH_UNITS)}")
    return math.pow(10.0, -LENGTH_UNITS[unit.lower()].shift)


def _names(file: Path, header: C3DHeader) -> tuple[tuple[str, ...], str]:
    """Names of the points, and what was odd about them."""
    names: list[str] = []
    for number in ("", *range(2, 100)):
        said = header.parameters.get(f"POINT:LABELS{number}")
        if said is None:
            break
        names += said.texts
    names = names[: header.points] + [""] * (header.points - len(names))
    blank = [i for i, name in enumerate(names) if not name]
    for i in blank:
        names[i] = f"*{i + 1}"
    check_table_names(file, names, what="point")
    return tuple(names), warn(file, f"{len(blank)} points have no label: *{blank[0] + 1}, …") if blank else ""
