"""Promising ways through the swivel map, each smoothed at its knots."""

from __future__ import annotations

from dataclasses import replace

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
from armik_sym.trajectory.one_curve.smoothness import Smoothness, smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Ways looked for, and tried to find them.
_CANDIDATES = 6
_ATTEMPTS = 16
# Ways whose joint angles differ by less than this everywhere are one, in [rad].
_ALIKE = 0.02
# How much dearer than the best others may be, relative: to the search, and once they are smoothed.
_WITHIN = 0.4
_KEPT = 0.03
# Rounds of adding knots.
_ROUNDS = 4
# A way that is farther outside the intervals than this between its knots needs another one, in [rad] …
_MISSED = 0.02
# … and cannot pass if no posture is nearer to it than this, in [rad].
_FAR = 0.3


def outlines(
    problem: SwivelProblem, most: int = _CANDIDATES, within: float = _WITHIN, kept: float = _KEPT
) -> list[Outline]:
    """Promising ways through the map, the best first.

    Args:
        problem: The problem.
        most: Most ways looked for.
        within: Others are looked for that cost at most 1 + `within` times as much as the cheapest, to the
            search: it does not know accelerations well.
        kept: Others are handed back that cost at most 1 + `kept` times as much as the best, once smoothed.

    Returns:
        Ways whose swivel angles lie in feasible intervals at every sample; none if no way leads through.

    Source:
        Bellman (1957); knots are added where a way leaves the intervals between its knots.
    """
    chosen = np.union1d(knots(problem.path, _reach(problem)), straight_arm_knots(problem.intervals))
    for _ in range(_ROUNDS):
        found, lost = _distinct(problem, search_graph(problem, chosen), most, within, kept)
        denser = np.union1d(chosen, np.clip(lost[:, None] + np.arange(-1, 2), 0, len(problem.path) - 1))
        if not lost.size or len(denser) == len(chosen):
            break
        chosen = denser
    return sorted(found, key=lambda each: each.value)


def _distinct(
    problem: SwivelProblem, graph: Graph, most: int, within: float, kept: float
) -> tuple[list[Outline], Indices]:
    """The best way and others, drawn through all samples that need it, and samples the best cannot pass."""
    smooth = smoothness(problem.path.time[graph.knots], problem.weights, problem.aim, problem.posture_cost)
    known = _known(problem, graph, smooth, most, within)
    found: list[Outline] = []
    lost = np.zeros(0, dtype=np.int64)
    if not known:
        return found, lost
    best = improved(problem, joined(problem, known, smooth), smooth)
    others = [each for each in known if not _same(each.way, best.way)]
    worth = [each for each in others if each.value <= (1 + kept) * best.value]
    for outline in [best, *sorted(worth, key=lambda each: each.value)]:
        drawn, gaps = _drawn_through(problem, outline)
        if not gaps.size:
            found.append(drawn)
        elif outline is best:
            lost = gaps
    return found, lost


def _known(
    problem: SwivelProblem, graph: Graph, smooth: Smoothness, most: int, within: float
) -> list[Outline]:
    """Ways of the graph that stay different when they are smoothed."""
    known: list[Outline] = []
    base: Way | None = None
    search = WaySearch(graph.nodes, graph.cost, graph.edges, problem.library)
    way = search.cheapest()
    limit = np.inf if way is None else (1 + within) * way.cost
    for _ in range(_ATTEMPTS if most > 1 else 1):
        if way is None or len(known) >= most:
            break
        base = base or way
        outline = smoothed(problem, _like_first(way, base, known), smooth)
        if not any(_same(outline.way, other.way) for other in known):
            known.append(outline)
        way = search.another([way, outline.way], limit) if most > 1 else None
    return known


def _like_first(way: Way, base: Way, known: list[Outline]) -> Way:
    """A way with the smoothed postures of the first one wherever both pass the same nodes of the graph."""
    if not known:
        return way
    first = known[0].way
    same = (way.branch == base.branch) & (way.q == base.q).all(axis=1)
    psi = np.where(same, way.psi + (first.psi - base.psi), way.psi)
    return replace(way, psi=psi, q=np.where(same[:, None], first.q, way.q))


def _same(a: Way, b: Way) -> bool:
    return len(a.q) == len(b.q) and bool(np.abs(a.q - b.q).max() < _ALIKE)


def _drawn_through(problem: SwivelProblem, outline: Outline) -> tuple[Outline, Indices]:
    """An outline with the samples added at which it changes the branch or leaves the intervals.

    The second part lists samples that it cannot pass.
    """
    way = outline.way
    outside = np.flatnonzero(corridor_of(problem, way).missed > _MISSED)
    changes = np.flatnonzero(np.diff(way.branch))
    between = [np.arange(way.sample[i] + 1, way.sample[i + 1]) for i in changes]
    further = np.setdiff1d(np.concatenate([outside, *between]), way.sample).astype(np.int64)
    if not further.size:
        return outline, outside
    args = (problem.path.time, problem.intervals, problem.reference, problem.backend)
    way, away = with_samples(way, further, *args)
    lost = further[away > _FAR]
    if not lost.size:
        lost = np.setdiff1d(np.flatnonzero(corridor_of(problem, way).missed > _MISSED), further)
    return Outline(way, outline.value), lost


def _reach(problem: SwivelProblem) -> float:
    return float(sum(problem.arm.lengths.values())) or 1.0
