"""Better ways near a known one: accelerations counted, across poles and over small humps of the objective."""

from __future__ import annotations

import numpy as np

from armik_sym.trajectory.global_path.change_shifts import with_shifted_changes
from armik_sym.trajectory.global_path.graph import most_per_step, node_costs
from armik_sym.trajectory.global_path.neighbours import neighbours
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.global_path.smoothed import Outline, smoothed
from armik_sym.trajectory.global_path.smoothest_path import smoothest_path
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

# Distance between neighbouring postures, in [rad]; the way goes up to `_COUNT` of them aside in one round.
_STEP = 0.04
_COUNT = 8
_ROUNDS = 3
# Relative improvement that counts.
_GAIN = 1e-5


def improved(problem: SwivelProblem, outline: Outline, smooth: Smoothness) -> Outline:
    """A smoothed way, or a better one near it.

    Newton steps end at the foot of the hump they began on, the search before them does not see accelerations.
    Here the best path through postures around the way is found with accelerations counted, and smoothed; as
    long as that helps.

    Args:
        problem: The problem.
        outline: The smoothed way.
        smooth: The objective over its knots.

    Returns:
        The way, no more expensive than before.

    Source:
        None (this package).
    """
    outline = with_shifted_changes(problem, outline, smooth)
    for _ in range(_ROUNDS):
        there = _best_nearby(problem, outline, smooth)
        if there is None:
            break
        new = with_shifted_changes(problem, smoothed(problem, there, smooth), smooth)
        if not new.value < (1 - _GAIN) * outline.value:
            break
        outline = new
    return outline


def _best_nearby(problem: SwivelProblem, outline: Outline, smooth: Smoothness) -> Way | None:
    """The best path through postures around a way; None if it is not better than the way."""
    way = outline.way
    if len(way.sample) < 2:
        return None
    near = neighbours(problem, way, _STEP, _COUNT)
    sample = np.repeat(way.sample, np.diff(near.first))
    cost = node_costs(problem, near.q, sample, way.sample)
    most = most_per_step(problem, way.sample)
    chosen, value = smoothest_path(near.q, cost, near.first, most, smooth, problem.library)
    if not value < (1 - _GAIN) * outline.value:
        return None
    psi = np.unwrap(near.psi[chosen])
    return Way(way.sample, near.branch[chosen], psi, near.q[chosen], way.cost)
