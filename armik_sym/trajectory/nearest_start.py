"""The posture at the first sample that is nearest to a known one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.compiled.backend import Backend
from armik_sym.swivel.equivalent_angles import nearest_in_range
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.global_path.nodes import spread_nodes
from armik_sym.trajectory.library import trajectory_library
from armik_sym.trajectory.one_curve.go_down import go_down
from armik_sym.trajectory.one_curve.objective import CurveObjective
from armik_sym.trajectory.one_curve.parameters import curve_parameters
from armik_sym.trajectory.one_curve.smoothness import Smoothness

Array = NDArray[np.float64]

_SPACING = 0.05
_TRIED = 4
_HALVINGS = 50


def nearest_on_curve(intervals: FeasibleIntervals, start: Array, backend: Backend = "auto") -> Array:
    """Of all postures that bring the hand to sample 0, the one nearest to a known posture.

    min |q - start| over all branches and feasible swivel angles: nodes first, then Newton steps.

    Args:
        intervals: The feasible intervals; sample 0 has some.
        start: The known posture, shape (dof,), in [rad].
        backend: "auto", "c" or "vm".

    Returns:
        The posture, shape (dof,), in [rad].

    Source:
        None (this package).
    """
    nodes = spread_nodes(intervals, np.zeros(1, dtype=np.int64), _SPACING, backend)
    rom = intervals.curves[0].spherical.arm.rom
    # Where the range of motion is more than a turn, the turn the known posture is in.
    postures = nearest_in_range(nodes.q, rom.lower, rom.upper, start)
    away = np.square(postures - start).sum(axis=1)
    best, least = postures[int(away.argmin())], float(away.min())
    library = trajectory_library(backend)
    aim = Smoothness(np.zeros(0), np.zeros((0, 3)), np.ones(1), start[None])
    for k in np.argsort(away, kind="stable")[:_TRIED]:
        of_branch = np.flatnonzero((intervals.sample == 0) & (intervals.branch == nodes.branch[k]))
        start_, end = intervals.start[of_branch], intervals.end[of_branch]
        i = int(np.argmin(np.maximum(start_ - nodes.psi[k], nodes.psi[k] - end)))
        rows = curve_parameters(intervals, nodes.sample[[k]], nodes.branch[[k]], postures[[k]])
        bounds = start_[[i]], end[[i]]
        down = go_down(library, rows, aim, nodes.psi[[k]], *bounds, postures[[k]], rom)
        q = down.objective.value(down.x)[1][0]
        if rom.margin(q[None]).min() < 0:
            # Intervals do not end at the limits of joints that can turn all the way round.
            plain = CurveObjective(library, rows, aim)
            q = _last_inside(plain, rom, nodes.psi[[k]], down.charts.swivel_angles(down.x))
        gap = float(np.square(q - start).sum())
        if gap < least and rom.margin(q[None]).min() >= 0:
            best, least = q, gap
    return np.asarray(rom.clip(best))


def _last_inside(objective: CurveObjective, rom: RangeOfMotion, inside: Array, outside: Array) -> Array:
    """The last posture inside the range of motion between two swivel angles, by bisection."""
    for _ in range(_HALVINGS):
        between = 0.5 * (inside + outside)
        if rom.margin(objective.value(between)[1]).min() >= 0:
            inside = between
        else:
            outside = between
    return np.asarray(objective.value(inside)[1][0])
