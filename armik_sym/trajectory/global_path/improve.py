"""Better ways near a known one: accelerations counted, across poles and small humps of the objective."""

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

_STEPS = (0.04, 0.04, 0.04)
_COUNT = 8
_GAIN = 1e-5


def improved(problem: SwivelProblem, outline: Outline, smooth: Smoothness) -> Outline:
    outline = with_shifted_changes(problem, outline, smooth)
    for step in _STEPS:
        way = outline.way
        near = neighbours(problem, way, step, _COUNT)
        layer = np.repeat(np.arange(len(way.sample)), np.diff(near.first))
        cost = node_costs(problem, near.q, way.sample[layer], way.sample)
        chosen, value = smoothest_path(
            near.q, cost, near.first, most_per_step(problem, way.sample), smooth, problem.library
        )
        if not value < (1 - _GAIN) * outline.value:
            break
        psi = np.unwrap(near.psi[chosen])
        there = Way(way.sample, near.branch[chosen], psi, near.q[chosen], way.cost)
        new = with_shifted_changes(problem, smoothed(problem, there, smooth), smooth)
        if not new.value < (1 - _GAIN) * outline.value:
            break
        outline = new
    return outline
