"""The whole trajectory over the swivel angle: from a way through the map to the optimum of its corridor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armik_sym.trajectory.global_path.between import reassigned
from armik_sym.trajectory.global_path.corridor import corridor
from armik_sym.trajectory.global_path.outlines import outlines
from armik_sym.trajectory.global_path.smoothed import Outline
from armik_sym.trajectory.global_path.way_corridor import corridor_of, joint_guess
from armik_sym.trajectory.ipopt import IterationCallback
from armik_sym.trajectory.one_curve.go_down import Down, go_down
from armik_sym.trajectory.one_curve.parameters import curve_parameters
from armik_sym.trajectory.one_curve.polish import Polished, polish
from armik_sym.trajectory.one_curve.smoothness import Smoothness, smoothness
from armik_sym.trajectory.rates import sample_durations
from armik_sym.trajectory.swivel_problem import SwivelProblem
from armik_sym.trajectory.whole_turns import in_best_turn

__all__ = ["Outline", "Settled", "SwivelProblem", "joint_guess", "outlines", "polished", "settled"]

_REASSIGNMENTS = 5


@dataclass(frozen=True, eq=False)
class Settled:
    """The optimum in the corridor of a way, before IPOPT has looked at it.

    Attributes:
        down: The end of the way down.
        smooth: The objective.
        value: Its value, not scaled.
    """

    down: Down
    smooth: Smoothness
    value: float

    @property
    def beside_pole(self) -> bool:
        """Whether the corridor passes beside a pole of shoulder or wrist."""
        return bool(self.down.charts.chart.any())


def settled(problem: SwivelProblem, outline: Outline) -> Settled:
    """The optimum in the corridor of a way, without limits on rates.

    Args:
        problem: The problem.
        outline: The way.

    Returns:
        The optimum.

    Source:
        None (this package).
    """
    way, time = outline.way, problem.path.time
    band = corridor_of(problem, way)
    lower, upper = band.lower.copy(), band.upper.copy()
    if problem.first is not None:
        lower[0] = upper[0] = way.psi[0]
    everywhere = np.arange(len(time))
    smooth = smoothness(time, problem.weights, problem.aim, problem.posture_cost)
    line, branch, psi = joint_guess(problem, way), band.branch, band.psi
    if problem.first is None:
        line = in_best_turn(line, problem.limits.wide, problem.arm.rom, problem.aim, sample_durations(time))
    for _ in range(_REASSIGNMENTS):
        rows = curve_parameters(problem.intervals, everywhere, branch, line)
        down = go_down(problem.library, rows, smooth, psi, lower, upper, line, problem.arm.rom)
        q = down.objective.value(down.x)[1]
        beside_pole = np.flatnonzero(down.charts.chart)
        other = reassigned(
            everywhere, q, branch, beside_pole, time, problem.intervals, problem.reference, problem.backend
        )
        changed = np.flatnonzero(other.branch != branch)
        if not changed.size:
            break
        line, branch, psi = q.copy(), other.branch, down.charts.swivel_angles(down.x)
        line[changed], psi[changed] = other.q[changed], other.psi[changed]
        band = corridor(problem.intervals, branch, psi, line, problem.backend)
        lower[changed], upper[changed] = band.lower[changed], band.upper[changed]
    return Settled(down, smooth, down.value / smooth.scale)


def polished(problem: SwivelProblem, found: Settled, report: IterationCallback | None = None) -> Polished:
    """The same with IPOPT, all limits kept.

    Args:
        problem: The problem.
        found: The optimum without limits on rates.
        report: Told about every IPOPT iteration.

    Returns:
        The trajectory.

    Raises:
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        None (this package).
    """
    return polish(
        found.down,
        found.smooth,
        problem.path.time,
        problem.limits,
        max_iterations=problem.max_iterations,
        output=problem.output,
        report=report,
    )
