"""A motion in another time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError
from armik_sym.servo.given_number import is_number

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Retimed:
    """The samples of a motion at other times, and the motion between them.

    The path is the natural cubic spline q(s) through the samples, s the time of the original. s(t) is made of
    parabolas. Speed and acceleration limits hold for this motion at all times, so for its samples, for
    differences between samples, and for what `at` says in between.

    Attributes:
        arm: The arm.
        time: New times of the samples, from 0, shape (n,), in [s].
        q: The samples, as they were, shape (n, dof), in [rad].
        uniform_factor: Smallest factor by which slowing the whole motion would keep the limits.
        uniform_duration: How long it would take then, in [s].
        speed_limit: Shape (dof,), in [rad/s].
        acceleration_limit: Shape (dof,), in [rad/s²].
        solution: The original with new times, if it has a hand path; same samples, same errors, no cost.
        law: Ends of the pieces of s(t): times t, shape (m + 1,).
        path: s there.
        path_speed: ṡ there.
        path_acceleration: s̈ in the pieces, shape (m,).
        spline: q(s).
    """

    arm: Arm
    time: Array
    q: Array
    uniform_factor: float
    uniform_duration: float
    speed_limit: Array
    acceleration_limit: Array
    solution: Any
    law: Array
    path: Array
    path_speed: Array
    path_acceleration: Array
    spline: CubicSpline

    @property
    def duration(self) -> float:
        """How long it takes, in [s]."""
        return float(self.law[-1])

    def at(self, time: ArrayLike) -> tuple[Array, Array, Array]:
        """Angles, speeds and accelerations at any time: q(s), q' ṡ, q'' ṡ² + q' s̈; at rest outside.

        Args:
            time: Shape (k,), in [s].

        Returns:
            Each of shape (k, dof), in [rad], [rad/s] and [rad/s²].

        Source:
            Bobrow, Dubowsky & Gibson 1985, eq. 3-4.
        """
        t = np.asarray(time, dtype=np.float64)
        inside = np.clip(t, 0.0, self.law[-1])
        i = np.clip(np.searchsorted(self.law, inside, side="right") - 1, 0, len(self.law) - 2)
        since = inside - self.law[i]
        u = self.path_acceleration[i]
        s = np.minimum(self.path[i] + self.path_speed[i] * since + 0.5 * u * since**2, self.path[i + 1])
        # ṡ from s, not from t: both are exact, but only this keeps ṡ² linear in s to the last digit.
        rate = np.sqrt(np.maximum(self.path_speed[i] ** 2 + 2 * u * (s - self.path[i]), 0.0))
        first, second = self.spline(s, 1), self.spline(s, 2)
        moves = ((t >= 0) & (t <= self.law[-1]))[:, None]
        speed = np.where(moves, first * rate[:, None], 0.0)
        acceleration = np.where(moves, second * rate[:, None] ** 2 + first * u[:, None], 0.0)
        return self.spline(s), speed, acceleration

    def sampled(self, rate: float) -> tuple[Array, Array]:
        """The motion at even times, the last posture included, for a controller.

        Args:
            rate: In [Hz].

        Returns:
            Time, shape (k,), in [s], and joint angles, shape (k, dof), in [rad].

        Raises:
            OptionError: If the rate is not positive.

        Source:
            None (this package).
        """
        if not (is_number(rate) and rate > 0):
            raise OptionError(f"rate is {rate!r} Hz, expected a positive number")
        time = np.arange(int(np.ceil(self.duration * rate - 1e-9)) + 1) / rate
        return time, self.at(np.minimum(time, self.duration))[0]

    def __str__(self) -> str:
        return (
            f"re-timed: {self.duration:.4g} s for a path of {self.path[-1] - self.path[0]:.4g} s; slowed "
            f"uniformly by {self.uniform_factor:.4g} it would take {self.uniform_duration:.4g} s"
        )
