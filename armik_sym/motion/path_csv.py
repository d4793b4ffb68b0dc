"""Hand paths as comma-separated tables."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import HandPathError, MotionFileError, ShapeError, UnitError
from armik_sym.motion.declared_units import column_units, largest, likely_time_unit
from armik_sym.motion.hand_path import HandPath, checked_path
from armik_sym.motion.rotations import quaternions_to_rotations, rotations_to_quaternions
from armik_sym.motion.unit_table import OpenTable, open_table, write_table
from armik_sym.motion.units import LENGTH_UNITS, NO_UNITS, TIME_UNITS, Unit

Array = NDArray[np.float64]

_POSITION = ("x", "y", "z")
_QUATERNION = ("qw", "qx", "qy", "qz")
_MATRIX = tuple(f"r{row}{column}" for row in "123" for column in "123")
_UNITS: Mapping[str, Mapping[str, Unit]] = {
    "time": TIME_UNITS,
    **dict.fromkeys(_POSITION, LENGTH_UNITS),
    **dict.fromkeys(_QUATERNION + _MATRIX, NO_UNITS),
}
_ARM_LENGTH = 10.0


def read_path(path: str | os.PathLike[str]) -> HandPath:
    """Read a hand path from a CSV file with units in its header.

    Columns in any order: `time [s],x [mm],y [mm],z [mm]`, then for the rotation a unit quaternion
    `qw,qx,qy,qz` (scalar first), or the matrix `r11,r12,…,r33` (row by row), or nothing. Units: s, ms;
    m, cm, mm. Lines starting with '#' are comments; "# note: …" says where the path comes from.

    Args:
        path: The file.

    Returns:
        The path, in SI units.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or lacks a column.
        UnitError: If a unit is not declared, unknown, or contradicted by the values.
        HandPathError: If the values cannot be followed; names the line.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    file = Path(path)
    with open_table(file) as opened:
        names = _check_columns(opened)
        table = opened.read(column_units(opened, {name: _UNITS[name] for name in names}, _likely_unit))
    time, position = table.of(("time",))[:, 0], table.of(_POSITION)
    rotation: Array | None = None
    try:
        if "qw" in names:
            rotation = quaternions_to_rotations(table.of(_QUATERNION), table.place)
        elif "r11" in names:
            rotation = table.of(_MATRIX).reshape(-1, 3, 3)
        return HandPath(*checked_path(time, position, rotation, table.place), note=table.note)
    except (HandPathError, UnitError, ShapeError) as error:
        raise type(error)(f"{file}: {error}") from None


def write_path(path: str | os.PathLike[str], hand_path: HandPath, comment: str | None = None) -> None:
    """Write a hand path as a CSV file: time in s, position in mm, rotation as unit quaternion.

    Read again, time and position are the same to the last bit, the rotation to rounding (1e-15).

    Args:
        path: The file; its folder must exist.
        hand_path: The path.
        comment: Text for the first lines, or None; the path's note follows.

    Raises:
        MotionFileError: If the file cannot be written.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    columns = {"time": ("s", TIME_UNITS["s"]), **dict.fromkeys(_POSITION, ("mm", LENGTH_UNITS["mm"]))}
    values = [hand_path.time, hand_path.position]
    if hand_path.rotation is not None:
        columns |= dict.fromkeys(_QUATERNION, ("-", NO_UNITS["-"]))
        values.append(rotations_to_quaternions(hand_path.rotation))
    note = f"note: {hand_path.note}" if hand_path.note else ""
    write_table(Path(path), columns, np.column_stack(values), "\n".join(filter(None, (comment, note))))


def _check_columns(table: OpenTable) -> tuple[str, ...]:
    """The columns that make the path, after refusing files that lack some or have others."""
    where = f"{table.path}: line {table.header_line}"
    unknown = [name for name in table.columns if name not in _UNITS]
    if unknown:
        raise MotionFileError(
            f"{where} has unknown columns {', '.join(map(repr, unknown))}: known are time, x, y, z, and for "
            "the rotation qw, qx, qy, qz or r11 … r33, each with its unit in brackets, as in 'x [mm]'"
        )
    names: tuple[str, ...] = ("time", *_POSITION)
    groups = [group for group in (_QUATERNION, _MATRIX) if any(name in table.columns for name in group)]
    if len(groups) > 1:
        raise MotionFileError(
            f"{where} gives the rotation twice, as quaternion and as matrix: keep one of them"
        )
    names += groups[0] if groups else ()
    missing = [name for name in names if name not in table.columns]
    if missing:
        raise MotionFileError(
            f"{where} has no column {', '.join(map(repr, missing))}: a path needs {', '.join(names)}"
        )
    return names


def _likely_unit(table: OpenTable, name: str) -> str:
    if name == "time":
        return likely_time_unit(table, name)
    return "mm" if max(largest(table, axis) for axis in _POSITION) > _ARM_LENGTH else "m"
