"""The motion a servo is asked for, at the rate of its controller."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import HandPathError, ShapeError
from armik_sym.servo.spline import path_spline

Array = NDArray[np.float64]

_ROUNDING = 1e-9


class Solved(Protocol):
    """What is asked of a solution: an arm and its joint angles over time."""

    @property
    def arm(self) -> Arm:
        """The arm."""

    @property
    def time(self) -> Array:
        """Time stamps, shape (n,), in [s]."""

    @property
    def q(self) -> Array:
        """Joint angles, shape (n, dof), in [rad]."""


@dataclass(frozen=True, eq=False)
class Reference:
    """Wanted motion, sampled evenly.

    Attributes:
        time: From 0, shape (k,), in [s].
        q: Joint angles, shape (k, dof), in [rad].
        speed: In [rad/s].
        acceleration: In [rad/s²].
        step: From sample to sample, in [s].
    """

    time: Array
    q: Array
    speed: Array
    acceleration: Array
    step: float


def reference_of(solution: Solved, rate: float, slower: float = 1.0) -> Reference:
    """Sample a motion at the rate of a controller, `slower` times slower: q(t/f), q̇/f, q̈/f².

    Between its samples a solution is a natural cubic spline; a motion that knows itself (`at`, as a re-timed
    one) is asked.

    Args:
        solution: The motion.
        rate: In [Hz].
        slower: f, by which all times are multiplied.

    Returns:
        The motion, its first and last posture included; it rests in the last one until the next sample.

    Raises:
        ShapeError: If there are fewer than two samples.
        HandPathError: If an angle is not finite.

    Source:
        None (definition).
    """
    start, end = float(solution.time[0]), float(solution.time[-1])
    steps = max(math.ceil((end - start) * slower * rate - _ROUNDING), 1)
    time = np.arange(steps + 1) / rate
    at = np.minimum(start + time / slower, end)
    q, speed, acceleration = motion_at(solution, at)
    return Reference(time, q, speed / slower, acceleration / slower**2, 1.0 / rate)


def motion_at(solution: Solved, time: Array) -> tuple[Array, Array, Array]:
    """Angles, speeds and accelerations of a motion at any time.

    Args:
        solution: The motion.
        time: Shape (k,), in [s].

    Returns:
        Each of shape (k, dof), in [rad], [rad/s] and [rad/s²].

    Raises:
        ShapeError: If there are fewer than two samples.
        HandPathError: If an angle is not finite.

    Source:
        None (definition).
    """
    own: Any = getattr(solution, "at", None)
    if own is not None:
        q, speed, acceleration = own(time)
        return q, speed, acceleration
    check_motion(solution)
    spline = path_spline(solution.time, solution.q)
    return spline(time), spline(time, 1), spline(time, 2)


def check_motion(solution: Solved) -> None:
    """Refuse motions that no servo can be asked for.

    Args:
        solution: The motion.

    Raises:
        ShapeError: If there are fewer than two samples.
        HandPathError: If an angle is not finite.

    Source:
        None (bookkeeping).
    """
    if len(solution.time) < 2:
        raise ShapeError(f"a servo needs a motion of at least two samples, this has {len(solution.time)}")
    bad = np.argwhere(~np.isfinite(solution.q))
    if bad.size:
        k, j = (int(i) for i in bad[0])
        raise HandPathError(
            f"joint {solution.arm.joint_names[j]!r} is {solution.q[k, j]} at sample {k}, expected a number"
        )
