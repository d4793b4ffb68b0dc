"""Charts of what the drives make of a motion, and of the differences to the measured one."""

from __future__ import annotations

from typing import Any

import numpy as np

from armik_sym.report.html.chapter import Chapter
from armik_sym.report.html.chart import (
    MARGIN,
    SOLVED_LINE,
    Chart,
    limit_line,
    limit_words,
    line,
    new_chart,
    shown_samples,
    styles_of,
)
from armik_sym.report.style import MEASURED, SOLVED
from armik_sym.report.words import joint_title, without_exponents

_HEADROOM = 1.2
_ROW_HEIGHT = 30
# A legend above the axes, and the room it needs; rows with names of joints need room on the left, too.
_LEGEND: dict[str, Any] = {
    "showlegend": True,
    "legend": {"orientation": "h", "y": 1.0, "yanchor": "bottom", "x": 0},
    "margin": MARGIN | {"t": 30},
}
_NAMED_ROWS = _LEGEND["margin"] | {"l": 150}
_MARKS = {"type": "scatter", "mode": "markers", "cliponaxis": False}
# Open marks: where ways agree, all of them are seen.
_SYMBOLS = ("circle-open", "square-open", "x-thin-open", "triangle-up-open", "star-open")


def servo_charts(chapter: Chapter) -> list[Chart]:
    """How far hand and joints are off, with the drives.

    Args:
        chapter: The chapter.

    Returns:
        Two charts; none without a check.

    Source:
        None (reporting).
    """
    return [_hand_chart(chapter), _load_chart(chapter)] if chapter.servo is not None else []


def _hand_chart(chapter: Chapter) -> Chart:
    traces, top = [], 0.0
    styles = styles_of(chapter.others)
    start = float(chapter.solution.time[0])
    for name, found in reversed(list(chapter.checks.items())):
        tracking = found.tracking
        rows = shown_samples(tracking.hand_error)
        style = styles[name] if name else SOLVED_LINE
        error = 1000 * tracking.hand_error[rows]
        words = f"{name or 'solved'}, up to {without_exponents(f'{error.max():.2g}')} mm"
        traces.append(line(tracking.time[rows] + start, error, words, style, "mm"))
        top = max(top, float(error.max())) if not name else top
    check = chapter.checks[""]
    allowed = 1000 * check.tolerances.hand
    # Other ways may be off by far more: the scale is that of this motion.
    top = _HEADROOM * max(top, allowed)
    figure = new_chart(
        traces,
        "time [s]",
        "hand off [mm]",
        yaxis={"range": [0, top]},
        xaxis={"range": [start, start + float(check.tracking.time[-1])]},
        shapes=[limit_line(allowed)],
        annotations=[limit_words(allowed, f"allowed {allowed:.3g} mm")],
        **(_LEGEND | {"legend": _LEGEND["legend"] | {"traceorder": "reversed"}} if len(traces) > 1 else {}),
    )
    hand = check.tracking
    remark = f"at most {1000 * hand.hand_peak:.2g} mm, RMS {1000 * hand.hand_rms:.2g} mm"
    remark = without_exponents(remark)
    says = f"Distance from hand to its path with the drives: {remark}."
    return Chart("Hand with the drives", remark, says, figure, _height(len(check.joints)))


def _load_chart(chapter: Chapter) -> Chart:
    """Per joint the largest share of what its drive can: speed, torque, error allowed."""
    check = chapter.checks[""]
    joints = [joint_title(v.name) for v in check.joints][::-1]
    speed = np.array([v.speed / v.speed_limit for v in check.joints])[::-1]
    torque = np.array([v.torque / v.torque_limit for v in check.joints])[::-1]
    error = np.array([v.error_peak / check.tolerances.joint for v in check.joints])[::-1]
    marks = (
        ("speed", speed, SOLVED, "circle-open"),
        ("torque", torque, MEASURED, "square-open"),
        ("error", error, "#1A1A1A", "x-thin-open"),
    )
    traces = [
        {
            **_MARKS, "x": 100 * share, "y": joints, "name": name,
            "marker": {"color": colour, "symbol": symbol, "size": 10, "line": {"width": 2}},
            "hovertemplate": "%{x:.0f} % of what is possible or allowed",
        }
        for name, share, colour, symbol in marks
    ]  # fmt: skip
    most = 100 * float(max(speed.max(), torque.max(), error.max()))
    figure = new_chart(
        traces,
        "share of the limit [%]",
        "",
        xaxis={"range": [0, max(110.0, 1.1 * most)]},
        yaxis={"automargin": True, "type": "category"},
        hovermode="closest",
        shapes=[
            {
                "type": "line",
                "x0": 100,
                "x1": 100,
                "yref": "paper",
                "y0": 0,
                "y1": 1,
                "line": {"color": "#444444"},
            }
        ],
        **_LEGEND | {"margin": _NAMED_ROWS},
    )
    says = f"Each drive is used to at most {most:.0f} % of its speed, its torque or the error allowed."
    remark = f"at most {most:.0f} %"
    return Chart("How hard the drives work", remark, says, figure, _height(len(joints)), timed=False)


def _height(rows: int) -> int:
    """Of a chart with rows, in [px]."""
    return max(210, 90 + _ROW_HEIGHT * rows)


def difference_chart(chapter: Chapter) -> Chart | None:
    """Mean difference of every joint to the measured motion, for all ways; None if nothing was measured.

    Args:
        chapter: The chapter.

    Returns:
        The chart.

    Source:
        Compare Nguyen 2021, Table 6.
    """
    found = chapter.differences
    if not found:
        return None
    styles = styles_of(chapter.others)
    names = [joint_title(name) for name in found[""].joint_names][::-1]
    traces: list[dict[str, Any]] = []
    for name, each in found.items():
        mean = np.array([unit.factor * d.mean for unit, d in zip(each.units, each.joints, strict=True)])[::-1]
        traces.append(
            {
                **_MARKS, "x": mean, "y": names, "name": name or "solved",
                "marker": {
                    "color": styles[name]["color"] if name else SOLVED, "size": 11, "line": {"width": 2},
                    "symbol": _SYMBOLS[len(traces) % len(_SYMBOLS)],
                },
                "hovertemplate": "%{x:.3~g}°",
            }
        )  # fmt: skip
    overall = float(np.rad2deg(found[""].all_joints.mean))
    figure = new_chart(
        traces,
        "mean difference [deg]",
        "",
        xaxis={"rangemode": "tozero"},
        yaxis={"automargin": True, "type": "category"},
        hovermode="closest",
        **_LEGEND | {"margin": _NAMED_ROWS},
    )
    says = f"Mean difference to the measured motion over all joints: {overall:.1f}°."
    remark = f"mean {overall:.1f}°"
    return Chart("Difference to the measured motion", remark, says, figure, _height(len(names)), timed=False)
