"""Charts of a motion: joints in their ranges, what is left of the path, speed and acceleration."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.display_units import joint_unit, joint_units
from armik_sym.report.html.chapter import MEASURED_NAME, Chapter
from armik_sym.report.html.chart import (
    SOLVED_LINE,
    TOP,
    Chart,
    band,
    limit_line,
    limit_words,
    line,
    new_chart,
    shown_samples,
    styles_of,
)
from armik_sym.report.joint_panel import limit_ticks, margin_words
from armik_sym.report.style import SOLVED
from armik_sym.report.words import at_most, joint_title, plain, power_of_ten, without_exponents
from armik_sym.solution import Solution
from armik_sym.solution.motion_rates import joint_acceleration, joint_speed
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]

_ROUNDING = 1e-4
_FLOOR = 1e-15
_FILL = "rgba(0,114,178,0.15)"


def joint_charts(chapter: Chapter) -> list[Chart]:
    """One chart per joint: its range of motion, the solved and all other motions.

    Args:
        chapter: The chapter.

    Returns:
        The charts, in the order of the arm.

    Source:
        Compare Nguyen 2021, Figs. 9-13.
    """
    return [_joint_chart(chapter, j) for j in range(chapter.solution.arm.dof)]


def _joint_chart(chapter: Chapter, j: int) -> Chart:
    s = chapter.solution
    shown, name = joint_unit(s.arm, j), s.arm.joint_names[j]
    lower, upper = shown.factor * float(s.arm.rom.lower[j]), shown.factor * float(s.arm.rom.upper[j])
    rows, traces, drawn = shown_samples(s.q[:, j]), [], []
    styles = styles_of([*([MEASURED_NAME] if chapter.measured else []), *chapter.others])
    for other, style in styles.items():
        x, y = _other_line(chapter, other, j)
        if len(x):
            traces.append(line(x, shown.factor * y, other, style, shown.symbol))
            drawn.append(shown.factor * y)
    solved = shown.factor * s.q[rows, j]
    traces.append(line(s.time[rows], solved, "solved", SOLVED_LINE, shown.symbol))
    both = np.concatenate([solved, *drawn, [lower, upper]])
    low, high = float(np.nanmin(both)), float(np.nanmax(both))
    edge = 0.06 * max(high - low, 1e-3)
    ticks = limit_ticks(lower, upper)
    word = "angle" if shown.name == "deg" else "shift"
    figure = new_chart(
        traces,
        "time [s]",
        f"{word} [{shown.name}]",
        xaxis=_time_range(s),
        yaxis={
            "range": [low - edge, high + edge],
            "tickvals": ticks,
            "ticktext": [f"{tick:.4g}" for tick in ticks],
        },
        shapes=band(lower, upper),
    )
    remark = margin_words(shown.factor * float(s.rom_margin[j]), shown.name)
    says = (
        f"{joint_title(name)} over time: {solved.min():.0f} to {solved.max():.0f} {shown.name}; allowed "
        f"{lower:.0f} to {upper:.0f}."
    )
    return Chart(joint_title(name), remark, says, figure)


def _other_line(chapter: Chapter, name: str, j: int) -> tuple[Array, Array]:
    if name != MEASURED_NAME:
        other = chapter.others[name]
        rows = shown_samples(other.q[:, j])
        return other.time[rows], other.q[rows, j]
    joint, measured = chapter.solution.arm.joint_names[j], chapter.measured
    if measured is None or joint not in measured.joint_names:
        return np.zeros(0), np.zeros(0)
    q = measured.q[:, measured.joint_names.index(joint)]
    rows = shown_samples(q)
    return measured.time[rows], q[rows]


def error_charts(s: Solution) -> list[Chart]:
    """How far the hand is off its path, and how far turned wrong.

    Args:
        s: The solution.

    Returns:
        One or two charts.

    Source:
        None (reporting).
    """
    need = s.requirements
    charts = [
        _error_chart(s, 1000 * s.position_error, "Hand off its path", "mm", 1000 * need.position_tolerance)
    ]
    if s.orientation is not Orientation.NONE:
        allowed = float(np.rad2deg(need.rotation_tolerance))
        charts.append(_error_chart(s, np.rad2deg(s.rotation_error), "Hand turned wrong", "deg", allowed))
    return charts


def _error_chart(s: Solution, error: Array, title: str, unit: str, allowed: float) -> Chart:
    rows, largest = shown_samples(error), float(error.max())
    known = bool(np.isfinite(allowed))
    extra: dict[str, Any] = {}
    axis: dict[str, Any]
    if largest >= _ROUNDING:
        top = 1.1 * max(largest, allowed if known and allowed < 3 * largest else 0.0)
        y, axis, mark = error[rows], {"range": [0, top]}, known and allowed <= top
        label, place = f"error [{unit}]", allowed
    else:
        # Rounding alone: on a linear scale it would look like an error.
        ends = [
            int(np.log10(_FLOOR)),
            int(np.ceil(np.log10(max(allowed if known else _ROUNDING, largest)))) + 1,
        ]
        ticks = [10.0**e for e in range(ends[0], ends[1] + 1, 3)]
        y, mark = np.maximum(error[rows], _FLOOR), known
        axis = {
            "type": "log", "range": ends, "tickvals": ticks,
            "ticktext": [power_of_ten(tick) for tick in ticks],
        }  # fmt: skip
        label, place = (
            f"error [{unit}], log scale",
            float(np.log10(allowed)) if known and allowed > 0 else 0.0,
        )
    if mark:
        extra = {
            "shapes": [limit_line(allowed)],
            "annotations": [limit_words(place, f"allowed {plain(allowed)} {unit}")],
        }
    trace = line(s.time[rows], y, title.lower(), SOLVED_LINE, unit)
    figure = new_chart([trace], "time [s]", label, xaxis=_time_range(s), yaxis=axis, **extra)
    return Chart(title, at_most(largest, unit), f"{title}: {at_most(largest, unit)}.", figure)


def rate_charts(s: Solution) -> list[Chart]:
    """The fastest joint at every instant, and the one that accelerates most.

    Args:
        s: The solution.

    Returns:
        Two charts; one if there are only two samples.

    Source:
        None (reporting).
    """
    between = 0.5 * (s.time[1:] + s.time[:-1])
    need = s.requirements
    charts = [
        _rate_chart(s, between, joint_speed(s.time, s.q), need.max_speed, "Fastest joint", "speed", "/s")
    ]
    if len(s.q) > 2:
        rates = joint_acceleration(s.time, s.q)
        words = "Strongest acceleration", "acceleration", "/s²"
        charts.append(_rate_chart(s, s.time[1:-1], rates, need.max_acceleration, *words))
    return charts


def _rate_chart(
    s: Solution, time: Array, rates: Array, limits: Array, title: str, quantity: str, per: str
) -> Chart:
    units = joint_units(s.arm)
    turning = [j for j, unit in enumerate(units) if unit.si == "rad"] or list(range(s.arm.dof))
    unit = units[turning[0]]
    sizes = unit.factor * np.abs(rates[:, turning])
    rows = shown_samples(sizes.max(axis=1))
    which = np.array([joint_title(s.arm.joint_names[j]).lower() for j in turning])[sizes.argmax(axis=1)]
    k, j = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
    peak, most = sizes.max(axis=1), float(sizes.max())
    trace = line(time[rows], peak[rows], title, {**SOLVED_LINE, "width": 2}, unit.symbol)
    trace |= {
        "fill": "tozeroy", "fillcolor": _FILL, "text": which[rows].tolist(),
        "hovertemplate": f"%{{text}}, %{{y:.3~g}}{unit.symbol}{per}<extra></extra>",
    }  # fmt: skip
    top = (1 + 3 * TOP) * max(most, 1e-9)
    words = without_exponents(f"{which[k]}, {most:.3g}{unit.symbol}{per}")
    where = {
        "x": float(time[k]), "y": most, "text": words,
        "showarrow": False, "yanchor": "bottom", "font": {"color": SOLVED, "size": 12},
        "xanchor": _anchor((time[k] - s.time[0]) / s.path.duration),
    }  # fmt: skip
    limit = unit.factor * float(limits[turning[int(j)]])
    shapes = [limit_line(limit)] if limit < top else []
    label = f"{quantity} [{unit.name}{per}]"
    figure = new_chart(
        [trace],
        "time [s]",
        label,
        xaxis=_time_range(s),
        yaxis={"range": [0, top]},
        shapes=shapes,
        annotations=[where],
    )
    remark = f"allowed {limit:.4g}{unit.symbol}{per}" if np.isfinite(limit) else "no limit was set"
    says = f"{title}: at most {most:.3g} {unit.name}{per}, {which[k]}, at {time[k]:.2f} s."
    return Chart(title, remark, says, figure)


def _anchor(share: float) -> str:
    return "left" if share < 0.3 else "right" if share > 0.7 else "center"


def _time_range(s: Solution) -> dict[str, Any]:
    return {"range": [float(s.time[0]), float(s.time[-1])]}
