"""Solved over measured motion on one page, and below each quantity their difference."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from armik_sym.comparison import Comparison
from armik_sym.report.comparison_panel import (
    MEASURED_LINE,
    SOLVED_LINE,
    Curves,
    draw_difference,
    draw_pair,
)
from armik_sym.report.page import new_figure
from armik_sym.report.style import ALLOWED, INK, PANEL_SIZE
from armik_sym.report.words import joint_title

Array = NDArray[np.float64]

_COLUMNS = 3
_PANEL = (2.9, 2.3)
# Characters that fit on a line of the page.
_WIDTH = 130
_NOTES = 3
# Differences smaller than this fill no panel: they would only show noise, in degrees and in millimetres.
_SMALLEST_SCALE = {"deg": 5.0, "mm": 10.0}


def comparison_figure(comparison: Comparison, *, title: str | None = None) -> Figure:
    """Draw a comparison: for every joint solved over measured angle and their difference, swivel, elbow.

    All differences in degrees have one scale, so that large and small ones look it.

    Args:
        comparison: The comparison.
        title: What the motion is; method and arm are added.

    Returns:
        A figure; angles in [deg], elbow in [mm], time in [s].

    Source:
        Compare Nguyen 2021, Figs. 9-13.
    """
    curves = _curves(comparison)
    rows = -(-len(curves) // _COLUMNS)
    figure, grid = new_figure(_title(comparison, title), _lines(comparison), rows, _COLUMNS, _PANEL)
    scales = _scales(curves)
    for i, each in enumerate(curves):
        cell = grid[divmod(i, _COLUMNS)].subgridspec(2, 1, height_ratios=(1.7, 1.0), hspace=0.3)
        upper = figure.add_subplot(cell[0])
        lower = figure.add_subplot(cell[1], sharex=upper)
        draw_pair(upper, comparison.time, each)
        draw_difference(lower, comparison.time, each, scales[each.unit])
    _draw_key(figure, comparison)
    return figure


def _draw_key(figure: Figure, comparison: Comparison) -> None:
    """What lines and colours are, in the first line of the head that was left free for it."""
    handles = [
        Line2D([], [], **SOLVED_LINE, label=f"solved, method {comparison.solution.method}"),
        Line2D([], [], **MEASURED_LINE, label="measured"),
        Patch(facecolor=ALLOWED, label="range of motion of the arm"),
    ]
    figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=figure.texts[1].get_position(),
        ncols=len(handles),
        frameon=False,
        fontsize=PANEL_SIZE,
        labelcolor=INK,
        borderaxespad=0,
        borderpad=0,
    )


def _curves(c: Comparison) -> list[Curves]:
    rom, names = c.solution.arm.rom, c.solution.arm.joint_names
    out = []
    for i, (name, unit) in enumerate(zip(c.joint_names, c.units, strict=True)):
        joint = names.index(name)
        limits = (unit.factor * float(rom.lower[joint]), unit.factor * float(rom.upper[joint]))
        solved, measured = unit.factor * c.q[:, i], unit.factor * c.measured[:, i]
        out.append(Curves(joint_title(name), unit.name, solved, measured, solved - measured, limits))
    if c.swivel is not None and c.swivel_difference is not None:
        apart, solved = np.rad2deg(c.swivel_difference), np.rad2deg(c.swivel)
        out.append(Curves("Swivel of the elbow", "deg", solved, solved - apart, apart))
    if c.elbow is not None and c.measured_elbow is not None and c.elbow_difference is not None:
        solved, measured = (_height(c, place) for place in (c.elbow, c.measured_elbow))
        axis = "height" if c.solution.arm.up is not None else "along x"
        apart = 1000 * c.elbow_difference
        out.append(Curves("Elbow", "mm", solved, measured, apart, quantity=axis, distance=True))
    return out


def _height(c: Comparison, place: Array) -> Array:
    """Height of the elbow over the base, where the arm knows what up is; else its first coordinate."""
    up = np.array([1.0, 0.0, 0.0]) if c.solution.arm.up is None else np.asarray(c.solution.arm.up)
    return np.asarray(1000 * place @ up)


def _scales(curves: list[Curves]) -> dict[str, float]:
    scales = dict(_SMALLEST_SCALE)
    for each in curves:
        largest = float(np.nanmax(np.abs(each.difference), initial=0.0))
        scales[each.unit] = max(scales[each.unit], 1.15 * largest)
    return scales


def _title(c: Comparison, title: str | None) -> str:
    facts = f"arm {c.solution.arm.name}, method {c.solution.method} against measured, {len(c.time)} samples"
    return f"{title}: {facts}" if title else facts[:1].upper() + facts[1:]


def _lines(c: Comparison) -> list[str]:
    lines = [_explanation(c)]
    lines += [c.solution.path.note] if c.solution.path.note else []
    notes = [f"Note: {note}." for note in c.notes[:_NOTES]]
    if len(c.notes) > _NOTES:
        notes[-1] += f" (and {len(c.notes) - _NOTES} more)"
    if not c.solution.ok:
        notes.append(f"Solution not ok: {'; '.join(c.solution.reasons)}.")
    lines += notes
    wrapped = [textwrap.wrap(line, _WIDTH, max_lines=2, placeholder=" …") for line in lines]
    return [" ", *(part for parts in wrapped for part in parts)]


def _explanation(c: Comparison) -> str:
    d = c.all_joints
    numbers = (
        f"All joints: mean {np.rad2deg(d.mean):.1f}°, max {np.rad2deg(d.max):.1f}°. " if d.samples else ""
    )
    return (
        f"{numbers}Lower panels: solved minus measured, one scale for all angles. Many postures put the hand "
        "on the path: a difference is no error."
    )
