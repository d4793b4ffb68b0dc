"""Promising ways through the swivel map, each smoothed at its knots."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.global_path.between import with_samples
from armik_sym.trajectory.global_path.graph import Graph, search_graph
from armik_sym.trajectory.global_path.improve import improved
from armik_sym.trajectory.global_path.joined import joined
from armik_sym.trajectory.global_path.knots import knots, straight_arm_knots
from armik_sym.trajectory.global_path.search import Way, WaySearch
from armik_sym.trajectory.global_path.smoothed import Outline, smoothed
from armik_sym.trajectory.global_path.way_corridor import corridor_of
from armik_sym.trajectory.one_curve.smoothness import smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_CANDIDATES = 6
_ATTEMPTS = 16
_ALIKE = 0.02

_WITHIN = 0.5
_ROUNDS = 4
_MISSED = 0.02
_FAR = 0.3


def outlines(problem: SwivelProblem, most: int = _CANDIDATES, within: float = _WITHIN) -> list[Outline]:
    """Promising ways through the map, the best first.

    Args:
        problem: The problem.
        most: Most ways wanted.
        within: Others may cost at most 1 + `within` times as much as the cheapest, to the search.

    Returns:
        Ways whose swivel angles lie in feasible intervals at every sample; none if no way leads through.

    Source:
        Bellman (1957); knots are added where a way leaves the intervals between its knots.
    """
    chosen = np.union1d(knots(problem.path, _reach(problem)), straight_arm_knots(problem.intervals))
    for _ in range(_ROUNDS):
        found, lost = _distinct(problem, search_graph(problem, chosen), most, within)
        denser = np.union1d(chosen, np.clip(lost[:, None] + np.arange(-1, 2), 0, len(problem.path) - 1))
        if not lost.size or len(denser) == len(chosen):
            break
        chosen = denser
    return sorted(found, key=lambda each: each.value)


def _distinct(
    problem: SwivelProblem, graph: Graph, most: int, within: float
) -> tuple[list[Outline], Indices]:
    """Outlines of ways that stay different when they are smoothed, and samples the cheapest cannot pass."""
    found: list[Outline] = []
    known: list[Outline] = []
    lost = np.zeros(0, dtype=np.int64)
    smooth = smoothness(problem.path.time[graph.knots], problem.weights, problem.aim, problem.posture_cost)
    search = WaySearch(graph.nodes, graph.cost, graph.edges, problem.library)
    way = search.cheapest()
    limit = np.inf if way is None else (1 + within) * way.cost
    for number in range(_ATTEMPTS):
        if way is None or len(known) >= most:
            break
        outline = smoothed(problem, way, smooth)
        if not any(_same(outline.way, other.way) for other in known):
            known.append(outline)
        if most == 1:
            break
        way = search.another([way, outline.way], limit)
    if not known:
        return found, lost
    known.sort(key=lambda each: each.value)
    best = improved(problem, joined(problem, known, smooth), smooth)
    for outline in [best, *(each for each in known if not _same(each.way, best.way))]:
        drawn, gaps = _drawn_through(problem, outline)
        if not gaps.size:
            found.append(drawn)
        elif outline is best:
            lost = gaps
    return found, lost


def _same(a: Way, b: Way) -> bool:
    return len(a.q) == len(b.q) and bool(np.abs(a.q - b.q).max() < _ALIKE)


def _drawn_through(problem: SwivelProblem, outline: Outline) -> tuple[Outline, Indices]:
    """An outline with the samples added at which it changes the branch or leaves the intervals.

    The second part lists samples that it cannot pass.
    """
    way = outline.way
    further = np.setdiff1d(_unsettled(problem, way), way.sample)
    lost = np.zeros(0, dtype=np.int64)
    if further.size:
        args = (problem.path.time, problem.intervals, problem.reference, problem.backend)
        way, away = with_samples(way, further, *args)
        lost = further[away > _FAR]
    if not lost.size:
        lost = np.setdiff1d(np.flatnonzero(corridor_of(problem, way).missed > _MISSED), further)
    return Outline(way, outline.value), lost


def _unsettled(problem: SwivelProblem, way: Way) -> Indices:
    """Samples that need a knot: a way leaves the intervals there, or changes the branch around them."""
    outside = np.flatnonzero(corridor_of(problem, way).missed > _MISSED)
    changes = np.flatnonzero(np.diff(way.branch))
    between = [np.arange(way.sample[i] + 1, way.sample[i + 1]) for i in changes]
    return np.concatenate([outside, *between]).astype(np.int64)


def _reach(problem: SwivelProblem) -> float:
    return float(sum(problem.arm.lengths.values())) or 1.0
