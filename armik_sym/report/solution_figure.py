"""A solution on one page: every joint in its range of motion, what is left of the path, the speed."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.figure import Figure

from armik_sym.motion.joint_motion import JointMotion
from armik_sym.report.joint_panel import draw_joint, draw_key
from armik_sym.report.quality_panels import draw_error, draw_speed
from armik_sym.report.style import head, new_figure
from armik_sym.solution import Solution
from armik_sym.symbolic import Orientation

_COLUMNS = 3
_ROW_HEIGHT = 2.2
_WIDTH = 11.0
_WARNING_WIDTH = 120


def solution_figure(
    solution: Solution,
    measured: JointMotion | None = None,
    *,
    title: str | None = None,
    note: str | None = None,
) -> Figure:
    """Draw a solution: one panel per joint with its range of motion, tracking errors, peak speed.

    Args:
        solution: The solution.
        measured: Joint angles to compare with; joints are matched by name.
        title: What the motion is; None leaves arm, method and verdict as the title.
        note: Where the data come from, for example "synthetic data"; written below the title.

    Returns:
        A figure; angles in [deg], errors in [mm] and [deg] (or finer), speed in [deg/s], time in [s].

    Source:
        Compare Nguyen 2021, Figs. 9-13.
    """
    arm = solution.arm
    rows = -(-(arm.dof + 1) // _COLUMNS)
    figure = new_figure(_WIDTH, 0.8 + _ROW_HEIGHT * (rows + 1))
    page = figure.add_gridspec(2, 1, height_ratios=[rows, 1])
    grid = page[0].subgridspec(rows, _COLUMNS)
    for i in range(arm.dof):
        draw_joint(figure.add_subplot(grid[divmod(i, _COLUMNS)]), solution, i, measured)
    row, column = divmod(arm.dof, _COLUMNS)
    draw_key(figure.add_subplot(grid[row, column:]), solution, measured)

    turned = solution.orientation is not Orientation.NONE
    below = page[1].subgridspec(1, 3 if turned else 2)
    need = solution.requirements
    draw_error(
        figure.add_subplot(below[0]),
        solution.time,
        1000 * solution.position_error,
        "Position error",
        "mm",
        1000 * need.position_tolerance,
    )
    if turned:
        draw_error(
            figure.add_subplot(below[1]),
            solution.time,
            np.rad2deg(solution.rotation_error),
            "Rotation error",
            "deg",
            float(np.rad2deg(need.rotation_tolerance)),
        )
    draw_speed(figure.add_subplot(below[-1]), solution)
    _write_head(figure, solution, title, note)
    return figure


def _write_head(figure: Figure, solution: Solution, title: str | None, note: str | None) -> None:
    facts = (
        f"arm {solution.arm.name}, method {solution.method}, {len(solution.q)} samples. "
        f"Verdict: {'ok' if solution.ok else 'NOT ok'}"
    )
    whole = f"{title}: {facts}" if title else facts[:1].upper() + facts[1:]
    reasons = textwrap.shorten("; ".join(solution.reasons), _WARNING_WIDTH, placeholder=" …")
    head(figure, whole, note=note, warning=reasons or None)
