"""What is searched for a lower bound, and how knots and layers of it are made."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.lower_bound.arcs import Arcs, anywhere, arcs_of, near_pole
from armik_sym.trajectory.lower_bound.cells import Cells, cells_of
from armik_sym.trajectory.lower_bound.chain import Chain, chain_at, knots_within
from armik_sym.trajectory.lower_bound.linearised import Objective, beside, linearised, smoothed
from armik_sym.trajectory.lower_bound.propagate import Layer, layer_of

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Spans of smoothing that are tried, in [s]; share of the gap that linearising and sag may use.
_SPANS = (0.0, 0.02, 0.04, 0.08, 0.16)
_SHARE = 0.5
# Widest arcs, narrowest that are still halved, and longest half tangents, in [rad].
_WIDEST, _NARROWEST, _LONGEST = 0.4, 2e-4, 0.15
_TINY = 1e-300


@dataclass(frozen=True, eq=False)
class Problem:
    """Feasible curves, objective and the trajectory everything is relative to.

    Attributes:
        intervals: The feasible intervals.
        time: Time stamps, shape (n,), in [s].
        objective: The objective.
        q: The reference trajectory q*, shape (n, dof), in [rad].
        gradient: Gradient of the objective at q*, 0 for joints not searched, shape (n, dof).
        joints: Joints that are searched; the others have the angles of the reference in every trajectory.
        box: Lower and upper limits, sample by sample, shape (n, dof) each, in [rad].
        known_first: Whether the first posture has to be that of the reference.
    """

    intervals: FeasibleIntervals
    time: Array
    objective: Objective
    q: Array
    gradient: Array
    joints: Indices
    box: tuple[Array, Array]
    known_first: bool

    def arcs(self, knots: Indices) -> Arcs:
        """The feasible intervals at the knots, cut.

        Args:
            knots: Samples, shape (J,).

        Returns:
            The arcs.

        Source:
            None (bookkeeping).
        """
        found = arcs_of(self.intervals, knots, _WIDEST)
        if not self.known_first:
            return found
        return anywhere(knots[:1]).followed_by(found.rows(found.sample > 0))

    def cells(self, arcs: Arcs) -> Cells:
        """Cells around arcs.

        Args:
            arcs: The arcs.

        Returns:
            The cells.

        Source:
            `cells_of`.
        """
        return cells_of(self.intervals, arcs, self.box)


@dataclass(frozen=True, eq=False)
class Start:
    """What the search begins with.

    Attributes:
        away: v of the linearisation that suits q*, shape (n, dof), in [rad].
        span: Span of smoothing, in [s].
        knots: Samples, shape (J,).
    """

    away: Array
    span: float
    knots: Indices


def start_of(problem: Problem, allowed: float) -> Start:
    """The smoothing that needs the fewest knots, with losses of at most a part of what is allowed.

    Args:
        problem: What is searched.
        allowed: f(q*) minus the bound that is aimed at.

    Returns:
        Linearisation and knots.

    Source:
        None (this package).
    """
    objective, gradient = problem.objective, problem.gradient
    avoid = near_pole(problem.intervals)
    avoid[np.setdiff1d(np.arange(len(avoid)), problem.intervals.sample)] = True
    avoid[0] &= not problem.known_first
    best: Start | None = None
    for span in _SPANS:
        away = smoothed(objective, gradient, np.zeros_like(gradient), span)
        seen = linearised(objective, gradient, away)
        budget = _SHARE * allowed - seen.loss
        if budget < 0 and best is not None:
            break
        knots = knots_within(objective, seen.force, max(budget, 0.0), avoid)
        if best is None or len(knots) < len(best.knots):
            best = Start(away, span, knots)
    return best if best is not None else Start(np.zeros_like(gradient), 0.0, np.arange(len(gradient)))


@dataclass(frozen=True)
class Fineness:
    """How fine arcs are to be.

    Attributes:
        radius: Largest bound of what the tangent leaves, in [rad].
        length: Largest half length of the tangent, in [rad].
    """

    radius: float
    length: float

    def finer(self) -> Fineness:
        """Twice as fine: what the tangent leaves goes with the square of the length."""
        return Fineness(0.25 * self.radius, 0.5 * self.length)


def first_fineness(problem: Problem, start: Start, value: float) -> Fineness:
    """Arcs short enough for a first bound that says something.

    The curvature of cells of radius ε costs some 10·C·ε² per knot: together no more than the value itself.

    Args:
        problem: What is searched.
        start: Its beginning.
        value: f(q*).

    Returns:
        The fineness.

    Source:
        None (this package).
    """
    stiffness = chain_at(problem.objective, problem.gradient, start.knots).stiffness.sum()
    return Fineness(float(np.sqrt(value / max(10 * stiffness, _TINY))), _LONGEST)


def refined(problem: Problem, arcs: Arcs, fineness: Fineness) -> tuple[Arcs, Indices, Cells]:
    """Halve arcs until they are fine enough, or too narrow to be halved.

    Next to poles of shoulder and wrist joints turn fast, and arcs become narrower than elsewhere.

    Args:
        problem: What is searched.
        arcs: The arcs.
        fineness: How fine.

    Returns:
        The arcs, for each the index of the arc it came from, and their cells.

    Source:
        None (this package).
    """
    parent = np.arange(len(arcs))
    while True:
        cells = problem.cells(arcs)
        coarse = (np.linalg.norm(cells.spread, axis=1) > fineness.radius) | (
            np.linalg.norm(cells.tangent, axis=1) > fineness.length
        )
        cut = np.zeros(len(arcs), dtype=np.bool_)
        cut[cells.arc[coarse]] = True
        cut &= arcs.high - arcs.low > _NARROWEST
        if not cut.any():
            return arcs, parent, cells
        arcs, origin = arcs.halved(cut)
        parent = parent[origin]


def layers_of(
    problem: Problem, arcs: Arcs, cells: Cells, knots: Indices, away: Array
) -> tuple[list[Layer], Chain, float]:
    """The cells as layers of the chain that one linearisation makes.

    Args:
        problem: What is searched.
        arcs: The arcs.
        cells: Their cells.
        knots: Samples, shape (J,).
        away: v of the linearisation, shape (n, dof), in [rad].

    Returns:
        Layers, chain, and the loss of linearisation and sag.

    Source:
        None (this package).
    """
    seen = linearised(problem.objective, problem.gradient, away)
    chain = chain_at(problem.objective, seen.force, knots)
    ends = np.searchsorted(arcs.sample[cells.arc], np.append(knots, len(problem.q)))
    j = problem.joints
    e = cells.centre[:, j] - problem.q[arcs.sample[cells.arc]][:, j]
    t, spread = cells.tangent[:, j], cells.spread[:, j]
    layers = [
        layer_of(e[a:b], t[a:b], spread[a:b], cells.smooth[a:b], chain.weight[i], chain.force[i][j])
        for i, (a, b) in enumerate(itertools.pairwise(ends.tolist()))
    ]
    return layers, chain, seen.loss + chain.sag


def beside_chain(problem: Problem, knots: Indices, chain: Array) -> Array:
    """A smooth trajectory near a chain of postures.

    Args:
        problem: What is searched.
        knots: Samples, shape (J,).
        chain: Postures at the knots minus reference, shape (J, joints searched), in [rad].

    Returns:
        Trajectory minus reference, shape (n, dof), in [rad]; 0 if speed has no weight.

    Source:
        None (this package).
    """
    e = np.zeros_like(problem.q)
    if problem.objective.speed_weight:
        j = problem.joints
        e[:, j] = beside(problem.objective, problem.gradient[:, j], knots, chain)
    return e
