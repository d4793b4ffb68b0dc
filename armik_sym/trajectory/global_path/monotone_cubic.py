"""Interpolation by cubics that never overshoot.

SciPy has the same (`PchipInterpolator`); loading it takes longer than a whole solve, and one call as long as
the search's other bookkeeping.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def monotone_cubic(x: Array, y: Array, at: Array) -> Array:
    """Values between known ones, monotone wherever these are.

    Cubic Hermite pieces. Inner slopes are weighted harmonic means of the slopes on both sides, 0 where those
    differ in sign; end slopes come from three points, cut so that the shape is kept.

    Args:
        x: Where values are known, increasing, shape (m,) with m ≥ 2.
        y: The values, shape (m,).
        at: Where values are wanted, between the first and the last x, shape (n,).

    Returns:
        Shape (n,).

    Source:
        Fritsch and Butland (1984), doi:10.1137/0905021; end slopes: Moler, Numerical Computing with MATLAB
        (2004), §3.6.
    """
    h, rise = np.diff(x), np.diff(y)
    secant = rise / h
    slope = _slopes(h, secant)
    k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(h) - 1)
    s = (at - x[k]) / h[k]
    bent = s * (1 - s) * h[k] * ((1 - s) * (slope[k] - secant[k]) - s * (slope[k + 1] - secant[k]))
    return np.asarray(y[k] + s * rise[k] + bent)


def _slopes(h: Array, secant: Array) -> Array:
    slope = np.empty(len(h) + 1)
    if len(h) == 1:
        slope[:] = secant[0]
        return slope
    before, after = secant[:-1], secant[1:]
    w1, w2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    turning = np.sign(before) * np.sign(after) <= 0
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (w1 + w2) / (w1 / before + w2 / after)
    slope[1:-1] = np.where(turning, 0.0, mean)
    slope[0] = _end(h[0], h[1], secant[0], secant[1])
    slope[-1] = _end(h[-1], h[-2], secant[-1], secant[-2])
    return slope


def _end(h0: float, h1: float, first: float, second: float) -> float:
    slope = ((2 * h0 + h1) * first - h0 * second) / (h0 + h1)
    if np.sign(slope) != np.sign(first):
        return 0.0
    if np.sign(first) != np.sign(second) and abs(slope) > 3 * abs(first):
        return float(3 * first)
    return float(slope)
