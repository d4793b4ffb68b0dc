"""A path cut into cells, with limits that hold everywhere in each cell, not only at its ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]

_CELLS = 2000
_MOST_PARTS = 64
_PAIRS_AT_ONCE = 500


@dataclass(frozen=True, eq=False)
class Cells:
    """Limits of the speed along a path, x = ṡ², and of its change, u = s̈, cell by cell.

    With u constant in a cell, joint acceleration is q'' x + q' u along it: a parabola in s whose three
    Bernstein coefficients are linear in u and in x at the beginning of the cell. Limiting these limits the
    whole parabola.

    Attributes:
        s: Ends of the cells, shape (m + 1,).
        spread: Rows |r x + u| ≤ w of every cell: w, shape (m, rows); infinite where there is no row.
        slope: r, shape (m, rows).
        highest: Largest x at the ends of the cells, shape (m + 1,): speed, and what no u can mend.

    Source:
        Pham & Pham 2018, IEEE T-RO 34(3): 645-659 (stage constraints); Farouki 2012 (Bernstein bounds).
    """

    s: Array
    spread: Array
    slope: Array
    highest: Array


def make_cells(spline: CubicSpline, speed: Array, acceleration: Array) -> Cells:
    """Cut the path of a spline into cells.

    Args:
        spline: q(s), shape (dof,) at each s; cell ends include its knots.
        speed: Limits, shape (dof,), in [rad/s]; infinite for none.
        acceleration: Limits, shape (dof,), in [rad/s²]; infinite for none.

    Returns:
        The cells.

    Source:
        This package.
    """
    knots = np.asarray(spline.x)
    parts = min(max(math.ceil(_CELLS / (len(knots) - 1)), 1), _MOST_PARTS)
    inner = np.arange(parts) / parts
    s = np.append((knots[:-1, None] + np.diff(knots)[:, None] * inner).ravel(), knots[-1])
    h = np.diff(s)[:, None]
    first, second = spline(s, 1), spline(s, 2)
    bend = (second[1:] - second[:-1]) / (2 * h)
    a0, a1 = first[:-1], second[:-1]
    of_x = np.stack([a1, a1 + bend * h, a1 + 2 * bend * h], axis=1)
    of_u = np.stack([a0, a0 + 1.5 * a1 * h, a0 + 3 * a1 * h + 5 * bend * h**2], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.abs(of_u)
        spread = np.where(size > 0, acceleration / size, np.inf).reshape(len(h), -1)
        slope = np.where(size > 0, of_x / of_u, 0.0).reshape(len(h), -1)
        # Where u does nothing, the curvature alone limits x.
        still = np.where((size == 0) & (of_x != 0), acceleration / np.abs(of_x), np.inf)
    no_row = ~np.isfinite(spread) | ~np.isfinite(slope)
    spread, slope = np.where(no_row, np.inf, spread), np.where(no_row, 0.0, slope)
    in_cell = np.minimum(_speed_bound(a0, a1, bend, h, speed), still.reshape(len(h), -1).min(axis=1))
    in_cell = np.minimum(in_cell, _bound_of_pairs(spread, slope))
    ends = np.concatenate([in_cell, [np.inf]])
    ends[1:] = np.minimum(ends[1:], _speed_bound(a0, a1, bend, h, speed))
    return Cells(s, spread, slope, ends)


def steepest(a0: Array, a1: Array, bend: Array, h: Array) -> Array:
    """Largest |a0 + a1 σ + bend σ²| for 0 ≤ σ ≤ h.

    Args:
        a0: Any shape.
        a1: The same shape.
        bend: The same shape.
        h: Broadcastable to it.

    Returns:
        The same shape.

    Source:
        None (parabola).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        top = np.clip(np.nan_to_num(-a1 / (2 * bend), nan=0.0), 0.0, h)
    values = [a0, a0 + a1 * h + bend * h**2, a0 + a1 * top + bend * top**2]
    return np.asarray(np.max(np.abs(values), axis=0))


def _speed_bound(a0: Array, a1: Array, bend: Array, h: Array, speed: Array) -> Array:
    """Largest x that keeps all speeds in a cell: min (v/|q'|)², shape (m,)."""
    with np.errstate(divide="ignore"):
        return np.asarray(((speed / steepest(a0, a1, bend, h)) ** 2).min(axis=1))


def _bound_of_pairs(spread: Array, slope: Array) -> Array:
    """Largest x at which some u meets all rows: -w_l - r_l x ≤ w_k - r_k x for all pairs, shape (m,)."""
    out = np.empty(len(spread))
    for i in range(0, len(spread), _PAIRS_AT_ONCE):
        w, r = spread[i : i + _PAIRS_AT_ONCE], slope[i : i + _PAIRS_AT_ONCE]
        apart = r[:, :, None] - r[:, None, :]
        both = w[:, :, None] + w[:, None, :]
        with np.errstate(divide="ignore", invalid="ignore"):
            bound = np.where(apart > 0, both / apart, np.inf)
        out[i : i + _PAIRS_AT_ONCE] = np.min(bound, axis=(1, 2), initial=np.inf)
    return out
