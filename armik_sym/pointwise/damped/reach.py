"""Levenberg-Marquardt and Sugihara's method for one pose, readable: what the C loop does, in NumPy."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.compiled.kinematics import Kinematics
from armik_sym.pointwise.damped.bounded_step import bounded_step
from armik_sym.pointwise.damped.pose_residual import pose_residual
from armik_sym.pointwise.damped.settings import LM, DampedSettings
from armik_sym.pointwise.random_stream import random_bits, random_unit

Array = NDArray[np.float64]

# A squared error of this many m² or more, infinite or no number means that the target is no target.
_SENSELESS = 1e20


@dataclass(eq=False)
class Reached:
    """Where the tries for one pose ended.

    Attributes:
        q: Best posture, shape (dof,), in [rad], inside the range of motion.
        size: |e|² that is left, in [m²].
        iterations: Steps tried.
        evaluations: Poses computed.
    """

    q: Array
    size: float = math.nan
    iterations: int = 0
    evaluations: int = 0

    def take_if_better(self, q: Array, size: float) -> None:
        """Keep a posture if it is the first or the best: size < size so far.

        Args:
            q: Posture, shape (dof,), in [rad].
            size: Its |e|², in [m²].

        Source:
            None (bookkeeping).
        """
        if self.evaluations == 1 or size < self.size:
            self.q, self.size = q, size


class PoseReacher:
    """Brings the hand of one arm to single targets; every posture on the way is inside the range of motion.

    Args:
        kinematics: Kinematics of the arm.
        settings: Numbers of the method.

    Source:
        Al-Faiz, eq. 58-63; Sugihara (2011), doi:10.1109/TRO.2011.2148230.
    """

    def __init__(self, kinematics: Kinematics, settings: DampedSettings) -> None:
        self._kinematics = kinematics
        self._rom: RangeOfMotion = kinematics.arm.rom
        self._settings = settings

    def reach(self, target: Array, start: Array, key: int) -> Reached:
        """Try from a posture, then from random ones: `armik_damped_pose` in C.

        Args:
            target: Position and rotation row by row, shape (12,), in [m] and [1].
            start: First posture, shape (dof,), in [rad].
            key: Key of the random restarts.

        Returns:
            The best posture.

        Source:
            Al-Faiz, eq. 58-63; Sugihara (2011), doi:10.1109/TRO.2011.2148230.
        """
        rom, dof = self._rom, self._rom.dof
        q = rom.clip(np.where(np.isnan(start), rom.middle, start))
        reached = Reached(q)
        with np.errstate(all="ignore"):  # targets that are no numbers
            for attempt in range(self._settings.restarts + 1):
                if attempt:
                    places = np.arange((attempt - 1) * dof, attempt * dof, dtype=np.uint64)
                    q = rom.clip(rom.lower + random_unit(random_bits(key, places)) * rom.width)
                self._try_from(target, q, reached)
                if not self._settings.tolerance**2 <= reached.size < _SENSELESS:
                    break
        return reached

    def _try_from(self, target: Array, q: Array, reached: Reached) -> None:
        s = self._settings
        e, J = self._evaluate(target, q, reached)
        size = lowest = float(e @ e)
        reached.take_if_better(q, size)
        mu, stalled = s.damping, 0
        for _ in range(s.max_iterations):
            if not s.tolerance**2 <= lowest < _SENSELESS:
                break
            damping = (mu if s.method == LM else 0.5 * size + s.damping) + s.constant_damping
            step = bounded_step(J, e, damping, self._rom.lower - q, self._rom.upper - q)
            if step is None:
                break
            q_new = self._rom.clip(q + step)
            e_new, J_new = self._evaluate(target, q_new, reached)
            size_new = float(e_new @ e_new)
            reached.iterations += 1
            reached.take_if_better(q_new, size_new)
            helps = size_new < size
            stalled = 0 if size_new < (1.0 - s.progress) * lowest else stalled + 1
            lowest = min(lowest, size_new)
            if helps or s.method != LM:
                q, e, J, size = q_new, e_new, J_new, size_new
            mu = max(mu * (s.decrease if helps else s.increase), s.smallest)
            if stalled >= s.max_stalled or (s.method == LM and mu > s.largest):
                break

    def _evaluate(self, target: Array, q: Array, reached: Reached) -> tuple[Array, Array]:
        reached.evaluations += 1
        s = self._settings
        p, R, J = self._kinematics.pose_and_jacobian(q)
        return pose_residual(target, p, R, J, s.rows, s.rotation_weight, bool(s.printed))
