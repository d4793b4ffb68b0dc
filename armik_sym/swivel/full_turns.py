"""Cutting feasible intervals where a joint with a range of one full turn passes from one limit to the other.

Such a joint is inside its range at every swivel angle, but at its limit it would have to jump by a turn.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.limit_cuts import joint_coefficients, wrapped, zeros
from armik_sym.swivel.postures_at import postures_at

Array = NDArray[np.float64]

# How far the ends stay away from the cut, in [rad].
_INSET = 1e-9
# Sine of the middle angle below which the outer joints have no angle of their own.
_POLE = 1e-10


def split_at_full_turns(intervals: FeasibleIntervals, backend: Backend = "auto") -> FeasibleIntervals:
    """Feasible intervals on which no joint jumps.

    Args:
        intervals: The feasible intervals.
        backend: "auto", "c" or "vm".

    Returns:
        The same intervals, or their parts.

    Source:
        None (this package).
    """
    curves = intervals.curves
    rom = curves[0].spherical.arm.rom
    joints = [
        (i, triple, k)
        for i, triple in enumerate(curves[0].triples)
        for k in range(3)
        if abs(rom.width[triple.first + k] - TURN) < _INSET
    ]
    if not joints or not len(intervals.sample):
        return intervals
    side = (intervals.branches[intervals.branch, 0] < 0).astype(np.int64)
    rows, cuts = [], []
    for i, triple, k in joints:
        limit = np.full(len(curves[0].elbow), rom.lower[triple.first + k])
        both = np.array([zeros(joint_coefficients(curve.parts[:, i], triple, k, limit)) for curve in curves])
        psi = both[side, intervals.sample]
        psi = psi + TURN * np.ceil((intervals.start[:, None] - psi) / TURN)
        inside = psi < intervals.end[:, None]
        row, which = np.nonzero(inside)
        at = psi[row, which]
        there = postures_at(curves, intervals.sample[row], intervals.branch[row], at, backend=backend)
        j = triple.first + k
        # The roots are also those of the angle half a turn away, where nothing jumps.
        jumps = np.abs(wrapped(np.mod(there.q[:, j] - rom.lower[j], TURN))) < 0.25 * TURN
        if k != 1:
            jumps &= (there.wrist_sine if i else there.shoulder_sine) > _POLE
        rows.append(row[jumps])
        cuts.append(at[jumps])
    row, cut = np.concatenate(rows), np.concatenate(cuts)
    if not len(row):
        return intervals
    return _cut(intervals, row, cut)


def _cut(intervals: FeasibleIntervals, row: NDArray[np.int64], cut: Array) -> FeasibleIntervals:
    whole = intervals.end - intervals.start >= TURN - _INSET
    cut_rows = np.zeros(len(whole), dtype=np.bool_)
    cut_rows[row] = True
    kept = np.flatnonzero(~(whole & cut_rows))  # a whole circle begins at its first cut
    of = np.concatenate([kept, row])
    start = np.concatenate([intervals.start[kept], cut])
    order = np.lexsort((start, of))
    of, start = of[order], start[order]
    last = np.append(of[1:] != of[:-1], True)
    turned = (whole & cut_rows)[of]
    final = np.where(turned, start[np.searchsorted(of, of)] + TURN, intervals.end[of])
    end = np.where(last, final, np.append(start[1:], 0.0))
    inset = np.minimum(_INSET, 0.25 * (end - start))
    at_cut = np.concatenate([np.zeros(len(kept), dtype=np.bool_), np.ones(len(cut), dtype=np.bool_)])[order]
    return replace(
        intervals,
        sample=intervals.sample[of],
        branch=intervals.branch[of],
        start=start + np.where(at_cut, inset, 0.0),
        end=end - np.where(~last | turned, inset, 0.0),
    )
