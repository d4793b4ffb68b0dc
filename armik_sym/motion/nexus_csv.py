"""Trajectories as Vicon Nexus exports them to comma-separated text."""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError, UnitError
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.number_rows import read_rows, split, without_empty_end
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.promised_rows import joined
from armik_sym.motion.table_checks import agreed_rate, check_table_names, errors_of_file
from armik_sym.motion.text_file import write_lines
from armik_sym.motion.units import LENGTH_UNITS, Unit, from_si, is_rate, length_unit

Array = NDArray[np.float64]

TITLE = "Trajectories"
SECTIONS = (TITLE, "Devices", "Joints", "Model Outputs", "Segments", "Events")
_AXES = ["X", "Y", "Z"]
_FRAME = ["Frame", "Sub Frame"]


def read_nexus_csv(path: str | os.PathLike[str]) -> MarkerRecording:
    """Read the section "Trajectories" of a Vicon Nexus export.

    Empty cells are gaps. t = (frame - 1) / rate: an export that starts at frame 41 of 100 Hz starts at
    0.4 s. Frames left out are no error; the times then have a step there.

    Args:
        path: The file.

    Returns:
        The recording, in SI units.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or not of this form; names the line.
        UnitError: If a column has no unit of length, or units are mixed.

    Source:
        Vicon Nexus user guide, "Export ASCII".
    """
    file = Path(path)
    with NumberedLines(file) as lines:
        others = _to_section(lines)
        rate = _rate(lines)
        names = _names(lines)
        unit = _axes_and_unit(lines, names)
        columns = [*_FRAME, *(f"{name} {axis}" for name in names for axis in _AXES)]
        units = [Unit(), Unit(), *[unit] * (len(columns) - 2)]
        rows = read_rows(lines, columns, units, ",", gaps_from=2, stop_at_blank=True)
    if not len(rows.values):
        raise MotionFileError(f"{file}: the header ends on line {lines.number} and is followed by no frames")
    frame = rows.values[:, 0]
    _check_frames(file, frame, rows.values[:, 1], rows.lines)
    time = (frame - 1.0) / rate
    position = rows.values[:, 2:].reshape(len(time), len(names), 3)
    declared, odd = agreed_rate(file, rate, time)
    note = joined(f"sections not read: {', '.join(others)}" if others else "", odd)
    with errors_of_file(file):
        return MarkerRecording(time, tuple(names), position, note, file.name, declared)


def write_nexus_csv(path: str | os.PathLike[str], recording: MarkerRecording, unit: str = "mm") -> None:
    """Write markers as Vicon Nexus exports them; gaps become empty cells.

    Times are kept as frame numbers, frame = 1 + t·rate, so only recordings on such a grid can be written.
    Read again, positions and the rate are the same to the last bit, times to rounding.

    Args:
        path: The file; its folder must exist.
        recording: The recording.
        unit: Unit to write lengths in, "m", "cm" or "mm".

    Raises:
        UnknownNameError: If the unit is another one.
        MotionFileError: If times lie between frames, a name cannot be written, or the file cannot.

    Source:
        Vicon Nexus user guide, "Export ASCII".
    """
    file, factor = Path(path), length_unit(unit)
    check_table_names(file, recording.names, forbidden=',"')
    frames, rate = frame_numbers(file, recording)
    lines = [
        TITLE,
        repr(float(rate)),
        "," + "".join(f",{name},," for name in recording.names).removesuffix(",,"),
        ",".join(_FRAME + _AXES * len(recording.names)),
        ",".join(["", "", *[unit] * (3 * len(recording.names))]),
    ]
    for frame, row in zip(frames, recording.position.reshape(recording.n, -1).tolist(), strict=True):
        cells = ("" if math.isnan(value) else from_si(value, factor) for value in row)
        lines.append(",".join((str(frame), "0", *cells)))
    write_lines(file, [*lines, ""])


def first_cell(line: str) -> str:
    """The first cell of a line, without quotes: the name of a section where one starts.

    Args:
        line: The line.

    Returns:
        The cell.

    Source:
        Vicon Nexus user guide, "Export ASCII".
    """
    return line.split(",")[0].strip().strip('"')


