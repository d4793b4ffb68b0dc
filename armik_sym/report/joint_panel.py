"""One joint over time, inside its range of motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from armik_sym.arm.display_units import joint_unit
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.report.style import (
    ALLOWED,
    FAINT,
    INK,
    LIMIT,
    MEASURED,
    PANEL_SIZE,
    SOLVED,
    TEXT_SIZE,
    remark,
    style_axes,
)
from armik_sym.report.words import joint_title
from armik_sym.solution import Solution

_SOLVED_LINE: dict[str, Any] = {"color": SOLVED, "linewidth": 1.8}
_MEASURED_LINE: dict[str, Any] = {"color": MEASURED, "linewidth": 1.4, "linestyle": (0, (3, 2))}
_LIMIT_LINE: dict[str, Any] = {"color": LIMIT, "linewidth": 0.9}
_AT_LIMIT = 0.05


def draw_joint(axes: Axes, solution: Solution, i: int, measured: JointMotion | None) -> None:
    """Draw one joint: range of motion as a band, its limits as lines, the solved and measured motion.

    Args:
        axes: The panel.
        solution: The solution.
        i: Index of the joint.
        measured: Measured motion, or None.

    Source:
        Compare Nguyen 2021, Figs. 9-13.
    """
    name = solution.arm.joint_names[i]
    shown = joint_unit(solution.arm, i)
    unit, factor = shown.name, shown.factor
    lower, upper = factor * solution.arm.rom.lower[i], factor * solution.arm.rom.upper[i]
    word = "angle" if unit == "deg" else "shift"
    style_axes(axes, joint_title(name), "time [s]", f"{word} [{unit}]")
    margin = factor * float(solution.rom_margin[i])
    colour = FAINT if margin >= _AT_LIMIT else INK if margin >= 0 else MEASURED
    remark(axes, margin_words(margin, unit), colour)

    axes.axhspan(lower, upper, color=ALLOWED, linewidth=0, zorder=0)
    for limit in (lower, upper):
        axes.axhline(limit, **_LIMIT_LINE)
    if measured is not None and name in measured.joint_names:
        q = measured.q[:, measured.joint_names.index(name)]
        axes.plot(measured.time, factor * q, **_MEASURED_LINE, zorder=3, label="measured")
    axes.plot(solution.time, factor * solution.q[:, i], **_SOLVED_LINE, zorder=2.5, label="solved")

    room = 0.06 * max(upper - lower, 1e-3)
    low, high = min(lower, axes.dataLim.y0), max(upper, axes.dataLim.y1)
    axes.set_ylim(low - room, high + room)
    axes.set_xlim(solution.time[0], solution.time[-1])
    ticks = limit_ticks(lower, upper)
    axes.set_yticks(ticks, [f"{tick:.4g}" for tick in ticks])


def draw_key(axes: Axes, solution: Solution, measured: JointMotion | None) -> None:
    """Explain the lines of the joint panels, in a panel of its own.

    Args:
        axes: The panel.
        solution: The solution.
        measured: Measured motion, or None.

    Source:
        None (reporting).
    """
    axes.set_axis_off()
    tightest = int(np.argmin(solution.rom_margin))
    shown = joint_unit(solution.arm, tightest)
    unit, factor = shown.name, shown.factor
    name = joint_title(solution.arm.joint_names[tightest]).lower()
    nearest = margin_words(factor * float(solution.rom_margin[tightest]), unit)
    entries: list[Line2D | Patch] = [Line2D([], [], **_SOLVED_LINE, label="solved")]
    if measured is not None:
        entries.append(Line2D([], [], **_MEASURED_LINE, label="measured"))
    entries.append(Patch(facecolor=ALLOWED, edgecolor=LIMIT, label="range of motion"))
    key = axes.legend(
        handles=entries, loc="upper left", frameon=False, fontsize=PANEL_SIZE, labelcolor=INK, borderaxespad=0
    )
    key.set_in_layout(False)
    axes.text(
        0.0,
        0.35,
        "Margin: smallest distance to a limit of the range of motion.\n"
        f"Nearest to a limit: {name} ({nearest}).",
        fontsize=TEXT_SIZE,
        color=INK,
        va="bottom",
        transform=axes.transAxes,
    ).set_in_layout(False)


def margin_words(margin: float, unit: str) -> str:
    """How much room is left to a limit, in words.

    Args:
        margin: The room, in `unit`; negative outside.
        unit: The unit, as shown.

    Returns:
        Text such as "margin 12.0 deg".

    Source:
        None (reporting).
    """
    if margin < 0:
        return f"outside by {-margin:.2g} {unit}"
    return f"margin {margin:.1f} {unit}" if margin >= _AT_LIMIT else "touches its limit"


def limit_ticks(lower: float, upper: float) -> list[float]:
    """Both limits, and round numbers between them that are not too near to either.

    Args:
        lower: The lower limit, in the unit of the axis.
        upper: The upper limit.

    Returns:
        Where the axis has ticks.

    Source:
        None (reporting).
    """
    width = upper - lower
    if width <= 0:
        return [lower]
    between = MaxNLocator(nbins=4, steps=[1, 1.5, 2, 3, 4.5, 5, 9, 10]).tick_values(lower, upper)
    return [lower, *(float(t) for t in between if min(t - lower, upper - t) > 0.15 * width), upper]
