"""Better ways near a known one: accelerations counted, across poles and small humps of the objective."""

from __future__ import annotations

import numpy as np

from armik_sym.trajectory.global_path.graph import most_per_step, node_costs
from armik_sym.trajectory.global_path.neighbours import neighbours
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.global_path.smoothed import Outline, settled, smoothed
from armik_sym.trajectory.global_path.smoothest_path import smoothest_path
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

_STEPS = (0.04, 0.04, 0.04)
_COUNT = 8
_GAIN = 1e-5
_JOIN = 5.0


def improved(problem: SwivelProblem, outline: Outline, smooth: Smoothness) -> Outline:
    outline = settled(problem, outline, smooth)
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
        new = settled(problem, smoothed(problem, there, smooth), smooth)
        if not new.value < (1 - _GAIN) * outline.value:
            break
        outline = new
    return outline


def combined(problem: SwivelProblem, outlines: list[Outline], smooth: Smoothness) -> Outline:
    """The best of what pieces of several ways over the same knots can be joined to, smoothed."""
    best = min(outlines, key=lambda each: each.value)
    if len(outlines) == 1:
        return best
    ways = [each.way for each in outlines]
    m, k = len(best.way.sample), len(ways)
    q = np.stack([way.q for way in ways])
    share = node_costs(problem, q.reshape(m * k, -1), np.tile(best.way.sample, k), best.way.sample).reshape(k, m)
    bent = 0.5 * np.square(sum(smooth.bend[:, i, None] * q[:, i : m - 2 + i] for i in range(3))).sum(2)/smooth.scale
    moved = 0.5 * np.square(smooth.speed[:,None] * np.diff(q, axis=1)).sum(2)/smooth.scale
    local = share
    local[:, 1:] += moved
    local[:, 1:-1] += bent
    e = np.square(q[:, None] - q[None]).sum(3)   # i, j, l
    total = local[:, 0]; before = np.zeros((m, k), dtype=np.int64)
    for l in range(1, m):
        t = total[:, None] + _JOIN * e[:, :, l]
        before[l] = t.argmin(0)
        total = t.min(0) + local[:, l]
    j = int(total.argmin()); pick=[j]
    for l in range(m - 1, 0, -1): pick.append(int(before[l][pick[-1]]))
    pick = np.array(pick[::-1])

    if (pick==pick[0]).all():

        return best
    at = pick, np.arange(m)
    branch, psi = (np.stack([getattr(way, name) for way in ways])[at] for name in ("branch", "psi"))
    new = smoothed(problem, Way(best.way.sample, branch, np.unwrap(psi), q[at], best.way.cost), smooth)

    return new if new.value < best.value else best
