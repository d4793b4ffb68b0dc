"""Swivel angles beside a pole of shoulder or wrist, where joints turn far while ψ hardly changes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.axis_triple import AxisTriple
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.limit_cuts import joint_coefficients, zeros
from armik_sym.trajectory.repeated import repeated

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Sine of the angle between first and third axis below which a curve passes beside the pole …
_BESIDE = 0.15
# … and below which it passes right through.
_THROUGH = 1e-7
_DIRECTIONS = 24


def pole_nodes(intervals: FeasibleIntervals, rows: Indices) -> tuple[Indices, Array]:
    """Swivel angles at which the first angle has evenly spread values, for curves that pass beside a pole.

    Args:
        intervals: The feasible intervals.
        rows: Intervals to look at, shape (m,).

    Returns:
        Index into `rows` and swivel angle inside that interval, shape (k,) each, in [rad].

    Source:
        None (this package).
    """
    side = (intervals.branches[intervals.branch[rows], 0] < 0).astype(np.int64)
    found_row, found_psi = [np.zeros(0, dtype=np.int64)], [np.zeros(0)]
    for s, curve in enumerate(intervals.curves):
        here = np.flatnonzero(side == s)
        samples, inverse = np.unique(intervals.sample[rows[here]], return_inverse=True)
        for i, triple in enumerate(curve.triples):
            C = curve.parts[samples, i]
            extreme = np.arctan2(C[:, 2, 8], C[:, 1, 8])
            for half in (0.0, np.pi):
                which, psi = _around(C, triple, extreme + half)
                if not which.size:
                    continue
                row, angle = _inside(intervals, rows[here], inverse, which, psi)
                found_row.append(here[row])
                found_psi.append(angle)
    return np.concatenate(found_row), np.concatenate(found_psi)


def _around(C: Array, triple: AxisTriple, pole: Array) -> tuple[Indices, Array]:
    """Swivel angles beside poles that are near, and whose they are."""
    turn = np.column_stack([np.ones(len(pole)), np.cos(pole), np.sin(pole)])
    distance = np.hypot((C[:, :, 2] * turn).sum(axis=1), (C[:, :, 5] * turn).sum(axis=1))
    through = np.flatnonzero(distance < _THROUGH)
    beside = np.flatnonzero((distance >= _THROUGH) & (distance < _BESIDE))
    if not beside.size:
        return through, pole[through]
    alpha = np.arange(_DIRECTIONS) * (np.pi / _DIRECTIONS)
    which = np.repeat(beside, _DIRECTIONS)
    roots = zeros(joint_coefficients(C[which], triple, 0, np.tile(alpha, len(beside))))
    away = roots - pole[which, None]
    away -= TURN * np.rint(away / TURN)
    nearest = np.nanargmin(np.where(np.isnan(away), np.inf, np.abs(away)), axis=1) if len(which) else which
    psi = pole[which] + away[np.arange(len(which)), nearest]
    good = ~np.isnan(psi)
    return np.concatenate([through, which[good]]), np.concatenate([pole[through], psi[good]])


def _inside(
    intervals: FeasibleIntervals, rows: Indices, sample_of_row: Indices, which: Indices, psi: Array
) -> tuple[Indices, Array]:
    """All pairs of an interval and a swivel angle of its sample that lies inside."""
    order = np.argsort(which, kind="stable")
    which, psi = which[order], psi[order]
    first = np.searchsorted(which, sample_of_row)
    count = np.searchsorted(which, sample_of_row, side="right") - first
    row, number = repeated(count)
    place = first[row] + number
    start, end = intervals.start[rows[row]], intervals.end[rows[row]]
    angle = psi[place] + TURN * np.ceil((start - psi[place]) / TURN)
    inside = angle <= end
    return row[inside], angle[inside]
