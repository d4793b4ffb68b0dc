"""One look for all figures: colours everyone can tell apart, direct labels, units on every axis.

Colours are those of Okabe and Ito; they differ in lightness too, and line styles repeat what colour
says, so that a grey print stays readable.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError

Array = NDArray[np.float64]
Size = tuple[float, float]

SOLVED = "#0072B2"
MEASURED = "#D55E00"
ALLOWED = "#E8F1F8"
LIMIT = "#444444"
INK = "#1A1A1A"
FAINT = "#707070"
GRID = "#D9D9D9"

TITLE_SIZE = 11.5
PANEL_SIZE = 9.0
TEXT_SIZE = 8.0

FORMATS = (".pdf", ".png", ".svg")

_RESOLUTION_DPI = 150
# Margins in inches: of the page, of a line of the head, and around panels for their labels.
_EDGE, _LINE = 0.15, 0.22
_LEFT, _ABOVE, _BELOW, _BESIDE, _BETWEEN = 0.7, 0.3, 0.5, 0.75, 0.75
_TO_X_LABEL, _TO_Y_LABEL = 0.26, 0.42
_MOST_TICKS = 6
_LABEL_DISTANCE = 9.0
# Text in vector files stays text; the same figure gives the same file.
_SAVING: dict[Any, Any] = {"pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "armik_sym"}


def new_figure(title: str, lines: list[str], rows: int, columns: int, panel: Size) -> tuple[Figure, GridSpec]:
    """A white figure with a head and a grid of panels, in fixed margins.

    Fixed margins are drawn three times as fast as a layout engine finds them, and every figure of a
    kind looks the same.

    Args:
        title: First line of the head.
        lines: Lines below it: what the reader has to know.
        rows: Rows of panels.
        columns: Columns of panels.
        panel: Width and height of a panel, in [inch].

    Returns:
        A figure that no pyplot window knows of, and the grid.

    Source:
        None (matplotlib, object-oriented interface).
    """
    top = _EDGE + _LINE * (1 + len(lines)) + _ABOVE
    width = _LEFT + columns * panel[0] + (columns - 1) * _BESIDE + _EDGE
    height = top + rows * panel[1] + (rows - 1) * _BETWEEN + _BELOW
    figure = Figure(figsize=(width, height), facecolor="white")
    grid = figure.add_gridspec(
        rows,
        columns,
        left=_LEFT / width,
        right=1 - _EDGE / width,
        top=1 - top / height,
        bottom=_BELOW / height,
        wspace=_BESIDE / panel[0],
        hspace=_BETWEEN / panel[1],
    )
    x, y = _EDGE / width, 1 - _EDGE / height
    figure.suptitle(title, x=x, y=y, ha="left", va="top", fontsize=TITLE_SIZE, color=INK)
    for i, line in enumerate(lines, 1):
        figure.text(x, y - i * _LINE / height, line, ha="left", va="top", fontsize=PANEL_SIZE, color=INK)
    return figure, grid


def style_axes(axes: Axes, title: str, x_label: str, y_label: str) -> None:
    """Give a panel its title, its labels and the common look.

    Args:
        axes: The panel.
        title: What it shows.
        x_label: Quantity and unit of the horizontal axis.
        y_label: Quantity and unit of the vertical axis.

    Source:
        None (reporting).
    """
    axes.set_facecolor("white")
    axes.set_title(title, loc="left", y=1.0, fontsize=PANEL_SIZE, fontweight="bold", color=INK)
    axes.set_xlabel(x_label, fontsize=TEXT_SIZE, color=INK)
    axes.set_ylabel(y_label, fontsize=TEXT_SIZE, color=INK)
    # At fixed distances: to find them by measuring all tick labels takes half of the drawing time.
    inches = axes.figure.dpi_scale_trans
    axes.xaxis.set_label_coords(0.5, 0.0, axes.transAxes + ScaledTranslation(0.0, -_TO_X_LABEL, inches))
    axes.yaxis.set_label_coords(0.0, 0.5, axes.transAxes + ScaledTranslation(-_TO_Y_LABEL, 0.0, inches))
    axes.tick_params(labelsize=TEXT_SIZE, colors=INK, length=3, width=0.6)
    axes.grid(visible=True, color=GRID, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.xaxis.set_major_locator(MaxNLocator(_MOST_TICKS))
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(FAINT)
        spine.set_linewidth(0.6)


def remark(axes: Axes, words: str, colour: str = FAINT) -> None:
    """Write beside the title of a panel, at its right end.

    Args:
        axes: The panel.
        words: The text.
        colour: Its colour.

    Source:
        None (reporting).
    """
    axes.set_title(words, loc="right", y=1.0, fontsize=TEXT_SIZE, color=colour)


def label(axes: Axes, at: Array, words: str, away: Array, colour: str) -> None:
    """Write beside a point, on the side a direction points to, readable on top of lines.

    Args:
        axes: The panel.
        at: The point, shape (2,), in data coordinates.
        words: The text.
        away: Direction from the point to the text, shape (2,); any length.
        colour: Colour of the text.

    Source:
        None (reporting).
    """
    length = float(np.hypot(*away))
    x, y = away / length if length > 0 else np.array([0.7, 0.7])
    axes.annotate(
        words,
        (float(at[0]), float(at[1])),
        xytext=(_LABEL_DISTANCE * x, _LABEL_DISTANCE * y),
        textcoords="offset points",
        ha="left" if x > 0.4 else "right" if x < -0.4 else "center",
        va="bottom" if y > 0.4 else "top" if y < -0.4 else "center",
        fontsize=TEXT_SIZE,
        color=colour,
        zorder=6,
        path_effects=[withStroke(linewidth=3, foreground="white")],
    )


def save_figure(figure: Figure, path: str | os.PathLike[str]) -> Path:
    """Write a figure to a file: `.png`, or `.pdf` or `.svg` with text that stays text.

    Args:
        figure: The figure.
        path: The file; its ending chooses the format.

    Returns:
        The path written.

    Raises:
        MotionFileError: If the ending is another one or the file cannot be written.

    Source:
        None (matplotlib).
    """
    file = Path(path)
    if file.suffix.lower() not in FORMATS:
        raise MotionFileError(f"{file}: cannot draw to {file.suffix!r}: valid are {', '.join(FORMATS)}")
    stamp = {".pdf": "CreationDate", ".svg": "Date"}.get(file.suffix.lower())
    metadata = {stamp: None} if stamp else None
    try:
        with mpl.rc_context(_SAVING):
            figure.savefig(file, dpi=_RESOLUTION_DPI, facecolor="white", metadata=metadata)
    except OSError as error:
        raise MotionFileError(f"{file}: cannot be written: {error.strerror or error}") from None
    return file
