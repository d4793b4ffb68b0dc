"""A way through the map brought to the optimum over its knots alone."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.global_path.corridor import corridor
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.one_curve.go_down import go_down
from armik_sym.trajectory.one_curve.parameters import curve_parameters
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

# Relative improvement below which a Newton step is the last.
_ENOUGH = 1e-6


@dataclass(frozen=True, eq=False)
class Outline:
    """A way through the map, smoothed at its knots.

    Attributes:
        way: The way, with swivel angles and postures after smoothing.
        value: The objective over the knots.
    """

    way: Way
    value: float


def smoothed(
    problem: SwivelProblem, way: Way, smooth: Smoothness, held: NDArray[np.bool_] | None = None
) -> Outline:
    """A way brought to the optimum over its knots, branches as they are.

    Args:
        problem: The problem.
        way: The way.
        smooth: The objective over its knots.
        held: Knots that stay where they are, shape (m,); none if left out.

    Returns:
        The way with new swivel angles and postures, and what it costs.

    Source:
        Bertsekas (1982), doi:10.1137/0320018 (projected Newton).
    """
    q = way.q.copy()
    turning = np.flatnonzero(problem.limits.wide)
    q[:, turning] = np.unwrap(q[:, turning], axis=0)
    rows = curve_parameters(problem.intervals, way.sample, way.branch, q)
    band = corridor(problem.intervals, way.branch, way.psi, q, problem.backend, way.sample)
    fixed = np.zeros(len(q), dtype=np.bool_) if held is None else held.copy()
    fixed[0] |= problem.first is not None
    lower, upper = np.where(fixed, way.psi, band.lower), np.where(fixed, way.psi, band.upper)
    down = go_down(problem.library, rows, smooth, way.psi, lower, upper, q, problem.arm.rom, enough=_ENOUGH)
    psi, angles = down.charts.swivel_angles(down.x), down.objective.value(down.x)[1]
    return Outline(replace(way, psi=psi, q=angles), down.value / smooth.scale)
