"""What `armik servo` is asked to follow: joint angles from a file, or a hand path that is solved first."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from armik_sym.errors import MotionFileError, OptionError, UnknownNameError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.servo.motion import ArmMotion


def motion_of(file: Path, arm: Arm) -> ArmMotion | None:
    """Joint angles of an arm from a file of solved or recorded angles.

    Args:
        file: `.npz` or `.csv` of a solution, `.csv`, `.mot` or `.sto` of joint angles.
        arm: The arm.

    Returns:
        The motion; None if the file is a hand path.

    Raises:
        OptionError: If a joint of the arm is missing, or the file holds markers.
        MotionFileError: If the file cannot be read.

    Source:
        None (command line).
    """
    if file.suffix.lower() == ".npz":
        return _from_npz(file, arm)
    from armik_sym.motion.file_kind import file_kind

    kind = file_kind(file)
    if kind == "path":
        return None
    if kind == "markers":
        raise OptionError(f"{file}: holds markers: fit an arm first with armik compare")
    return _from_table(file, arm)


def _from_npz(file: Path, arm: Arm) -> ArmMotion:
    import numpy as np

    try:
        with np.load(file) as saved:
            names = [str(name) for name in saved["joint_names"]]
            time, q = np.asarray(saved["time"]), np.asarray(saved["q"])
    except (OSError, KeyError, ValueError, zipfile.BadZipFile) as error:
        reason = getattr(error, "strerror", None) or error
        raise MotionFileError(
            f"{file}: is no solution saved by armik solve (time, q, joint_names): {reason}"
        ) from None
    return _motion(file, arm, time, q, names)


def _from_table(file: Path, arm: Arm) -> ArmMotion:
    """Only the joints of the arm are read: a solution also holds its errors."""
    from armik_sym.motion.read_motion import read_motion

    try:
        motion = read_motion(file, arm.joint_names)
    except UnknownNameError as error:
        raise OptionError(
            f"{file} has no joint {error.name}: arm {arm.name!r} needs {', '.join(arm.joint_names)}; choose "
            "the arm with --arm"
        ) from None
    return _motion(file, arm, motion.time, motion.q, list(motion.joint_names))


def _motion(file: Path, arm: Arm, time: Any, q: Any, names: list[str]) -> ArmMotion:
    from armik_sym.servo.motion import ArmMotion

    _need_all(file, arm, names)
    return ArmMotion(arm, time, q[:, [names.index(name) for name in arm.joint_names]])


def _need_all(file: Path, arm: Arm, names: list[str]) -> None:
    missing = [name for name in arm.joint_names if name not in names]
    if missing:
        raise OptionError(
            f"{file} has no joint {', '.join(missing)}: arm {arm.name!r} needs {', '.join(arm.joint_names)}; "
            "choose the arm with --arm"
        )
