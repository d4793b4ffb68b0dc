"""Joint angles of every form, by the ending of the file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from armik_sym.errors import MotionFileError, OptionError, UnknownNameError
from armik_sym.motion.joint_csv import read_joint_angles, write_joint_angles
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.plain_angles import read_plain_angles
from armik_sym.motion.storage import read_storage, write_storage
from armik_sym.motion.storage_table import angle_table, column_of_joint

MOTION_FILES = (".mot", ".sto", ".csv")


def read_motion(
    path: str | os.PathLike[str],
    joints: Sequence[str] | Mapping[str, str] | None = None,
    rate: float | None = None,
    unit: str | None = None,
) -> JointMotion:
    """Read joint angles from a `.mot`, `.sto` or `.csv` file.

    Args:
        path: The file.
        joints: The columns wanted, in order; or column by name of the joint, to rename them; None for all
            (of `.mot` and `.sto` without those whose names are those of translations, as "…_tx").
        rate: For a `.csv` without times: samples per second, in [Hz].
        unit: For the same: unit of the angles, "deg" or "rad".

    Returns:
        The motion, in SI units.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or of another form; names the line.
        UnitError: If the file does not say in which unit angles are.
        UnknownNameError: If a column does not exist.
        OptionError: If only one of rate and unit is given, or the file has its own.
        HandPathError: If times do not increase, or angles have gaps.

    Source:
        None (see the readers of each form, and `docs/files.md`).
    """
    file = Path(path)
    ending = file.suffix.lower()
    if ending not in MOTION_FILES:
        raise MotionFileError(
            f"{file}: cannot read joint angles from {ending or 'a file without ending'!r}: valid are "
            f"{', '.join(MOTION_FILES)}"
        )
    if (rate is None) != (unit is None):
        raise OptionError("rate and unit belong together: both for a .csv that states neither, else none")
    if ending != ".csv":
        if rate is not None:
            raise OptionError(f"rate and unit are for .csv files without them, {file.name} has its own")
        return read_storage(file).joint_motion(joints)
    if rate is not None and unit is not None:
        return read_plain_angles(file, rate, unit).joint_motion(joints)
    if joints is None:
        return read_joint_angles(file)
    wanted = column_of_joint(joints)
    columns = tuple(dict.fromkeys(wanted.values()))
    motion = read_joint_angles(file, columns)
    order = [columns.index(column) for column in wanted.values()]
    return JointMotion(motion.time, motion.q[:, order], tuple(wanted))


def write_motion(path: str | os.PathLike[str], motion: JointMotion, unit: str = "deg") -> None:
    """Write joint angles as a `.mot`, `.sto` or `.csv` file.

    Args:
        path: The file; its folder must exist.
        motion: The motion.
        unit: Unit to write angles in, "deg" or "rad".

    Raises:
        MotionFileError: If the ending is another one, or the file cannot be written.
        UnknownNameError: If the unit is another one.

    Source:
        None (see the writers of each form, and `docs/files.md`).
    """
    file = Path(path)
    ending = file.suffix.lower()
    if unit not in ("deg", "rad"):
        raise UnknownNameError("angle unit", unit, ("deg", "rad"))
    if ending == ".csv":
        write_joint_angles(file, motion.time, motion.q, motion.joint_names, unit)
    elif ending in MOTION_FILES:
        q = np.asarray(motion.q, dtype=np.float64)
        write_storage(file, angle_table(motion.time, q, motion.joint_names, in_degrees=unit == "deg"))
    else:
        raise MotionFileError(
            f"{file}: cannot write joint angles as {ending or 'a file without ending'!r}: valid are "
            f"{', '.join(MOTION_FILES)}"
        )
