"""What was measured, as arrays whose columns are joints of the arm."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import HandPathError, OptionError, ShapeError, UnknownNameError
from armik_sym.motion.checks import float_copy
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.solution import Solution

Array = NDArray[np.float64]


class Measured(NamedTuple):
    """Measured angles of some joints of an arm.

    Attributes:
        time: Time stamps, shape (m,), in [s].
        q: Angles, NaN where missing, shape (m, j), in [rad].
        joints: Index of each column in the arm, shape (j,).
        notes: What was left out, one sentence each.
    """

    time: Array
    q: Array
    joints: NDArray[np.int64]
    notes: tuple[str, ...]


def measured_of(solution: Solution, measured: JointMotion | ArrayLike) -> Measured:
    """Measured angles, matched to the joints of the solution's arm.

    Args:
        solution: The solution.
        measured: A motion, whose joints are matched by name; or angles at the time stamps of the solution,
            NaN where missing, shape (n, dof), in [rad].

    Returns:
        Time stamps, angles and joints, in the order of the arm.

    Raises:
        OptionError: If it is a solution or a file name instead.
        UnknownNameError: If no joint of the motion belongs to the arm.
        ShapeError: If the array does not have one row per sample and one column per joint.
        HandPathError: If the array holds no finite number.

    Source:
        None (bookkeeping).
    """
    if isinstance(measured, JointMotion):
        return _of_motion(solution.arm, measured)
    if hasattr(measured, "unlimited"):
        raise OptionError(
            f"measured is a {type(measured).__name__}: give its .unlimited, the angles as recorded, or "
            ".measured, which stop at the range of motion"
        )
    if isinstance(measured, (str, bytes, Solution)) or hasattr(measured, "joint_names"):
        raise OptionError(
            f"measured is a {type(measured).__name__}, expected a JointMotion or an array of joint angles "
            f"(n, {solution.arm.dof}) in rad: read files with read_joint_angles(FILE)"
        )
    return _of_array(solution, measured)


def _of_motion(arm: Arm, motion: JointMotion) -> Measured:
    found = [i for i, name in enumerate(arm.joint_names) if name in motion.joint_names]
    if not found:
        raise UnknownNameError(
            f"joint of arm {arm.name!r} in the measured motion", motion.joint_names[0], arm.joint_names
        )
    columns = [motion.joint_names.index(arm.joint_names[i]) for i in found]
    missing = [name for name in arm.joint_names if name not in motion.joint_names]
    extra = [name for name in motion.joint_names if name not in arm.joint_names]
    notes = []
    if missing:
        notes.append(f"not measured: {', '.join(missing)}; no swivel and elbow without all joints")
    if extra:
        notes.append(f"measured, but no joints of arm {arm.name}: {', '.join(extra)}")
    return Measured(motion.time, motion.q[:, columns], np.array(found), tuple(notes))


def _of_array(solution: Solution, measured: ArrayLike) -> Measured:
    q = float_copy(measured, "measured")
    expected = solution.q.shape
    if q.shape != expected:
        raise ShapeError(
            f"measured has shape {q.shape}, expected {expected}: one row per sample of the solution and one "
            f"column per joint of arm {solution.arm.name!r}; a JointMotion brings its own times and names"
        )
    q = np.where(np.isfinite(q), q, np.nan)
    if np.isnan(q).all():
        raise HandPathError("measured holds no finite number at all: there is nothing to compare with")
    joints = np.arange(q.shape[1])
    return Measured(solution.time, q, joints, ())
