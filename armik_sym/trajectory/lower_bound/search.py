"""Rounds of bounding cells, putting them aside and halving the others."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.lower_bound.arcs import Arcs
from armik_sym.trajectory.lower_bound.cells import Cells
from armik_sym.trajectory.lower_bound.linearised import smoothed
from armik_sym.trajectory.lower_bound.passes import both_ways, least_chain
from armik_sym.trajectory.lower_bound.problem import (
    Problem,
    Start,
    beside_chain,
    first_fineness,
    layers_of,
    refined,
    start_of,
)
from armik_sym.trajectory.lower_bound.propagate import Layer

Array = NDArray[np.float64]

_ROUNDS = 12
_TRIALS = 4
_WORTH = 0.05


@dataclass
class Search:
    """Where a search is.

    Attributes:
        problem: What is searched.
        start: Knots and the linearisation that suits q*.
        allowed: Cells with a bound of at least minus this are put aside.
        arcs: Arcs that are left.
        cells: Their cells.
        known: Best bound of each arc, relative to f(q*), shape (m,).
        aside: Least bound of those put aside, relative to f(q*); at most 0.
        bound: Lower bound of f(q) - f(q*) for every feasible trajectory.
        looked_at: Cells bounded, counted every time.
        pairs: Pairs of cells looked at.
        chain: Postures at the knots minus reference where the bound is lowest, shape (J, joints searched),
            in [rad].
        done: Whether the bound is as near as was asked for.
    """

    problem: Problem
    start: Start
    allowed: float
    arcs: Arcs
    cells: Cells
    known: Array
    aside: float = 0.0
    bound: float = -np.inf
    looked_at: int = 0
    pairs: int = 0
    chain: Array = field(default_factory=lambda: np.zeros((0, 0)))
    done: bool = False


def search(problem: Problem, value: float, gap: float, most_pairs: int) -> Search:
    """Bound f(q) - f(q*) from below over all feasible trajectories.

    Args:
        problem: What is searched.
        value: f(q*) > 0.
        gap: Where to stop, relative to the value.
        most_pairs: Work allowed: pairs of cells, beyond the first bound.

    Returns:
        The search at its end.

    Source:
        None (this package): branch and bound over dynamic programming.
    """
    start = start_of(problem, gap * value)
    fineness = first_fineness(problem, start, value)
    arcs, _, cells = refined(problem, problem.arcs(start.knots), fineness)
    at = Search(problem, start, gap * value, arcs, cells, np.full(len(arcs), -np.inf))
    for _ in range(_ROUNDS):
        _round(at, value, most_pairs)
        if at.done or at.pairs >= most_pairs:
            break
        fineness = fineness.finer()
        at.arcs, parent, at.cells = refined(problem, at.arcs, fineness)
        at.known = at.known[parent]
    return at


def _round(at: Search, value: float, most_pairs: int) -> None:
    """Bound what is left, first with the linearisation that suits q*, then with those of the least chains."""
    away, problem = at.start.away, at.problem
    for trial in range(_TRIALS):
        before, count = at.bound, len(at.arcs)
        if not _bound_all(at, away, most_pairs) or at.done or at.bound < -value:
            return
        helped = len(at.arcs) < (1 - _WORTH) * count or at.bound > (1 - _WORTH) * before
        if trial and not helped:
            return
        e = beside_chain(problem, at.start.knots, at.chain)
        away = smoothed(problem.objective, problem.gradient, -e, at.start.span)


def _bound_all(at: Search, away: Array, most_pairs: int) -> bool:
    """Bound every cell with one linearisation and put cells aside; False if that is more than allowed."""
    layers, chain, loss = layers_of(at.problem, at.arcs, at.cells, at.start.knots, away)
    pairs = _pairs(layers)
    if at.looked_at and at.pairs + pairs > most_pairs:
        at.pairs = most_pairs
        return False
    at.pairs += pairs
    at.looked_at += len(at.cells.arc)
    passes = both_ways(layers, chain.stiffness)
    now = np.full(len(at.arcs), np.inf)
    np.minimum.at(now, at.cells.arc, np.concatenate(passes.through) - loss)
    at.known = np.maximum(at.known, now)
    first = np.searchsorted(at.arcs.sample, at.start.knots)
    per_knot = np.minimum.reduceat(at.known, first)
    at.bound = max(at.bound, min(at.aside, float(per_knot.max())))
    knot = int(np.argmax(per_knot))
    mine = at.known[at.cells.arc][_of_knot(layers, knot)]
    at.chain = least_chain(passes, layers, chain.stiffness, knot, int(np.argmin(mine)))
    _put_aside(at, first)
    return True


def _put_aside(at: Search, first: NDArray[np.int64]) -> None:
    left = at.known < -at.allowed
    at.aside = min(at.aside, float(at.known[~left].min(initial=0.0)))
    if np.any(np.add.reduceat(left.astype(np.int64), first) == 0):  # every trajectory passes through them
        at.bound = max(at.bound, at.aside)
    at.done = at.bound >= -at.allowed
    if at.done:
        return
    at.arcs, at.known, at.cells = at.arcs.rows(left), at.known[left], at.cells.of_arcs(left)


def _pairs(layers: list[Layer]) -> int:
    sizes = [len(layer.radius) for layer in layers]
    return 2 * sum(a * b for a, b in itertools.pairwise(sizes))


def _of_knot(layers: list[Layer], knot: int) -> slice:
    first = sum(len(layer.radius) for layer in layers[:knot])
    return slice(first, first + len(layers[knot].radius))
