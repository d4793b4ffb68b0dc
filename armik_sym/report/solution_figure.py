"""A solution on one page: every joint in its range of motion, what is left of the path, the speed."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.figure import Figure

from armik_sym.motion.joint_motion import JointMotion
from armik_sym.report.joint_panel import draw_joint, draw_key
from armik_sym.report.page import new_figure
from armik_sym.report.quality_panels import PanelWords, draw_error, draw_speed, mark_missed
from armik_sym.solution import Solution
from armik_sym.symbolic import Orientation

_COLUMNS = 3
_PANEL = (2.9, 1.5)
_REASONS_WIDTH = 150


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
        note: Where the data come from, written below the title; None takes the note of the path.

    Returns:
        A figure; angles in [deg], errors in [mm] and [deg] (or finer), speed in [deg/s], time in [s].

    Source:
        Compare Nguyen 2021, Figs. 9-13.
    """
    arm = solution.arm
    rows = -(-(arm.dof + 1) // _COLUMNS)
    reasons = textwrap.shorten("; ".join(solution.reasons), _REASONS_WIDTH, placeholder=" …")
    note = solution.path.note if note is None else note
    lines = [line for line in (note, reasons) if line]
    figure, grid = new_figure(_title(solution, title), lines, rows + 1, _COLUMNS, _PANEL)
    for i in range(arm.dof):
        draw_joint(figure.add_subplot(grid[divmod(i, _COLUMNS)]), solution, i, measured)
    row, column = divmod(arm.dof, _COLUMNS)
    draw_key(figure.add_subplot(grid[row, column:]), solution, measured)

    need = solution.requirements
    position = PanelWords("Position error", "mm", 1000 * need.position_tolerance)
    errors = figure.add_subplot(grid[rows, 0])
    draw_error(errors, solution.time, 1000 * solution.position_error, position)
    mark_missed(errors, solution)
    turned = solution.orientation is not Orientation.NONE
    if turned:
        rotation = PanelWords("Rotation error", "deg", float(np.rad2deg(need.rotation_tolerance)))
        error_deg = np.rad2deg(solution.rotation_error)
        draw_error(figure.add_subplot(grid[rows, 1]), solution.time, error_deg, rotation)
    draw_speed(figure.add_subplot(grid[rows, 2 if turned else 1]), solution)
    return figure


def _title(solution: Solution, title: str | None) -> str:
    facts = (
        f"arm {solution.arm.name}, method {solution.method}, {len(solution.q)} samples. "
        f"Verdict: {'ok' if solution.ok else 'NOT ok'}"
    )
    return f"{title}: {facts}" if title else facts[:1].upper() + facts[1:]
