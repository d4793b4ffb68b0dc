"""The damped least-squares step that stays inside the range of motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def bounded_step(J: Array, e: Array, damping: float, lowest: Array, highest: Array) -> Array | None:
    """The step d: min |J d - e|² + λ|d|² subject to lowest ≤ d ≤ highest.

    An active set: go towards the minimum of the free joints up to the first limit, fix the joint that
    meets it, and let go a fixed joint where that lowers the objective. The same decisions as
    `armik_damped_step` in compiled/c/bounded_step.h.

    Args:
        J: Jacobian rows, shape (m, dof).
        e: Residual, target minus current, shape (m,).
        damping: λ > 0.
        lowest: Lower limits minus posture, shape (dof,), in [rad]; not above 0.
        highest: Upper limits minus posture, shape (dof,), in [rad]; not below 0.

    Returns:
        Step, shape (dof,), in [rad]; None if the numbers allow none.

    Source:
        Al-Faiz, eq. 62; active set: Nocedal and Wright, Numerical Optimization (2006), §16.5.
    """
    pull = J.T @ e
    side = np.where(~(lowest < 0) & (pull <= 0), -1, 0)
    side = np.where(~(highest > 0) & (pull >= 0), 1, side)
    d = np.zeros(J.shape[1])
    for _ in range(4 * len(d)):
        try:
            towards = _free_minimum(J, e, damping, d, side == 0)
        except np.linalg.LinAlgError:
            return None
        stopped = _go_up_to_limit(d, towards, side, lowest, highest)
        if stopped:
            continue
        pull = (J.T @ (e - J @ d) - damping * d) * -side  # of fixed joints, inwards
        pull[~(lowest < highest)] = 0.0
        hardest = int(np.argmax(pull))
        if not pull[hardest] > 0:
            break
        side[hardest] = 0
    return d


def _free_minimum(J: Array, e: Array, damping: float, d: Array, free: NDArray[np.bool_]) -> Array:
    """Minimum over the free joints; the others stay."""
    A, left = J[:, free], e - J[:, ~free] @ d[~free]
    towards = d.copy()
    if len(e) < A.shape[1]:
        towards[free] = A.T @ np.linalg.solve(A @ A.T + damping * np.eye(len(e)), left)
    elif A.shape[1]:
        towards[free] = np.linalg.solve(A.T @ A + damping * np.eye(A.shape[1]), A.T @ left)
    return towards


def _go_up_to_limit(d: Array, towards: Array, side: NDArray[np.int_], lowest: Array, highest: Array) -> bool:
    """Move d (in place) towards a point up to the first limit; whether one was met."""
    free = side == 0
    beyond = np.flatnonzero(free & ~((towards >= lowest) & (towards <= highest)))
    if not beyond.size:
        d[free] = towards[free]
        return False
    limit = np.where(towards < lowest, lowest, highest)[beyond]
    possible = (limit - d[beyond]) / (towards[beyond] - d[beyond])
    first = int(np.argmin(possible))
    d[free] += max(float(possible[first]), 0.0) * (towards[free] - d[free])
    joint = beyond[first]
    side[joint] = -1 if towards[joint] < lowest[joint] else 1
    d[joint] = limit[first]
    return True
