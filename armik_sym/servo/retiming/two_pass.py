"""The fastest speed along a path: backwards what can still be braked, forwards as fast as that allows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.servo.retiming.cells import Cells

Array = NDArray[np.float64]


def fastest(cells: Cells, start: float, end: float, least: float) -> tuple[Array, Array]:
    """Largest x = ṡ² at the ends of the cells, and u = s̈ in them: x_{i+1} = x_i + 2 h_i u_i.

    Backwards: the largest x from which some u leads to an x that is still good. Forwards: the largest u. All
    sets are intervals of x and the bounds are linear, so both are closed forms.

    Args:
        cells: The limits.
        start: x at the beginning; less if that cannot be braked.
        end: Largest x at the end.
        least: x never falls below it; the constant x must keep all limits, 0 does.

    Returns:
        x, shape (m + 1,), and u, shape (m,).

    Source:
        Bobrow, Dubowsky & Gibson 1985 (time-optimal along a path); Pham & Pham 2018 (two passes).
    """
    h = np.diff(cells.s)
    brakeable = _backward(cells, h, end, least)
    return _forward(cells, h, brakeable, start, least)


def _backward(cells: Cells, h: Array, end: float, least: float) -> Array:
    high = np.maximum(cells.highest, least)
    good = np.empty(len(high))
    good[-1] = max(min(high[-1], end), least)
    per_step = 0.5 / h
    # Down to `least` in one cell at most: does not depend on what follows.
    apart = cells.slope - per_step[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        bound = np.where(apart > 0, (cells.spread - least * per_step[:, None]) / apart, np.inf)
    high[:-1] = np.maximum(np.minimum(high[:-1], bound.min(axis=1, initial=np.inf)), least)
    for i in range(len(h) - 1, -1, -1):
        room = -apart[i]
        open_ = room > 0
        reach = (good[i + 1] * per_step[i] + cells.spread[i][open_]) / room[open_]
        good[i] = max(min(high[i], float(reach.min(initial=np.inf))), least)
    return good


def _forward(cells: Cells, h: Array, good: Array, start: float, least: float) -> tuple[Array, Array]:
    x = np.empty(len(good))
    x[0] = max(min(good[0], start), least)
    for i in range(len(h)):
        most = float((cells.spread[i] - cells.slope[i] * x[i]).min(initial=np.inf))
        x[i + 1] = max(min(x[i] + 2 * h[i] * most, good[i + 1]), least)
    return x, np.diff(x) / (2 * h)
