"""The lower bound for a trajectory found over the swivel angle, and what it leads to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.solution.lower_bound import LowerBound
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.map_class import SwivelMap
from armik_sym.trajectory.by_swivel import Outline
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.lower_bound import lower_bound
from armik_sym.trajectory.rates import sample_durations
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]


def certified(problem: SwivelProblem, map_: SwivelMap, q: Array) -> LowerBound:
    """What no feasible trajectory can cost less than, as near to the cost of one as about 1 %.

    Args:
        problem: The problem.
        map_: The swivel map.
        q: The trajectory in hand, shape (n, dof), in [rad].

    Returns:
        The bound.

    Source:
        `trajectory.lower_bound` (this package).
    """
    time, extra = problem.path.time, problem.posture_cost
    other = 0.0 if extra is None else max(float(sample_durations(time) @ extra.evaluate(q)), 0.0)
    speed, acceleration, posture = problem.weights
    return lower_bound(
        map_.intervals,
        time,
        q,
        speed_weight=speed,
        acceleration_weight=acceleration,
        posture_weight=posture,
        preferred=problem.aim,
        other_cost=other,
        known_first=problem.first is not None,
    )


def suspected(problem: SwivelProblem, bound: LowerBound) -> Outline | None:
    """The way that a bound still suspects of being better.

    Args:
        problem: The problem.
        bound: The bound.

    Returns:
        The way through all samples; None if the bound suspects none.

    Source:
        None (this package).
    """
    if bound.suspect is None:
        return None
    at = swivel_of_postures(problem.intervals.curves[0].spherical, bound.suspect, problem.reference)
    signs = np.column_stack([at.elbow, at.shoulder, at.wrist])
    branch = problem.intervals.branch_of(signs)
    every = np.arange(len(bound.suspect))
    return Outline(Way(every, branch, np.unwrap(at.psi), bound.suspect, bound.value), bound.value)
