"""Marker positions in the `.trc` form of Motion Analysis and OpenSim."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError, UnitError
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.number_rows import NumberRows, read_rows, split, without_empty_end
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.promised_rows import compare_rows, count_of, joined, warn
from armik_sym.motion.table_checks import agreed_rate, check_table_names, check_times, errors_of_file
from armik_sym.motion.text_file import write_lines
from armik_sym.motion.units import LENGTH_UNITS, Unit, from_si, is_rate, length_unit

Array = NDArray[np.float64]

_FIELDS = (
    "DataRate",
    "CameraRate",
    "NumFrames",
    "NumMarkers",
    "Units",
    "OrigDataRate",
    "OrigDataStartFrame",
    "OrigNumFrames",
)
_AXES = ("X", "Y", "Z")


def read_trc(path: str | os.PathLike[str]) -> MarkerRecording:
    """Read markers from a `.trc` file, separated by tabs or commas.

    Empty cells and `nan` are gaps. A header that promises another number of frames than there are is
    answered by a `MotionFileWarning`, which the note repeats. Times are those of the file.

    Args:
        path: The file.

    Returns:
        The recording, in SI units.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or not of this form; names the line.
        UnitError: If it declares no unit of length, or an unknown one.

    Source:
        OpenSim documentation, "Marker (.trc) files".
    """
    file = Path(path)
    with NumberedLines(file) as lines:
        delimiter = _first_line(lines)
        fields, at = _fields(lines, delimiter)
        unit, names = _unit(file, at, fields), _marker_names(lines, delimiter)
        columns = ["Frame#", "Time", *(f"{name} {axis}" for name in names for axis in _AXES)]
        _check_axes(lines, delimiter, names)
        units = [Unit(), Unit(), *[unit] * (len(columns) - 2)]
        rows = read_rows(lines, columns, units, delimiter, gaps_from=2)
    return _recording(file, fields, at, names, rows)


def _recording(
    file: Path, fields: Mapping[str, str], at: int, names: list[str], rows: NumberRows
) -> MarkerRecording:
    if not len(rows.values):
        raise MotionFileError(f"{file}: the header ends on line {at + 3} and is followed by no frames")
    time = rows.values[:, 1]
    check_times(file, time, rows.lines)
    promised = count_of(file, at, "NumFrames", fields["NumFrames"]) if "NumFrames" in fields else None
    odd = compare_rows(file, "NumFrames", promised, len(time))
    if "NumMarkers" in fields:
        markers = count_of(file, at, "NumMarkers", fields["NumMarkers"])
        if markers != len(names):
            odd = joined(
                odd, warn(file, f"the header promises {markers} markers (NumMarkers) and names {len(names)}")
            )
    rate, strange = agreed_rate(file, _rate(file, at, fields), time)
    position = rows.values[:, 2:].reshape(len(time), len(names), 3)
    with errors_of_file(file):
        return MarkerRecording(time, tuple(names), position, joined(odd, strange), file.name, rate)


def write_trc(path: str | os.PathLike[str], recording: MarkerRecording, unit: str = "mm") -> None:
    """Write markers as a `.trc` file, separated by tabs; gaps become empty cells.

    Read again, times, positions and the rate are the same to the last bit, if the names hold no tabs and
    no blanks at their ends.

    Args:
        path: The file; its folder must exist.
        recording: The recording.
        unit: Unit to write lengths in, "m", "cm" or "mm".

    Raises:
        UnknownNameError: If the unit is another one.
        MotionFileError: If a name cannot be written, or the file cannot.

    Source:
        OpenSim documentation, "Marker (.trc) files".
    """
    file, factor = Path(path), length_unit(unit)
    check_table_names(file, recording.names, forbidden="\t")
    rate, n = _rate_to_write(file, recording), recording.n
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{file.name}",
        "\t".join(_FIELDS),
        "\t".join((rate, rate, str(n), str(len(recording.names)), unit, rate, "1", str(n))),
        "\t".join(("Frame#", "Time", *(f"{name}\t\t" for name in recording.names))),
        "\t".join(("", "", *(f"{axis}{i + 1}" for i in range(len(recording.names)) for axis in _AXES))),
        "",
    ]
    position = recording.position.reshape(n, -1)
    for i, (time, row) in enumerate(zip(recording.time.tolist(), position.tolist(), strict=True)):
        cells = ["" if math.isnan(value) else from_si(value, factor) for value in row]
        # OpenSim passes over an empty cell at the end of a line, unless another tab follows it.
        end = [""] if not cells[-1] else []
        lines.append("\t".join((str(i + 1), from_si(time, Unit()), *cells, *end)))
    write_lines(file, lines)


def _rate_to_write(file: Path, recording: MarkerRecording) -> str:
    """The rate as text; the form demands one, where a single sample has none."""
    if recording.n == 1 and recording.declared_rate is None:
        return "1.0"
    rate = repr(float(recording.rate))
    if not is_rate(rate):
        raise MotionFileError(f"{file}: a rate of {rate} Hz cannot be written: times are in seconds")
    return rate


def _first_line(lines: NumberedLines) -> str:
    # The first line repeats a path, in whatever encoding the writer's system had.
    line = lines.next_line(any_encoding=True)
    if line is None:
        raise MotionFileError(f"{lines.path}: the file is empty")
    if not line.startswith("PathFileType"):
        raise lines.error(f"starts with {line[:30]!r}, expected 'PathFileType': this is no .trc file")
    return "," if line[len("PathFileType") :].startswith(",") else "\t"


def _fields(lines: NumberedLines, delimiter: str) -> tuple[dict[str, str], int]:
    """The header fields, and the line their values are on."""
    names = without_empty_end(split(lines.next_content(delimiter) or "", delimiter))
    if "Units" not in names:
        raise lines.error(
            f"names no field 'Units', expected {', '.join(_FIELDS[:5])}, separated by "
            f"{'commas' if delimiter == ',' else 'tabs'}"
        )
    values = split(lines.next_content(delimiter) or "", delimiter)
    if len(values) < len(names):
        raise lines.error(f"has {len(values)} cells, expected {len(names)}, one for each field above it")
    return dict(zip(names, values, strict=False)), lines.number


def _unit(file: Path, at: int, fields: Mapping[str, str]) -> Unit:
    said = fields["Units"]
    if said.lower() not in LENGTH_UNITS:
        raise UnitError(f"{file}: line {at}: Units is {said!r}, allowed: {', '.join(LENGTH_UNITS)}")
    return LENGTH_UNITS[said.lower()]


def _rate(file: Path, at: int, fields: Mapping[str, str]) -> float | None:
    text = fields.get("DataRate", "")
    if not text:
        return None
    if not is_rate(text):
        raise MotionFileError(
            f"{file}: line {at}: DataRate is {text[:40]!r}, expected a positive number [Hz]"
        )
    return float(text)


def _marker_names(lines: NumberedLines, delimiter: str) -> list[str]:
    cells = without_empty_end(split(lines.next_content(delimiter) or "", delimiter))
    if len(cells) < 3 or not cells[0].startswith("Frame") or cells[1] != "Time":
        raise lines.error(
            f"starts with {cells[:2]}, expected 'Frame#', 'Time' and the names of the markers, one in every "
            "third cell"
        )
    names = cells[2::3]
    stray = [cell for i, cell in enumerate(cells[2:]) if i % 3 and cell]
    if stray:
        raise lines.error(f"has {stray[0]!r} between the names of markers, which stand in every third cell")
    check_table_names(lines.path, names, line=lines.number)
    return names


def _check_axes(lines: NumberedLines, delimiter: str, names: list[str]) -> None:
    cells = without_empty_end(split(lines.next_content(delimiter) or "", delimiter))
    wanted = [axis for _ in names for axis in _AXES]
    if [cell[:1].upper() for cell in cells[2:]] != wanted or any(cells[:2]):
        raise lines.error(
            f"has {max(len(cells) - 2, 0)} names of coordinates, expected X1, Y1, Z1, X2, …, three for each "
            f"of {len(names)} markers"
        )
