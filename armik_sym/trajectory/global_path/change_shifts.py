"""Changes of branch, each moved to the knot where it costs least."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import TURN
from armik_sym.trajectory.global_path.between import nearest_on_branch
from armik_sym.trajectory.global_path.corridor import corridor
from armik_sym.trajectory.global_path.row_costs import part_of, row_costs
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.global_path.smoothed import Outline, smoothed
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]

# Knots before and after a change that may give way when it is moved.
_AROUND = 20
# Knots at both ends of that stretch that stay: accelerations reach over two.
_HELD = 2
# How many knots a change may move in one direction.
_FARTHEST = 6
# A posture farther than this from the line between its neighbours is not worth a trial, in [rad].
_FAR = 1.0
# Knots nearer to the end of their interval than this are held by it, in [rad] …
_AT_END = 1e-9
# … and try the next interval if it is nearer than this, in [rad].
_GAP = 0.1
# Relative improvement that counts.
_GAIN = 1e-6


def with_shifted_changes(problem: SwivelProblem, outline: Outline, smooth: Smoothness) -> Outline:
    """A smoothed way whose changes of branch or interval are moved knot by knot while that helps.

    On the wrong side of a change a knot is held at the end of its interval, and the rest with it; Newton
    steps do not lead across. Only a stretch around the change is smoothed for a trial.

    Args:
        problem: The problem.
        outline: The smoothed way.
        smooth: The objective over its knots.

    Returns:
        The way, no more expensive than before.

    Source:
        None (this package).
    """
    way, enough = outline.way, _GAIN * outline.value
    for change in np.flatnonzero(np.diff(way.branch)):
        for direction in (1, -1):
            last = change + 1 if direction > 0 else change
            for row in range(last, last + direction * _FARTHEST, direction):
                moved = _like_neighbour(problem, way, row, row - direction, smooth, enough)
                if moved is None:
                    break
                way = moved
            if way.branch[last] == way.branch[last - direction]:
                break  # it has moved this way: the other way lies where it came from
    for row, psi in _next_intervals(problem, way):
        moved = _trial(problem, way, row, int(way.branch[row]), psi, way.q[row], smooth, enough)
        way = way if moved is None else moved
    if way is outline.way:
        return outline
    new = smoothed(problem, way, smooth)
    return new if new.value < outline.value else outline


def _next_intervals(problem: SwivelProblem, way: Way) -> list[tuple[int, float]]:
    """Knots at the end of an interval with another one beside it, and where that begins."""
    intervals = problem.intervals
    band = corridor(intervals, way.branch, way.psi, way.q, problem.backend, way.sample)
    found = []
    for row in np.flatnonzero(np.minimum(way.psi - band.lower, band.upper - way.psi) < _AT_END):
        here = slice(*np.searchsorted(intervals.sample, [way.sample[row], way.sample[row] + 1]))
        own = intervals.branch[here] == way.branch[row]
        ends = np.concatenate([intervals.start[here][own], intervals.end[here][own]])
        away = ends - way.psi[row]
        away -= TURN * np.rint(away / TURN)
        beside = away[(np.abs(away) < _GAP) & (np.abs(away) > 2 * _AT_END)]
        outside = beside[
            (way.psi[row] + beside < band.lower[row]) | (way.psi[row] + beside > band.upper[row])
        ]
        if outside.size:
            found.append((int(row), float(way.psi[row] + outside[np.abs(outside).argmin()])))
    return found


def _like_neighbour(
    problem: SwivelProblem, way: Way, row: int, like: int, smooth: Smoothness, enough: float
) -> Way | None:
    """The way with one row on the branch of its neighbour, or None if that is not better by enough."""
    if not 0 < row < len(way.sample) - 1 or way.branch[row] == way.branch[like]:
        return None
    beyond = 2 * row - like
    other_elbow = (way.branch[row] >= 4) != (way.branch[like] >= 4)
    if other_elbow and abs(way.sample[beyond] - way.sample[row]) > 1:
        return None  # the elbow would change its side without any acceleration to show for it
    time = problem.path.time[way.sample[row - 1 : row + 2]]
    share = (time[1] - time[0]) / (time[2] - time[0])
    line = (1 - share) * way.q[row - 1] + share * way.q[row + 1]
    branch = int(way.branch[like])
    psi, away = nearest_on_branch(
        int(way.sample[row]), branch, line, problem.intervals, problem.reference, problem.backend
    )
    if away > _FAR:
        return None
    turn = psi - way.psi[row]
    return _trial(problem, way, row, branch, psi - TURN * np.rint(turn / TURN), line, smooth, enough)


def _trial(
    problem: SwivelProblem,
    way: Way,
    row: int,
    branch: int,
    psi: float,
    q: Array,
    smooth: Smoothness,
    enough: float,
) -> Way | None:
    """The way with one row elsewhere and the stretch around it smoothed, or None if that is not better."""
    m = len(way.sample)
    part = slice(max(0, row - _AROUND), min(m, row + _AROUND + 1))
    moved = replace(way, branch=way.branch.copy(), psi=way.psi.copy(), q=way.q.copy())
    moved.branch[row], moved.psi[row], moved.q[row] = branch, psi, q
    stretch = Way(way.sample[part], moved.branch[part], moved.psi[part], moved.q[part], way.cost)
    held = np.zeros(part.stop - part.start, dtype=np.bool_)
    held[: _HELD if part.start > 0 else 0] = True
    held[len(held) - (_HELD if part.stop < m else 0) :] = True
    local = part_of(smooth, part)
    new = smoothed(problem, stretch, local, held)
    if not new.value < float(row_costs(way.q[part], local).sum()) - enough:
        return None
    moved.psi[part], moved.q[part] = new.way.psi, new.way.q
    return moved
