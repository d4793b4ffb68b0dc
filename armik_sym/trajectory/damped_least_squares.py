"""Bounded damped least squares: one sample after another, to find a first guess."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.compiled.kinematics import Kinematics
from armik_sym.trajectory.pose_error import SampleError

Array = NDArray[np.float64]

_SMALLEST_DAMPING = 1e-9
_SOLVED = 1e-10

# A sample counts as reached where less than this is left of the error, in [m].
REACHED = 1e-7


@dataclass(frozen=True, eq=False)
class Reached:
    """Where an iteration ended.

    Attributes:
        q: Posture, shape (dof,), in [rad].
        error: Length of the error twist that is left, in [m].
    """

    q: Array
    error: float


class PoseSolver:
    """Finds postures inside the range of motion for single samples of a path.

    Each step solves min |J d - e|² + λ|d|² with lower ≤ q + d ≤ upper by an active set: joints that
    would leave their range stop at the limit, the others take over. λ = ½|e|² + 1e-9 vanishes with
    the error, so that convergence stays quadratic; it grows where a step does not help.

    Args:
        kinematics: Kinematics of the arm.
        sample_error: Error twists along the path.

    Source:
        Sugihara (2011), doi:10.1109/TRO.2011.2148230 (damping by the error); active set: this package.
    """

    def __init__(self, kinematics: Kinematics, sample_error: SampleError) -> None:
        self._kinematics = kinematics
        self._sample_error = sample_error
        self._rom = kinematics.arm.rom

    def reach(self, k: int, q0: Array, iterations: int = 60) -> Reached:
        """Bring the hand to sample k from a posture.

        Args:
            k: Index of the sample.
            q0: Starting posture, shape (dof,), in [rad].
            iterations: Most steps tried.

        Returns:
            The best posture found.

        Source:
            Sugihara (2011), doi:10.1109/TRO.2011.2148230.
        """
        q = self._rom.clip(q0)
        e, J = self._error(k, q)
        size, raised = float(e @ e), 1.0
        for _ in range(iterations):
            if size < _SOLVED**2:
                break
            step = bounded_step(J, e, raised * 0.5 * size + _SMALLEST_DAMPING * raised, q, self._rom)
            candidate = self._rom.clip(q + step)
            e_new, J_new = self._error(k, candidate)
            size_new = float(e_new @ e_new)
            if size_new < size:
                slow = size_new > 0.999 * size
                q, e, J, size, raised = candidate, e_new, J_new, size_new, max(raised / 10, 1.0)
                if slow and raised == 1.0:
                    break
            else:
                raised *= 10
                if raised > 1e8:
                    break
        return Reached(q, float(np.sqrt(size)))

    def follow(self, samples: NDArray[np.int64], q0: Array, iterations: int = 12) -> tuple[Array, Array]:
        """Follow samples one after another, each from the posture before.

        Args:
            samples: Indices of the samples in the order to visit, shape (m,).
            q0: Starting posture, shape (dof,), in [rad].
            iterations: Most steps per sample.

        Returns:
            Postures, shape (m, dof), in [rad], and the error left at each, shape (m,), in [m].

        Source:
            Sugihara (2011), doi:10.1109/TRO.2011.2148230.
        """
        postures = np.empty((len(samples), len(q0)))
        errors = np.empty(len(samples))
        q = np.asarray(q0, dtype=np.float64)
        for row, k in enumerate(samples):
            reached = self.reach(int(k), q, iterations)
            postures[row], errors[row] = reached.q, reached.error
            q = reached.q
        return postures, errors

    def idle_joints(self, q: Array) -> NDArray[np.intp]:
        """Joints that change nothing of what is tracked: columns of zeros in the tracked rows of J.

        Args:
            q: A posture in general position, shape (dof,), in [rad].

        Returns:
            Their indices.

        Source:
            None (definition).
        """
        _, J = self._error(0, q)
        return np.flatnonzero(np.abs(J).max(axis=0) < 1e-12)

    def _error(self, k: int, q: Array) -> tuple[Array, Array]:
        return self._sample_error(k, *self._kinematics.pose_and_jacobian(q))


def bounded_step(J: Array, e: Array, damping: float, q: Array, rom: RangeOfMotion) -> Array:
    """The damped least-squares step that stays inside the range of motion.

    min |J d - e|² + λ|d|² subject to lower ≤ q + d ≤ upper; joints found at a limit are fixed there
    and the rest is solved again, at most dof times.

    Args:
        J: Jacobian rows, shape (m, dof).
        e: Error, shape (m,).
        damping: λ > 0.
        q: Posture, shape (dof,), in [rad].
        rom: Range of motion.

    Returns:
        Step d, shape (dof,), in [rad].

    Source:
        None (active set).
    """
    lowest, highest = rom.lower - q, rom.upper - q
    step = np.zeros(len(q))
    free = np.arange(len(q))
    left = e
    while free.size:
        A = J[:, free]
        if len(e) < free.size:
            part = A.T @ np.linalg.solve(A @ A.T + damping * np.eye(len(e)), left)
        else:
            part = np.linalg.solve(A.T @ A + damping * np.eye(free.size), A.T @ left)
        outside = (part < lowest[free]) | (part > highest[free])
        if not outside.any():
            step[free] = part
            break
        stopped = free[outside]
        step[stopped] = np.clip(part[outside], lowest[stopped], highest[stopped])
        left = left - J[:, stopped] @ step[stopped]
        free = free[~outside]
    return step
