"""One joint over time, inside its range of motion."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from armik_sym.motion.joint_motion import JointMotion
from armik_sym.report.style import ALLOWED, FAINT, INK, LIMIT, MEASURED, PANEL_SIZE, SOLVED, TEXT_SIZE, style_axes
from armik_sym.report.words import joint_title, joint_unit
from armik_sym.solution import Solution

_SOLVED_LINE = {"color": SOLVED, "linewidth": 1.8}
_MEASURED_LINE = {"color": MEASURED, "linewidth": 1.4, "linestyle": (0, (3, 2))}
_LIMIT_LINE = {"color": LIMIT, "linewidth": 0.9}


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
    unit, factor = joint_unit(solution.arm, i)
    lower, upper = factor * solution.arm.rom.lower[i], factor * solution.arm.rom.upper[i]
    word = "angle" if unit == "deg" else "shift"
    style_axes(axes, joint_title(name), "time [s]", f"{word} [{unit}]")
    margin = factor * solution.rom_margin[i]
    axes.set_title(f"margin {_number(margin)} {unit}", loc="right", fontsize=TEXT_SIZE, color=FAINT)

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
    axes.set_yticks(_ticks(lower, upper))


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
    unit, factor = joint_unit(solution.arm, tightest)
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
        0.0,
        "Each joint counts up in the movement it is named after.\n"
        "Margin: smallest distance to a limit; nearest is\n"
        f"{joint_title(solution.arm.joint_names[tightest]).lower()}, "
        f"{_number(factor * solution.rom_margin[tightest])} {unit}.",
        fontsize=TEXT_SIZE,
        color=INK,
        va="bottom",
        transform=axes.transAxes,
    ).set_in_layout(False)


def _number(value: float) -> str:
    return f"{value:.1f}" if abs(value) >= 0.05 or value == 0 else f"{value:.1g}"


def _ticks(lower: float, upper: float) -> list[float]:
    """Both limits, and zero between them if it is not too near to either."""
    width = upper - lower
    ticks = [lower, upper] if width else [lower]
    if min(-lower, upper) > 0.15 * width:
        ticks.insert(1, 0.0)
    elif width:
        ticks.insert(1, lower + width / 2)
    return ticks
