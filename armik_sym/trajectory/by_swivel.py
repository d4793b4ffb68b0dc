"""The whole trajectory over the swivel angle: global search first, then the optimum of the corridors found."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.compiled.build import Library
from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.equivalent_angles import nearest_in_range
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.global_path.between import reassigned, with_samples
from armik_sym.trajectory.global_path.corridor import Corridor, corridor, interpolated
from armik_sym.trajectory.global_path.elbow_change import elbow_change_costs
from armik_sym.trajectory.global_path.knots import knots
from armik_sym.trajectory.global_path.nodes import Nodes, spread_nodes
from armik_sym.trajectory.global_path.search import Way, WaySearch
from armik_sym.trajectory.global_path.shortest_path import Edges
from armik_sym.trajectory.ipopt import IterationCallback
from armik_sym.trajectory.one_curve.go_down import go_down
from armik_sym.trajectory.one_curve.parameters import curve_parameters, wide_joints
from armik_sym.trajectory.one_curve.polish import Limits, Polished, polish
from armik_sym.trajectory.one_curve.smoothness import smoothness
from armik_sym.trajectory.rates import sample_durations

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_log = logging.getLogger(__name__)

_SPACING = 0.08
# What the distance between nodes may add to a step, in [rad].
_SLACK = 0.4
_CANDIDATES = 6
_ATTEMPTS = 16
_ALIKE = 0.02
_WITHIN = 0.5
_NEARLY_AS_GOOD = 0.1
_ROUNDS = 4
_REASSIGNMENTS = 5
_MISSED = 0.02
_FAR = 0.3
# A motion whose angular frequency is this makes the share of accelerations in the search's edges, in [1/s²].
_TYPICAL_FREQUENCY_SQUARED = 10.0


@dataclass(frozen=True, eq=False)
class SwivelProblem:
    """What is to be solved.

    Attributes:
        arm: The arm.
        path: The hand path.
        intervals: Feasible swivel angles of every sample.
        reference: Reference directions they are counted from, shape (n, 3).
        weights: Of squared speed, squared acceleration [s²], squared distance from `aim` [1/s²].
        aim: Where the posture is drawn to, shape (dof,), in [rad].
        limits: Speed, acceleration, range of motion.
        first: The posture at sample 0 if it is known, shape (dof,), in [rad].
        library: The compiled loops; None for NumPy.
        backend: "auto", "c" or "vm".
        max_iterations: IPOPT iterations per run.
        output: Let IPOPT print.
    """

    arm: Arm
    path: HandPath
    intervals: FeasibleIntervals
    reference: Array
    weights: tuple[float, float, float]
    aim: Array
    limits: Limits
    first: Array | None
    library: Library | None
    backend: Backend
    max_iterations: int = 300
    output: bool = False


@dataclass(frozen=True, eq=False)
class Outline:
    """A way through the map, smoothed at its knots.

    Attributes:
        way: The way, with swivel angles and postures after smoothing.
        value: The objective over the knots.
    """

    way: Way
    value: float


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
    chosen = knots(problem.path, _reach(problem.arm))
    for _ in range(_ROUNDS):
        nodes = _nodes(problem, chosen)
        search = WaySearch(nodes, _node_costs(problem, nodes, chosen), _edges(problem, chosen), problem.library)
        found, lost = _distinct(problem, search, most, within)
        denser = np.union1d(chosen, np.clip(lost[:, None] + np.arange(-1, 2), 0, len(problem.path) - 1))
        if not lost.size or len(denser) == len(chosen):
            break
        chosen = denser
    return sorted(found, key=lambda each: each.value)


def _distinct(
    problem: SwivelProblem, search: WaySearch, most: int, within: float
) -> tuple[list[Outline], Indices]:
    """Outlines of ways that stay different when they are smoothed, and samples the cheapest cannot pass."""
    found: list[Outline] = []
    known: list[Way] = []
    lost = np.zeros(0, dtype=np.int64)
    way = search.cheapest()
    limit = np.inf if way is None else (1 + within) * way.cost
    for number in range(_ATTEMPTS):
        if way is None or len(found) >= most:
            break
        smooth = _smoothed(problem, way)
        if not any(_same(smooth.way, other) for other in known):
            known.append(smooth.way)
            outline, gaps = _drawn_through(problem, smooth)
            if not gaps.size:
                found.append(outline)
            elif number == 0:
                lost = gaps
        if most == 1:
            break
        way = search.another([way, smooth.way], limit)
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


def polished(problem: SwivelProblem, outline: Outline, report: IterationCallback | None = None) -> Polished:
    """The optimum in the corridor of a way.

    Args:
        problem: The problem.
        outline: The way.
        report: Told about every IPOPT iteration.

    Returns:
        The trajectory.

    Raises:
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        None (this package).
    """
    way, time = outline.way, problem.path.time
    band = corridor_of(problem, way)
    lower, upper = band.lower.copy(), band.upper.copy()
    if problem.first is not None:
        lower[0] = upper[0] = way.psi[0]
    everywhere = np.arange(len(time))
    smooth = smoothness(time, problem.weights, problem.aim)
    line, branch, psi = joint_guess(problem, way), band.branch, band.psi
    for _ in range(_REASSIGNMENTS):
        rows = curve_parameters(problem.intervals, everywhere, branch, line)
        down = go_down(problem.library, rows, smooth, psi, lower, upper, line, problem.arm.rom)
        q = down.objective.value(down.x)[1]
        beside_pole = np.flatnonzero(down.charts.chart)
        other = reassigned(q, branch, beside_pole, time, problem.intervals, problem.reference, problem.backend)
        changed = np.flatnonzero(other.branch != branch)
        if not changed.size:
            break
        line, branch, psi = q.copy(), other.branch, down.charts.swivel_angles(down.x)
        line[changed], psi[changed] = other.q[changed], other.psi[changed]
        band = corridor(problem.intervals, branch, psi, line, problem.backend)
        lower[changed], upper[changed] = band.lower[changed], band.upper[changed]
    return polish(
        down,
        smooth,
        time,
        problem.limits,
        max_iterations=problem.max_iterations,
        output=problem.output,
        report=report,
    )


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
    time = problem.path.time
    columns = [np.interp(time, time[way.sample], column) for column in way.q.T]
    return np.array(columns).T


def _nodes(problem: SwivelProblem, chosen: Indices) -> Nodes:
    nodes = spread_nodes(problem.intervals, chosen, _SPACING, problem.backend)
    if problem.first is None:
        return nodes
    spherical = problem.intervals.curves[0].spherical
    known = swivel_of_postures(spherical, problem.first[None], problem.reference[:1])
    signs = np.array([known.elbow[0], known.shoulder[0], known.wrist[0]])
    branch = int(np.flatnonzero((problem.intervals.branches == signs).all(axis=1))[0])
    return nodes.with_first(branch, int(known.elbow[0] < 0), float(known.psi[0]), problem.first)


def _node_costs(problem: SwivelProblem, nodes: Nodes, chosen: Indices) -> Array:
    shares = sample_durations(problem.path.time[chosen])[nodes.layer]
    return np.asarray(0.5 * problem.weights[2] * shares * np.square(nodes.q - problem.aim).sum(axis=1))


def _edges(problem: SwivelProblem, chosen: Indices) -> Edges:
    steps = np.diff(problem.path.time[chosen])
    weight = problem.weights[0] + _TYPICAL_FREQUENCY_SQUARED * problem.weights[1]
    rom = problem.arm.rom
    return Edges(
        weight=max(weight, 1e-6) / steps,
        most=np.outer(steps, problem.limits.max_speed) + _SLACK,
        turns=np.asarray(rom.width > 2 * np.pi + 1e-6),
        change=elbow_change_costs(_elbow_angles(problem), problem.path.time, chosen, problem.weights[1]),
    )


def _elbow_angles(problem: SwivelProblem) -> Array:
    """Angle of the elbow on both sides, shape (2, n)."""
    rom = problem.arm.rom
    return np.array(
        [
            nearest_in_range(c.elbow[:, None], rom.lower[3:4], rom.upper[3:4], rom.middle[None, 3:4])[:, 0]
            for c in problem.intervals.curves
        ]
    )


def _smoothed(problem: SwivelProblem, way: Way) -> Outline:
    """A way brought to the optimum over its knots alone, branches as they are."""
    q = way.q.copy()
    turning = np.flatnonzero(wide_joints(problem.intervals))
    q[:, turning] = np.unwrap(q[:, turning], axis=0)
    rows = curve_parameters(problem.intervals, way.sample, way.branch, q)
    time = problem.path.time[way.sample]
    smooth = smoothness(time, problem.weights, problem.aim)
    band = corridor_of(problem, way)
    lower, upper = band.lower[way.sample], band.upper[way.sample]
    if problem.first is not None:
        lower[0] = upper[0] = way.psi[0]
    down = go_down(problem.library, rows, smooth, way.psi, lower, upper, q, problem.arm.rom, enough=1e-6)
    psi, angles = down.charts.swivel_angles(down.x), down.objective.value(down.x)[1]
    return Outline(Way(way.sample, way.branch, psi, angles, way.cost), down.value / smooth.scale)


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
    return corridor(
        problem.intervals, way.branch[nearest], psi, joint_guess(problem, way), problem.backend
    )


def _unsettled(problem: SwivelProblem, way: Way) -> Indices:
    """Samples that need a knot: a way leaves the intervals there, or changes the branch around them."""
    outside = np.flatnonzero(corridor_of(problem, way).missed > _MISSED)
    changes = np.flatnonzero(np.diff(way.branch))
    between = [np.arange(way.sample[i] + 1, way.sample[i + 1]) for i in changes]
    return np.concatenate([outside, *between]).astype(np.int64)


def _reach(arm: Arm) -> float:
    return float(sum(arm.lengths.values())) or 1.0