def frame_numbers(file: Path, recording: MarkerRecording) -> tuple[list[int], float]:
    """Frame numbers of a recording whose times lie on a grid: frame = 1 + t·rate.

    Args:
        file: The file to be written, for messages.
        recording: The recording.

    Returns:
        The frames, from 1 where time starts at 0, and the rate, in [Hz].

    Raises:
        MotionFileError: If the recording has no rate, or its times lie between frames.

    Source:
        None (this package).
    """
    rate = recording.rate
    if math.isnan(rate):
        raise MotionFileError(f"{file}: a single sample without declared rate has no frame rate to write")
    if not is_rate(repr(float(rate))):
        raise MotionFileError(f"{file}: a rate of {rate:g} Hz cannot be written: times are in seconds")
    exact = 1.0 + recording.time * rate
    frames = np.round(exact)
    # Times in files are rounded, often to milliseconds or less.
    far = np.flatnonzero((np.abs(exact - frames) > 0.1) | (np.abs(frames) > 1e15))
    if far.size or (np.diff(frames) <= 0).any() or frames[0] < 0:
        i = int(far[0]) if far.size else 0
        raise MotionFileError(
            f"{file}: time of sample {i} is {recording.time[i]!r} s, which is no whole frame at {rate:g} Hz: "
            "this form keeps frame numbers instead of times"
        )
    return [int(frame) for frame in frames], rate


def _to_section(lines: NumberedLines) -> list[str]:
    """Go to the trajectories, and name the sections passed over."""
    passed: list[str] = []
    while (line := lines.next_line()) is not None:
        first = first_cell(line)
        if first == TITLE:
            return passed
        if first in SECTIONS:
            passed.append(first)
        elif not passed:
            raise lines.error(
                f"starts with {first[:30]!r}, expected {TITLE!r}: this is no Vicon Nexus export"
            )
    if not lines.number:
        raise MotionFileError(f"{lines.path}: the file is empty")
    raise MotionFileError(
        f"{lines.path}: has {', '.join(passed)} but no section {TITLE!r}: export the trajectories of "
        "the markers"
    )


def _rate(lines: NumberedLines) -> float:
    text = (lines.next_line() or "").strip(", \t")
    if not is_rate(text):
        raise lines.error(f"is {text[:40]!r}, expected the frame rate [Hz], a positive number")
    return float(text)


def _names(lines: NumberedLines) -> list[str]:
    cells = without_empty_end(split(lines.next_line() or "", ","))
    names = cells[2::3]
    stray = [cell for i, cell in enumerate(cells) if cell and (i < 2 or (i - 2) % 3)]
    if not names or stray:
        said = f"has {stray[0]!r} out of place" if stray else "names no markers"
        raise lines.error(f"{said}: expected two empty cells and the names of markers, every third cell")
    check_table_names(lines.path, names, lines.number)
    return names


def _axes_and_unit(lines: NumberedLines, names: list[str]) -> Unit:
    cells = without_empty_end(split(lines.next_line() or "", ","))
    if cells != _FRAME + _AXES * len(names):
        raise lines.error(
            f"has {len(cells)} cells starting {', '.join(cells[:5])}, expected Frame, Sub Frame and X, Y, Z "
            f"for each of {len(names)} markers (no velocities or accelerations)"
        )
    units = split(lines.next_line() or "", ",")[2 : 2 + 3 * len(names)]
    if len(units) < 3 * len(names):
        raise lines.error(f"has units of {len(units)} columns, expected {3 * len(names)}")
    for i, unit in enumerate(units):
        if unit not in LENGTH_UNITS:
            raise UnitError(
                f"{lines.path}: line {lines.number}: marker {names[i // 3]!r} has the unit {unit!r}, "
                f"allowed: {', '.join(LENGTH_UNITS)}"
            )
        if unit != units[0]:
            raise UnitError(
                f"{lines.path}: line {lines.number}: units are mixed, {units[0]} and, for marker "
                f"{names[i // 3]!r}, {unit}: one unit for all is expected"
            )
    return LENGTH_UNITS[units[0]]


def _check_frames(file: Path, frame: Array, sub: Array, at: NDArray[np.int64]) -> None:
    bad = np.flatnonzero((frame != np.round(frame)) | (np.abs(frame) > 1e15) | (sub != 0))
    if bad.size:
        i = int(bad[0])
        raise MotionFileError(
            f"{file}: line {at[i]} has frame {frame[i]:g}, sub frame {sub[i]:g}: expected whole frames and "
            "sub frame 0"
        )
    back = np.flatnonzero(np.diff(frame) <= 0)
    if back.size:
        i = int(back[0]) + 1
        raise MotionFileError(f"{file}: line {at[i]} has frame {frame[i]:g} after frame {frame[i - 1]:g}")
