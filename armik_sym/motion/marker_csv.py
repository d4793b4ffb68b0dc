"""Markers as comma-separated tables of this package: three columns a marker, units in the header."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Mapping
from pathlib import Path

from armik_sym.errors import MotionFileError, UnitError
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.number_rows import read_rows
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.promised_rows import joined
from armik_sym.motion.table_checks import agreed_rate, check_table_names, check_times, errors_of_file
from armik_sym.motion.table_header import Column, header_columns
from armik_sym.motion.text_file import write_lines
from armik_sym.motion.units import LENGTH_UNITS, TIME_UNITS, Unit, from_si, is_rate, length_unit

_AXES = ("x", "y", "z")
_RATE, _NOTE = "rate:", "note:"


def read_marker_csv(path: str | os.PathLike[str]) -> MarkerRecording:
    """Read markers from a CSV file: `time [s],RELB.x [mm],RELB.y [mm],RELB.z [mm],…`.

    Empty cells and `nan` are gaps. Lines starting with '#' are comments; "# rate: 59.94" declares the
    rate in [Hz], "# note: …" says where the recording comes from.

    Args:
        path: The file.

    Returns:
        The recording, in SI units.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or not of this form; names the line.
        UnitError: If a unit is not declared or unknown, or units of lengths are mixed.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    file = Path(path)
    with NumberedLines(file) as lines:
        heading = lines.next_uncommented()
        if heading is None:
            raise MotionFileError(f"{file}: no header row such as 'time [s],RELB.x [mm],…'")
        at = lines.number
        columns = header_columns(file, at, heading)
        names, units = _markers(file, at, columns), _units(file, at, columns)
        rows = read_rows(lines, list(columns), units, ",", gaps_from=1, comments=True)
        rate_said, note = lines.said(_RATE), lines.said(_NOTE)
    if not len(rows.values):
        raise MotionFileError(f"{file}: the header on line {at} is followed by no samples")
    time = rows.values[:, 0]
    check_times(file, time, rows.lines)
    if rate_said and not is_rate(rate_said):
        raise MotionFileError(f"{file}: the rate is {rate_said[:40]!r}, expected a positive number [Hz]")
    rate, odd = agreed_rate(file, float(rate_said) if rate_said else None, time)
    position = rows.values[:, 1:].reshape(len(time), len(names), 3)
    with errors_of_file(file):
        return MarkerRecording(time, names, position, joined(note, odd), file.name, rate)


def write_marker_csv(path: str | os.PathLike[str], recording: MarkerRecording, unit: str = "mm") -> None:
    """Write markers as a CSV file with units in its header; gaps become empty cells.

    Read again, everything is the same to the last bit.

    Args:
        path: The file; its folder must exist.
        recording: The recording.
        unit: Unit to write lengths in, "m", "cm" or "mm".

    Raises:
        UnknownNameError: If the unit is another one.
        MotionFileError: If a name cannot be written, or the file cannot.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    file, factor = Path(path), length_unit(unit)
    check_table_names(file, recording.names, forbidden="[]")
    rate = [f"# rate: {float(recording.declared_rate)!r}"] if recording.declared_rate is not None else []
    note = [f"# note: {' '.join(recording.note.split())}"] if recording.note.strip() else []
    heads = ["time [s]", *(f"{name}.{axis} [{unit}]" for name in recording.names for axis in _AXES)]
    lines = [*rate, *note, _csv_row(heads)]
    position = recording.position.reshape(recording.n, -1).tolist()
    for time, row in zip(recording.time.tolist(), position, strict=True):
        cells = ("" if math.isnan(value) else from_si(value, factor) for value in row)
        lines.append(",".join((from_si(time, Unit()), *cells)))
    write_lines(file, lines)


def is_marker_header(names: list[str]) -> bool:
    """Whether columns are those of a marker table: time, then NAME.x, NAME.y, NAME.z and so on.

    Args:
        names: Names of the columns.

    Returns:
        Whether they are.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    rest = names[1:]
    return bool(
        names[:1] == ["time"]
        and rest
        and len(rest) % 3 == 0
        and all(
            name.endswith(f".{_AXES[i % 3]}") and name[:-2] == rest[i // 3 * 3][:-2]
            for i, name in enumerate(rest)
        )
    )


def _csv_row(cells: list[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(cells)
    return text.getvalue()


def _markers(file: Path, at: int, columns: Mapping[str, Column]) -> tuple[str, ...]:
    names = list(columns)
    if not is_marker_header(names):
        raise MotionFileError(
            f"{file}: line {at} has the columns {', '.join(names[:7])}{', …' if len(names) > 7 else ''}, "
            "expected 'time [s]' and for every marker NAME.x, NAME.y and NAME.z, each with its unit, as in "
            "'RELB.x [mm]'"
        )
    return tuple(name[:-2] for name in names[1::3])


def _units(file: Path, at: int, columns: Mapping[str, Column]) -> list[Unit]:
    units = []
    lengths = {column.unit for name, column in columns.items() if name != "time"}
    for name, column in columns.items():
        allowed = TIME_UNITS if name == "time" else LENGTH_UNITS
        if column.unit is None or column.unit not in allowed:
            raise UnitError(
                f"{file}: line {at}: column {name!r} has the unit {column.unit!r}, allowed: "
                f"{', '.join(allowed)}"
            )
        units.append(allowed[column.unit])
    if len(lengths) > 1:
        raise UnitError(
            f"{file}: line {at}: units are mixed, {' and '.join(map(str, sorted(map(str, lengths))))}"
        )
    return units
