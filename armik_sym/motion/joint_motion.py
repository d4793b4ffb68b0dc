"""What the joints do over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.names import check_identifier
from armik_sym.errors import ArmModelError, HandPathError, ShapeError
from armik_sym.motion.checks import (
    Place,
    check_finite,
    check_increasing,
    check_shape,
    float_copy,
    sample_place,
)

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class JointMotion:
    """Joint angles over time, measured or solved: t_i ↦ q_i.

    Attributes:
        time: Strictly increasing times, shape (n,) with n ≥ 1, in [s]; read-only.
        q: Joint angles, shape (n, dof), in [rad]; read-only.
        joint_names: Names of the joints, one for each column of `q`.

    Raises:
        ShapeError: If shapes or the number of names do not fit.
        HandPathError: If a value is not finite, time does not increase, or a name is no plain
            identifier or occurs twice.

    Source:
        None (definition).
    """

    time: Array
    q: Array
    joint_names: tuple[str, ...]

    def __post_init__(self) -> None:
        time, q = checked_motion(self.time, self.q)
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "q", q)
        object.__setattr__(self, "joint_names", checked_names(self.joint_names, self.dof))

    @property
    def n(self) -> int:
        """Number of samples."""
        return len(self.time)

    @property
    def dof(self) -> int:
        """Number of joints."""
        return int(self.q.shape[1])

    @property
    def duration(self) -> float:
        """Time from the first to the last sample, in [s]."""
        return float(self.time[-1] - self.time[0])

    def __len__(self) -> int:
        return self.n

    def __repr__(self) -> str:
        return f"JointMotion({self.n} samples, {self.duration:g} s, joints {', '.join(self.joint_names)})"


def checked_motion(time: ArrayLike, q: ArrayLike, place: Place = sample_place) -> tuple[Array, Array]:
    """Check times and joint angles and return read-only copies: t_i > t_{i-1}, all finite.

    Args:
        time: Times, shape (n,), in [s].
        q: Joint angles, shape (n, dof), in [rad].
        place: Words for where a sample is; readers of files name the line.

    Returns:
        Time and joint angles.

    Raises:
        ShapeError: If shapes do not fit.
        HandPathError: If a value is not finite or time does not increase.

    Source:
        None (definition).
    """
    t, angles = float_copy(time, "time"), float_copy(q, "q")
    check_shape(t, "time", (None,), "(n,)")
    if len(t) < 1:
        raise ShapeError("time has shape (0,), expected (n,) with n ≥ 1: a joint motion needs a sample")
    n = len(t)
    check_shape(angles, "q", (n, None), f"({n}, dof), one row for each of the {n} times")
    check_finite(t, "time", place)
    check_finite(angles, "q", place)
    check_increasing(t, place)
    return t, angles


def checked_names(names: Sequence[str], dof: int) -> tuple[str, ...]:
    """Check the names of the joints: as many as joints, plain identifiers, none twice.

    Args:
        names: The names, base to hand.
        dof: Number of joints.

    Returns:
        The names.

    Raises:
        ShapeError: If their number does not fit.
        HandPathError: If a name is no plain identifier or occurs twice.

    Source:
        None (bookkeeping).
    """
    if isinstance(names, str):
        raise HandPathError(
            f"joint_names is the text {names!r}, expected a tuple with one name for each joint"
        )
    given = tuple(names)
    if len(given) != dof or dof == 0:
        raise ShapeError(
            f"q has {dof} columns but there are {len(given)} joint names: one name for each joint"
        )
    try:
        for name in given:
            check_identifier(name, "joint")
    except ArmModelError as error:
        raise HandPathError(str(error)) from None
    repeated = [name for i, name in enumerate(given) if name in given[:i]]
    if repeated:
        raise HandPathError(f"joint name {repeated[0]!r} occurs twice: every joint needs its own name")
    return given
