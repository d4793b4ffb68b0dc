"""The way of the hand through space, with the arm at a few instants."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.report.page import new_figure
from armik_sym.report.stick_figure import StickFigure, stick_figure
from armik_sym.report.style import INK, MEASURED, SOLVED, label, style_axes
from armik_sym.solution import Solution

Array = NDArray[np.float64]

_ANATOMICAL = "x up, z forward"
_PANEL = (4.8, 4.2)
_MARGIN = 0.14
_SMALLEST_SCALE = 1.0  # [mm/inch]
_INSTANTS = 5
# Postures nearer to each other than this share of the whole path, or than this, hide each other.
_APART_SHARE, _APART = 0.15, 0.08
# From light to dark: the last posture is the darkest in a grey print, too.
_LIGHTEST, _DARKEST = 0.76, 0.13
_VISIBLE_ERROR = 2e-4


@dataclass(frozen=True)
class _View:
    title: str
    across: int
    up: int
    x_label: str
    y_label: str


_ANATOMICAL_VIEWS = (
    _View("From the side (the person faces right)", 2, 0, "forward → [mm]", "up → [mm]"),
    _View("From above (the person faces up)", 1, 2, "to the right → [mm]", "forward → [mm]"),
)
_PLAIN_VIEWS = (
    _View("x and y", 0, 1, "x [mm]", "y [mm]"),
    _View("x and z", 0, 2, "x [mm]", "z [mm]"),
)


def hand_path_figure(solution: Solution, *, title: str | None = None, note: str | None = None) -> Figure:
    """Draw the path of the hand in two views at right angles, and the arm at four instants.

    Axes are called up, forward and right for arms whose description says "x up, z forward", as the
    E-HMCS and the human arm of the catalogue do; otherwise x, y and z of the base frame.

    Args:
        solution: The solution.
        title: What the motion is; None for "Path of the hand".
        note: Where the data come from, written below the title; None takes the note of the path.

    Returns:
        A figure with equal axes, in [mm], origin at the base of the arm.

    Source:
        Compare Nguyen 2021, Fig. 8.
    """
    arm = solution.arm
    hand, _ = hand_pose(arm.chain, solution.q, arm.lengths)
    instants = _spread(hand)
    sticks = stick_figure(arm, solution.q[instants])
    key = f"Blue: way of the {sticks.names[-1]}. Grey to black: the arm at {len(instants)} instants."
    if _misses(solution):
        key += " Dashed: the path asked for."
    facts = f"arm {arm.name}, {solution.path.duration:.1f} s. Verdict: {'ok' if solution.ok else 'NOT ok'}"
    note = solution.path.note if note is None else note
    lines = [note, key] if note else [key]
    figure, grid = new_figure(f"{title or 'Path of the hand'}: {facts}", lines, 1, 2, _PANEL)
    for column, view in enumerate(_views(arm)):
        axes = figure.add_subplot(grid[0, column])
        style_axes(axes, view.title, view.x_label, view.y_label)
        _draw_sticks(axes, view, sticks, solution.time[instants])
        _draw_path(axes, view, solution, hand)
        _equal_axes(axes)
    return figure


def _views(arm: Arm) -> tuple[_View, _View]:
    return _ANATOMICAL_VIEWS if _ANATOMICAL in arm.description else _PLAIN_VIEWS


def _equal_axes(axes: Axes) -> None:
    """Limits that hold everything drawn, with room for labels, and the same scale in both directions."""
    drawn = axes.dataLim
    scale = (1 + 2 * _MARGIN) * max(drawn.width / _PANEL[0], drawn.height / _PANEL[1], _SMALLEST_SCALE)
    middle_x, middle_y = 0.5 * (drawn.x0 + drawn.x1), 0.5 * (drawn.y0 + drawn.y1)
    axes.set_xlim(middle_x - 0.5 * scale * _PANEL[0], middle_x + 0.5 * scale * _PANEL[0])
    axes.set_ylim(middle_y - 0.5 * scale * _PANEL[1], middle_y + 0.5 * scale * _PANEL[1])
    axes.set_aspect("equal", adjustable="datalim")


def _misses(solution: Solution) -> bool:
    return bool(solution.position_error.max() > _VISIBLE_ERROR)


def _spread(hand: Array) -> list[int]:
    """The first and the last sample, and those between at which the hand is farthest from the others."""
    chosen = [0, len(hand) - 1]
    extent = float(np.linalg.norm(np.ptp(hand, axis=0)))
    while len(chosen) < _INSTANTS:
        nearest = np.linalg.norm(hand[:, None] - hand[chosen], axis=2).min(axis=1)
        k = int(np.argmax(nearest))
        if nearest[k] <= max(_APART, _APART_SHARE * extent):
            break
        chosen.append(k)
    return sorted(chosen)


def _draw_sticks(axes: Axes, view: _View, sticks: StickFigure, times: Array) -> None:
    flat = 1000 * sticks.points[:, :, [view.across, view.up]]
    last = len(flat) - 1
    for k, (points, time) in enumerate(zip(flat, times, strict=True)):
        grey = str(_LIGHTEST + (_DARKEST - _LIGHTEST) * k / last)
        axes.plot(*points.T, color=grey, linewidth=3, marker="o", markersize=5, zorder=2 + 0.1 * k)
        word = "start " if k == 0 else "end " if k == last else ""
        label(axes, points[-1], f"{word}{time:.1f} s", points[-1] - points[-2], SOLVED)
    # Names go beside the last posture, where it leaves most room: away from the neighbouring points.
    for i, name in enumerate(sticks.names[:-1]):
        around = flat[:, i + 1].mean(axis=0) if i == 0 else 0.5 * (flat[last, i - 1] + flat[last, i + 1])
        if name:
            label(axes, flat[last, i], name, flat[last, i] - around, INK)


def _draw_path(axes: Axes, view: _View, solution: Solution, hand: Array) -> None:
    pick = [view.across, view.up]
    if _misses(solution):
        wanted = 1000 * solution.path.position[:, pick]
        axes.plot(*wanted.T, color=MEASURED, linewidth=1.4, linestyle=(0, (3, 2)), zorder=4)
    path = 1000 * hand[:, pick]
    axes.plot(*path.T, color=SOLVED, linewidth=2.2, zorder=3)
    ends: dict[str, Any] = {"color": SOLVED, "markersize": 7, "markeredgewidth": 2, "zorder": 5}
    axes.plot(*path[0], marker="o", markerfacecolor="white", **ends)
    axes.plot(*path[-1], marker="s", **ends)
