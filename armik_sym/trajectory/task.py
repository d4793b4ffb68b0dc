"""One whole-trajectory task, with everything about it that stays fixed during the attempts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.stage_functions import StageFunctions
from armik_sym.motion.hand_path import HandPath
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.full_space import (
    FullSpaceProblem,
    QuadraticCost,
    SampleCost,
    for_all_samples,
    full_space_problem,
)
from armik_sym.trajectory.ipopt import Bounds
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.posture_cost import PostureCost, posture_cost, preferred_posture
from armik_sym.trajectory.rates import (
    acceleration_matrix,
    drawn_in,
    objective_scale,
    sample_durations,
    smoothness_matrix,
    speed_matrix,
)
from armik_sym.trajectory.targets import stage_targets

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Task:
    """What is to be solved.

    Making one refuses clearances and preferences that do not fit the arm, and compiles what they cost.

    Attributes:
        arm: The arm.
        path: The hand path.
        orientation: What of the path's orientation is tracked.
        options: The user's choices.
        max_speed: Speed limits, shape (dof,), in [rad/s].
        max_acceleration: Acceleration limits, shape (dof,), in [rad/s²].
        first: The posture at sample 0 if it is known, shape (dof,), in [rad], otherwise None.
        stage: Compiled tracking equations.

    Raises:
        OptionError: If clearances or preference do not fit the arm.
    """

    arm: Arm
    path: HandPath
    orientation: Orientation
    options: TrajectoryOptions
    max_speed: Array
    max_acceleration: Array
    first: Array | None
    stage: StageFunctions

    def __post_init__(self) -> None:
        _ = self.preferred_posture, self.posture_cost

    @cached_property
    def preferred_posture(self) -> Array:
        """The posture that the posture term is drawn to, shape (dof,), in [rad]."""
        return preferred_posture(self.arm, self.options.prefer)

    @cached_property
    def posture_cost(self) -> PostureCost | None:
        """Clearance and elbow direction as a cost of single postures; None if not asked for."""
        return posture_cost(self.arm, self.options, "auto" if self.stage.backend == "c" else "vm")

    @cached_property
    def targets(self) -> Array:
        """Targets as the tracking equations read them, shape (n, target_size)."""
        return stage_targets(self.arm, self.path, self.orientation)

    @cached_property
    def speed_rows(self) -> sp.csr_array:
        """Rows that give all joint speeds from the angles, shape ((n-1)·dof, n·dof)."""
        return sp.csr_array(sp.kron(speed_matrix(self.path.time), sp.eye_array(self.arm.dof)))

    @cached_property
    def acceleration_rows(self) -> sp.csr_array:
        """Rows that give all joint accelerations from the angles, shape ((n-2)·dof, n·dof)."""
        return sp.csr_array(sp.kron(acceleration_matrix(self.path.time), sp.eye_array(self.arm.dof)))

    def problem(self, *, soft: bool, rates: bool) -> FullSpaceProblem:
        """The problem, with or without tracking errors as variables and rate rows.

        Args:
            soft: True if tracking errors are variables.
            rates: True if speed and acceleration are constrained.

        Returns:
            The problem.

        Source:
            None (direct transcription).
        """
        rows = self._rate_rows() if rates else sp.csr_array((0, len(self.path) * self.arm.dof))
        cost, posture = self._cost(soft), self.posture_cost
        weights = cost.scale * sample_durations(self.path.time)
        return full_space_problem(
            self.stage,
            self.arm.length_values,
            self.targets,
            self.arm.dof,
            cost,
            rows,
            soft=soft,
            sample_cost=None if posture is None else SampleCost(posture, weights),
        )

    def bounds(self, *, soft: bool, rates: bool) -> Bounds:
        """Bounds that go with `problem`: range of motion, equations and rate limits.

        Args:
            soft: As for `problem`.
            rates: As for `problem`.

        Returns:
            The bounds.

        Source:
            None (direct transcription).
        """
        n, m = len(self.path), self.orientation.equations
        lower, upper = np.tile(self.arm.rom.lower, n), np.tile(self.arm.rom.upper, n)
        tracking_lower, tracking_upper = np.zeros(n * m), np.zeros(n * m)
        if self.first is not None:
            lower[: self.arm.dof] = upper[: self.arm.dof] = self.first
            if not soft:
                # Sample 0 is known: its equations hold already, and have no variable left.
                tracking_lower[:m], tracking_upper[:m] = -np.inf, np.inf
        if soft:
            lower = np.concatenate([lower, np.full(n * m, -np.inf)])
            upper = np.concatenate([upper, np.full(n * m, np.inf)])
        limits = drawn_in(self._rate_limits()) if rates else np.empty(0)
        return Bounds(
            lower,
            upper,
            np.concatenate([tracking_lower, -limits]),
            np.concatenate([tracking_upper, limits]),
        )

    def start_vector(self, q: Array, *, soft: bool) -> Array:
        """Variables for a guess of the angles; with soft tracking, its errors come along.

        Args:
            q: Joint angles, shape (n, dof), in [rad].
            soft: As for `problem`.

        Returns:
            Shape (n_x,).

        Source:
            None (bookkeeping).
        """
        if self.first is not None:
            q = np.vstack([self.first, q[1:]])
        if not soft:
            return q.ravel()
        residual = for_all_samples(self.stage.residual, len(q))
        errors = np.asarray(residual(q.T, self.arm.length_values, self.targets.T))
        return np.concatenate([q.ravel(), np.clip(errors.T.ravel(), -10.0, 10.0)])

    def exceeds_rates(self, q: Array) -> bool:
        """True if a joint is faster or accelerates more than allowed.

        Args:
            q: Joint angles, shape (n, dof), in [rad].

        Returns:
            Whether any limit is exceeded.

        Source:
            None (definition).
        """
        limits = self._rate_limits()
        return bool(np.any(np.abs(self._rate_rows() @ q.ravel()) > limits))

    def _limited(self) -> tuple[bool, bool]:
        return bool(np.isfinite(self.max_speed).any()), bool(np.isfinite(self.max_acceleration).any())

    def _rate_rows(self) -> sp.csr_array:
        speed, acceleration = self._limited()
        rows = [self.speed_rows] if speed else []
        rows += [self.acceleration_rows] if acceleration else []
        return sp.csr_array(sp.vstack(rows)) if rows else sp.csr_array((0, len(self.path) * self.arm.dof))

    def _rate_limits(self) -> Array:
        n = len(self.path)
        speed, acceleration = self._limited()
        parts = [np.tile(self.max_speed, n - 1)] if speed else []
        parts += [np.tile(self.max_acceleration, max(n - 2, 0))] if acceleration else []
        return np.concatenate(parts) if parts else np.empty(0)

    def _cost(self, soft: bool) -> QuadraticCost:
        o, dof, m, time = self.options, self.arm.dof, self.orientation.equations, self.path.time
        K = smoothness_matrix(time, o.speed_weight, o.acceleration_weight, o.posture_weight)
        P = sp.csc_array(sp.kron(K, sp.eye_array(dof)))
        c = -o.posture_weight * np.outer(sample_durations(time), self.preferred_posture).ravel()
        if soft:
            sigma = np.array([o.position_sigma] * 3 + [o.rotation_sigma] * (m - 3))
            weights = np.outer(sample_durations(time), sigma**-2).ravel()
            P = sp.csc_array(sp.block_diag([P, sp.diags_array(weights)]))
            c = np.concatenate([c, np.zeros(len(weights))])
        largest = float(K.diagonal().max())
        if self.posture_cost is not None:
            largest += self.posture_cost.curvature * float(sample_durations(time).max())
        scale = objective_scale(largest)
        return QuadraticCost(scale * P, scale * c, scale)
