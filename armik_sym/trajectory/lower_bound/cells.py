"""Cells: arcs of the feasible curves, each inside a segment of joint space and a box around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.closed_form import SwivelCurve
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.lower_bound.arcs import ANYWHERE, Arcs
from armik_sym.trajectory.lower_bound.triple_rates import triple_rates
from armik_sym.trajectory.repeated import repeated

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

# Widening of everything against rounding, in [rad].
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Cells:
    """Every posture of an arc is q = centre + tangent·x + ρ with -1 ≤ x ≤ 1 and |ρ_i| ≤ spread_i.

    Where `smooth`, |ρ_i| ≤ spread_i·x² up to rounding.

    Attributes:
        arc: Which arc, shape (m,), in increasing order; an arc has several cells where whole turns of a
            joint give several postures inside the range of motion.
        centre: Shape (m, dof), in [rad].
        tangent: Shape (m, dof), in [rad].
        spread: Shape (m, dof), in [rad].
        smooth: Shape (m,).
    """

    arc: Indices
    centre: Array
    tangent: Array
    spread: Array
    smooth: Mask

    def of_arcs(self, kept: Mask) -> Cells:
        """The cells of some arcs, which are numbered anew.

        Args:
            kept: Which arcs, shape (number of arcs,).

        Returns:
            Those cells.

        Source:
            None (bookkeeping).
        """
        k = kept[self.arc]
        number = np.cumsum(kept) - 1
        return Cells(number[self.arc[k]], self.centre[k], self.tangent[k], self.spread[k], self.smooth[k])


def cells_of(intervals: FeasibleIntervals, arcs: Arcs, box: tuple[Array, Array]) -> Cells:
    """Enclose arcs.

    With δ the half width, r and c the bounds of |dq_i/dψ| and |d²q_i/dψ²| over the arc, a joint is within
    ½cδ² of its tangent (Taylor), within rδ of its centre, and within its limits; the tightest is taken.
    Angles 2π apart make cells of their own if they touch the limits.

    Args:
        intervals: The feasible intervals.
        arcs: The arcs.
        box: Lower and upper limits sample by sample, shape (n, dof) each, in [rad].

    Returns:
        The cells.

    Source:
        Taylor's theorem.
    """
    lower, upper = box[0][arcs.sample], box[1][arcs.sample]
    half_range = 0.5 * (upper - lower)
    cells = _Sheets(
        0.5 * (lower + upper), np.zeros_like(lower), half_range.copy(), np.zeros(lower.shape, np.bool_)
    )
    signs = intervals.branches[np.maximum(arcs.branch, 0)]
    for side, curve in zip((1, -1), intervals.curves, strict=True):
        rows = np.flatnonzero((signs[:, 0] == side) & (arcs.branch != ANYWHERE))
        if rows.size:
            _enclose(cells, curve.rows(arcs.sample[rows]), rows, arcs, signs[rows], half_range[rows])
    return _with_whole_turns(cells, lower, upper)


@dataclass(frozen=True, eq=False)
class _Sheets:
    """Before whole turns; `bounded` says whether more than its limits encloses a joint."""

    centre: Array
    tangent: Array
    spread: Array
    bounded: Mask


def _enclose(
    cells: _Sheets, curve: SwivelCurve, rows: Indices, arcs: Arcs, signs: Indices, half_range: Array
) -> None:
    middle = 0.5 * (arcs.low + arcs.high)[rows]
    half = 0.5 * (arcs.high - arcs.low)[rows] + _ROUNDING
    cells.centre[rows, 3], cells.spread[rows, 3], cells.bounded[rows, 3] = curve.elbow, 0.0, True
    for i, triple in enumerate(curve.triples):
        j = slice(triple.first, triple.first + 3)
        rates = triple_rates(curve.parts[:, i], signs[:, 1 + i].astype(np.float64), middle, half)
        rates.angles[:, 1] -= triple.offset
        bent = 0.5 * rates.largest_curvature * half[:, None] ** 2
        flat = np.minimum(rates.largest_rate * half[:, None], np.pi)
        straight = (bent <= flat) & (bent < 1.0)
        bounded = straight | (flat < half_range[:, j])
        cells.centre[rows, j] = np.where(bounded, rates.angles, cells.centre[rows, j])
        cells.tangent[rows, j] = np.where(straight, rates.rate * half[:, None], 0.0)
        enclosed = np.where(straight, bent, flat)
        cells.spread[rows, j] = np.where(bounded, enclosed, cells.spread[rows, j])
        cells.bounded[rows, j] = bounded


def _with_whole_turns(cells: _Sheets, lower: Array, upper: Array) -> Cells:
    """Each cell once for every combination of whole turns that touches the limits."""
    q, arc = cells.centre, np.arange(len(cells.centre))
    reach = np.abs(cells.tangent) + cells.spread + _ROUNDING
    for j in range(q.shape[1]):
        first = np.ceil((lower[arc, j] - reach[arc, j] - q[:, j]) / TURN).astype(np.int64)
        last = np.floor((upper[arc, j] + reach[arc, j] - q[:, j]) / TURN).astype(np.int64)
        free = ~cells.bounded[arc, j]
        first, last = np.where(free, 0, first), np.where(free, 0, last)
        count = np.maximum(last - first + 1, 0)
        row, number = repeated(count)
        q, arc = q[row].copy(), arc[row]
        q[:, j] += TURN * (first[row] + number)
    tangent, spread = cells.tangent[arc], cells.spread[arc] + _ROUNDING
    return Cells(arc, q, tangent, spread, _is_smooth(cells)[arc])


def _is_smooth(cells: _Sheets) -> Mask:
    """Whether every joint that moves does so along its tangent."""
    return np.asarray((cells.bounded & ((cells.tangent != 0) | (cells.spread <= _ROUNDING))).all(axis=1))
