"""One quantity, solved over measured, and the difference of the two."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from armik_sym.report.style import ALLOWED, FAINT, LIMIT, MEASURED, SOLVED, remark, style_axes

Array = NDArray[np.float64]

SOLVED_LINE: dict[str, Any] = {"color": SOLVED, "linewidth": 1.7}
MEASURED_LINE: dict[str, Any] = {"color": MEASURED, "linewidth": 1.5, "linestyle": (0, (3, 1.6))}

# A quantity that hardly moves is not blown up to fill its panel, in degrees and in millimetres.
_SMALLEST_SPAN = {"deg": 20.0, "mm": 40.0}


@dataclass(frozen=True, eq=False)
class Curves:
    """What one pair of panels shows.

    Attributes:
        title: What the quantity is.
        unit: Its unit, "deg" or "mm".
        solved: Shape (n,), in `unit`.
        measured: Shape (n,), NaN where missing, in `unit`.
        difference: Shape (n,), NaN where missing, in `unit`.
        limits: Lower and upper limit, in `unit`, or None.
        quantity: What is drawn over time.
        distance: Whether `difference` is a distance, never negative.
    """

    title: str
    unit: str
    solved: Array
    measured: Array
    difference: Array
    limits: tuple[float, float] | None = None
    quantity: str = "angle"
    distance: bool = False


def draw_pair(axes: Axes, time: Array, curves: Curves) -> None:
    """Draw solved over measured, with the limits where they are near.

    Args:
        axes: The panel.
        time: Time stamps, shape (n,), in [s].
        curves: What to draw.

    Source:
        Compare Nguyen 2021, Figs. 9b-13b.
    """
    style_axes(axes, curves.title, "", f"{curves.quantity} [{curves.unit}]")
    axes.tick_params(labelbottom=False)
    axes.plot(time, curves.solved, **SOLVED_LINE, zorder=2.5)
    axes.plot(time, curves.measured, **MEASURED_LINE, zorder=3)
    low, high = _view(curves)
    axes.set_ylim(low, high)
    axes.yaxis.set_major_locator(MaxNLocator(4))
    if curves.limits is not None:
        lower, upper = curves.limits
        axes.axhspan(lower, upper, color=ALLOWED, linewidth=0, zorder=0)
        for limit in curves.limits:
            if low < limit < high:
                axes.axhline(limit, color=LIMIT, linewidth=0.9)


def draw_difference(axes: Axes, time: Array, curves: Curves, scale: float) -> None:
    """Draw the difference around zero, with its mean and maximum in words.

    Args:
        axes: The panel, below that of `draw_pair`.
        time: Time stamps, shape (n,), in [s].
        curves: What to draw.
        scale: Largest value the panel has room for, in the unit of the curves.

    Source:
        Compare Nguyen 2021, Figs. 9c-13c.
    """
    d = curves.difference
    style_axes(axes, "", "time [s]", f"[{curves.unit}]")
    axes.axhline(0.0, color=LIMIT, linewidth=0.8)
    axes.fill_between(time, 0.0, d, color=FAINT, alpha=0.35, linewidth=0)
    axes.plot(time, d, color=LIMIT, linewidth=1.0)
    signed = not curves.distance
    axes.set_ylim(-scale if signed else 0.0, scale)
    axes.yaxis.set_major_locator(MaxNLocator(4 if signed else 3, symmetric=signed))
    if len(time) > 1:
        axes.set_xlim(time[0], time[-1])
    known = d[np.isfinite(d)]
    if known.size:
        mean, largest = float(np.abs(known).mean()), float(np.abs(known).max())
        what = "difference" if signed else "distance"
        remark(axes, f"{what}: mean {mean:.1f}, max {largest:.1f} {curves.unit}")
    else:
        remark(axes, "no measured sample to compare with")


def _view(curves: Curves) -> tuple[float, float]:
    """Lower and upper end of a panel: all curves, and at least a span that keeps noise small."""
    both = np.concatenate([curves.solved, curves.measured])
    both = both[np.isfinite(both)]
    low, high = (float(both.min()), float(both.max())) if both.size else (-1.0, 1.0)
    missing = max(_SMALLEST_SPAN[curves.unit] - (high - low), 0.0)
    room = 0.06 * max(high - low, _SMALLEST_SPAN[curves.unit]) + 0.5 * missing
    return low - room, high + room
