"""Joint angles as comma-separated tables."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import HandPathError, MotionFileError, ShapeError, UnitError, UnknownNameError
from armik_sym.motion.declared_units import column_units, largest, likely_time_unit
from armik_sym.motion.joint_motion import JointMotion, checked_motion, checked_names
from armik_sym.motion.unit_table import OpenTable, open_table, write_table
from armik_sym.motion.units import ANGLE_UNITS, LENGTH_UNITS, TIME_UNITS

Array = NDArray[np.float64]

_TIME = "time"
_TWO_TURNS = 4 * math.pi


def read_joint_angles(path: str | os.PathLike[str], joints: Sequence[str] | None = None) -> JointMotion:
    """Read joint angles from a CSV file with units in its header.

    One column `time [s]`, every other column a joint: `shoulder_abduction [deg]`. Units: s, ms; rad,
    deg. Lines starting with '#' are comments.

    Args:
        path: The file.
        joints: The columns wanted, in order; None: all. Others may hold anything, as errors in what a solver
            wrote.

    Returns:
        The motion, in SI units, joints in file order or in that asked for.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off, or a column name is wrong.
        UnitError: If a unit is not declared, unknown, or contradicted by the values.
        UnknownNameError: If a column wanted does not exist.
        HandPathError: If time does not increase; names the line.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    file = Path(path)
    with open_table(file) as opened:
        chosen = _joint_columns(opened, joints)
        allowed = {_TIME: TIME_UNITS, **dict.fromkeys(chosen, ANGLE_UNITS)}
        table = opened.read(column_units(opened, allowed, _likely_unit))
    q = table.of(chosen)
    _check_radians(opened, chosen, q)
    try:
        return JointMotion(*checked_motion(table.of((_TIME,))[:, 0], q, table.place), chosen)
    except (HandPathError, ShapeError) as error:
        raise type(error)(f"{file}: {error}") from None


def write_joint_angles(
    path: str | os.PathLike[str],
    time: ArrayLike,
    q: ArrayLike,
    joint_names: Sequence[str],
    unit: str = "deg",
    comment: str | None = None,
) -> None:
    """Write joint angles as a CSV file.

    Read again, radians are the same to the last bit, degrees to rounding (one part in 10^15).

    Args:
        path: The file; its folder must exist.
        time: Times, shape (n,), in [s].
        q: Joint angles, shape (n, dof), in [rad].
        joint_names: Names of the joints, one for each column.
        unit: Unit to write the angles in, "deg" or "rad".
        comment: Text for the first lines, or None.

    Raises:
        ShapeError: If shapes or the number of names do not fit.
        HandPathError: If a value is not finite, time does not increase or a name is wrong.
        UnknownNameError: If the unit is another one.
        MotionFileError: If the file cannot be written.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    if unit not in ANGLE_UNITS:
        raise UnknownNameError("angle unit", unit, ANGLE_UNITS)
    motion = JointMotion(np.asarray(time), np.asarray(q), tuple(joint_names))
    if _TIME in motion.joint_names:
        raise HandPathError("joint 'time' cannot be written: the column of the times is called so")
    columns = {_TIME: ("s", TIME_UNITS["s"])}
    columns |= dict.fromkeys(motion.joint_names, (unit, ANGLE_UNITS[unit]))
    write_table(Path(path), columns, np.column_stack([motion.time, motion.q]), comment)


def _joint_columns(table: OpenTable, wanted: Sequence[str] | None) -> tuple[str, ...]:
    where = f"{table.path}: line {table.header_line}"
    joints = tuple(name for name in table.columns if name != _TIME)
    if _TIME not in table.columns or not joints:
        raise MotionFileError(
            f"{where} has the columns {', '.join(map(repr, table.columns))}: joint angles need 'time' and at "
            "least one joint, as in 'time [s],elbow_flexion [deg]'"
        )
    for name in wanted or ():
        if name not in joints:
            raise UnknownNameError("column", name, joints)
    joints = joints if wanted is None else tuple(wanted)
    for name in joints:
        if table.columns[name].unit in LENGTH_UNITS:
            raise UnitError(
                f"{where}: column {name!r} has a unit of length, expected joint angles in rad or deg: read "
                "hand paths with read_path"
            )
    try:
        return checked_names(joints, len(joints))
    except HandPathError as error:
        raise MotionFileError(f"{where}: {error}") from None


def _check_radians(table: OpenTable, joints: tuple[str, ...], q: Array) -> None:
    for name, value in zip(joints, np.abs(q).max(axis=0).tolist(), strict=True):
        if table.columns[name].unit == "rad" and value > _TWO_TURNS:
            raise UnitError(
                f"{table.path}: column {name!r} reaches {value:g} rad, more than two full turns: if these "
                f"are degrees, write '{name} [deg]' in line {table.header_line}"
            )


def _likely_unit(table: OpenTable, name: str) -> str:
    if name == _TIME:
        return likely_time_unit(table, name)
    joints = [joint for joint in table.columns if joint != _TIME]
    return "deg" if max(largest(table, joint) for joint in joints) > _TWO_TURNS else "rad"
