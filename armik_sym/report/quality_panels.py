"""Panels that show how good a solution is: tracking errors and peak speed over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from armik_sym.arm.display_units import joint_units
from armik_sym.report.style import LIMIT, MEASURED, SOLVED, TEXT_SIZE, label, remark, style_axes
from armik_sym.report.words import at_most, joint_title, plain, power_of_ten
from armik_sym.solution import Solution
from armik_sym.solution.motion_rates import joint_speed

Array = NDArray[np.float64]

# Below this an error says something about arithmetic only: shown on a logarithmic scale.
_ROUNDING = 1e-4
_FLOOR = 1e-15
# So near to an edge of the panel a centred label would leave it.
_NEAR_EDGE = 0.3


@dataclass(frozen=True)
class PanelWords:
    """What an error panel is called, and what is allowed.

    Attributes:
        title: What the error is.
        unit: Its unit, as shown.
        allowed: Largest allowed error, in `unit`; infinite if none is set.
    """

    title: str
    unit: str
    allowed: float


def mark_missed(axes: Axes, solution: Solution) -> None:
    """Mark at the foot of a panel the samples at which a pointwise method stopped short.

    Args:
        axes: The panel, time to the right.
        solution: The solution.

    Source:
        None (reporting).
    """
    if solution.reached is None or solution.reached.all():
        return
    missed = solution.time[~solution.reached]
    foot = np.full(len(missed), 0.03)
    axes.plot(missed, foot, "|", color=MEASURED, markersize=7, transform=axes.get_xaxis_transform())
    axes.text(0.02, 0.9, "| not reached", color=MEASURED, fontsize=TEXT_SIZE, transform=axes.transAxes)


def draw_error(axes: Axes, time: Array, error: Array, words: PanelWords) -> None:
    """Draw a tracking error over time: linear if it can be measured, logarithmic if it is rounding.

    Args:
        axes: The panel.
        time: Time stamps, shape (n,), in [s].
        error: Errors, shape (n,), in the unit of `words`.
        words: Title, unit and what is allowed.

    Source:
        None (reporting).
    """
    largest, unit, allowed = float(error.max()), words.unit, words.allowed
    style_axes(axes, words.title, "time [s]", f"error [{unit}]")
    remark(axes, at_most(largest, unit))
    axes.set_xlim(time[0], time[-1])
    if largest >= _ROUNDING:
        axes.plot(time, error, color=SOLVED, linewidth=1.4)
        axes.set_ylim(0.0, 1.1 * largest)
        if allowed <= 1.1 * largest:
            _draw_limit(axes, allowed, f"allowed {plain(allowed)} {unit}")
        return
    axes.set_ylabel(f"error [{unit}], log scale", fontsize=TEXT_SIZE)
    axes.plot(time, np.maximum(error, _FLOOR), color=SOLVED, linewidth=1.0)
    top = allowed if np.isfinite(allowed) else largest
    axes.set_yscale("log")
    axes.set_ylim(_FLOOR, 30 * max(top, largest, _FLOOR))
    axes.minorticks_off()
    axes.yaxis.set_major_formatter(FuncFormatter(power_of_ten))
    if np.isfinite(allowed):
        _draw_limit(axes, allowed, f"allowed {plain(allowed)} {unit}")


def draw_speed(axes: Axes, solution: Solution) -> None:
    """Draw the speed of the fastest joint over time.

    Args:
        axes: The panel.
        solution: The solution.

    Source:
        None (reporting).
    """
    arm = solution.arm
    units = [(unit.name, unit.factor) for unit in joint_units(arm)]
    unit = "deg" if any(name == "deg" for name, _ in units) else "mm"
    chosen = [i for i, (name, _) in enumerate(units) if name == unit]
    factor = units[chosen[0]][1]
    speed = factor * np.abs(joint_speed(solution.time, solution.q[:, chosen]))
    between = 0.5 * (solution.time[1:] + solution.time[:-1])
    peak = speed.max(axis=1)
    k, j = np.unravel_index(int(np.argmax(speed)), speed.shape)

    style_axes(axes, "Fastest joint", "time [s]", f"speed [{unit}/s]")
    axes.fill_between(between, peak, color=SOLVED, alpha=0.15, linewidth=0)
    axes.plot(between, peak, color=SOLVED, linewidth=1.4)
    axes.set_xlim(solution.time[0], solution.time[-1])
    top = 1.25 * max(float(peak.max()), 1e-9)
    axes.set_ylim(0.0, top)
    limit = factor * float(solution.requirements.max_speed[chosen[int(j)]])
    if np.isfinite(limit):
        remark(axes, f"allowed {limit:.0f} {unit}/s")
    axes.plot(between[k], peak[k], marker="o", markersize=4, color=SOLVED)
    share = (between[k] - solution.time[0]) / (solution.time[-1] - solution.time[0])
    away = np.array([1.0 if share < _NEAR_EDGE else -1.0 if share > 1 - _NEAR_EDGE else 0.0, 1.0])
    name = joint_title(arm.joint_names[chosen[int(j)]]).lower()
    label(axes, np.array([between[k], peak[k]]), f"{name}, {peak[k]:.0f} {unit}/s", away, SOLVED)
    if limit < top:
        _draw_limit(axes, limit, "")


def _draw_limit(axes: Axes, value: float, words: str) -> None:
    axes.axhline(value, color=LIMIT, linewidth=0.9, linestyle="--")
    axes.annotate(
        words,
        (0.99, value),
        xycoords=("axes fraction", "data"),
        xytext=(0, 2),
        textcoords="offset points",
        ha="right",
        va="bottom",
        fontsize=TEXT_SIZE,
        color=LIMIT,
    )
