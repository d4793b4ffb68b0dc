"""The intervals and postures at all samples around a way that is known at some."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.global_path.corridor import Corridor, corridor, interpolated
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]


def joint_guess(problem: SwivelProblem, way: Way) -> Array:
    """Joint angles at all samples, straight from knot to knot.

    Args:
        problem: The problem.
        way: The way.

    Returns:
        Shape (n, dof), in [rad].

    Source:
        None (linear interpolation).
    """
    return way.straight(problem.path.time)


def corridor_of(problem: SwivelProblem, way: Way) -> Corridor:
    """The intervals around a way at every sample.

    Args:
        problem: The problem.
        way: The way.

    Returns:
        The corridor.

    Source:
        None (this package).
    """
    psi = interpolated(problem.path.time, way.sample, way.psi, way.branch)
    nearest = np.searchsorted(way.sample, np.arange(len(psi)), side="right") - 1
    return corridor(problem.intervals, way.branch[nearest], psi, joint_guess(problem, way), problem.backend)
