"""A way through the map brought to the optimum over its knots alone."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import TURN
from armik_sym.trajectory.global_path.between import reassigned
from armik_sym.trajectory.global_path.corridor import corridor
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.one_curve.go_down import go_down
from armik_sym.trajectory.one_curve.parameters import curve_parameters, wide_joints
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

Indices = NDArray[np.int64]

# Relative improvement below which a Newton step is the last.
_ENOUGH = 1e-6
# Rounds of trying other branches.
_REASSIGNMENTS = 3


@dataclass(frozen=True, eq=False)
class Outline:
    """A way through the map, smoothed at its knots.

    Attributes:
        way: The way, with swivel angles and postures after smoothing.
        value: The objective over the knots.
        beside_pole: Knots beside poles, where joints turn far while ψ hardly changes, shape (k,).
    """

    way: Way
    value: float
    beside_pole: Indices


def smoothed(problem: SwivelProblem, way: Way, smooth: Smoothness) -> Outline:
    """A way brought to the optimum over its knots, branches as they are.

    Args:
        problem: The problem.
        way: The way.
        smooth: The objective over its knots.

    Returns:
        The way with new swivel angles and postures, and what it costs.

    Source:
        Bertsekas (1982), doi:10.1137/0320018 (projected Newton).
    """
    q = way.q.copy()
    turning = np.flatnonzero(wide_joints(problem.intervals))
    q[:, turning] = np.unwrap(q[:, turning], axis=0)
    rows = curve_parameters(problem.intervals, way.sample, way.branch, q)
    band = corridor(problem.intervals, way.branch, way.psi, q, problem.backend, way.sample)
    lower, upper = band.lower, band.upper
    if problem.first is not None:
        lower[0] = upper[0] = way.psi[0]
    down = go_down(
        problem.library, rows, smooth, way.psi, lower, upper, q, problem.arm.rom, enough=_ENOUGH
    )
    psi, angles = down.charts.swivel_angles(down.x), down.objective.value(down.x)[1]
    beside_pole = np.flatnonzero(down.charts.chart)
    return Outline(replace(way, psi=psi, q=angles), down.value / smooth.scale, beside_pole)


def settled(problem: SwivelProblem, outline: Outline, smooth: Smoothness) -> Outline:
    """A smoothed way with its changes of branch at the knots where they cost least.

    Beside poles and where the branch changes, the other branch is tried if it comes nearer to what the
    neighbours ask for.

    Args:
        problem: The problem.
        outline: The smoothed way.
        smooth: The objective over its knots.

    Returns:
        The way, no more expensive than before.

    Source:
        None (this package).
    """
    for _ in range(_REASSIGNMENTS):
        way = outline.way
        other = reassigned(
            way.sample,
            way.q,
            way.branch,
            outline.beside_pole,
            problem.path.time,
            problem.intervals,
            problem.reference,
            problem.backend,
        )
        changed = np.flatnonzero(other.branch != way.branch)
        if not changed.size:
            break
        q, psi = way.q.copy(), way.psi.copy()
        q[changed] = other.q[changed]
        turn = other.psi[changed] - psi[changed]
        psi[changed] += turn - TURN * np.rint(turn / TURN)
        new = smoothed(problem, replace(way, branch=other.branch, psi=psi, q=q), smooth)
        if not new.value < outline.value:
            break
        outline = new
    return outline
