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
from matplotlib.patheffects import withStroke
from matplotlib.text import Text
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError

Array = NDArray[np.float64]

SOLVED = "#0072B2"
MEASURED = "#D55E00"
ALLOWED = "#E8F1F8"
LIMIT = "#444444"
INK = "#1A1A1A"
FAINT = "#707070"
GRID = "#D9D9D9"

TITLE_SIZE = 11.5
PANEL_SIZE = 9.5
TEXT_SIZE = 8.5

FORMATS = (".pdf", ".png", ".svg")

_RESOLUTION_DPI = 150
_LABEL_DISTANCE = 9.0
# Text in vector files stays text; the same figure gives the same file.
_SAVING: dict[Any, Any] = {"pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "armik_sym"}


def new_figure(width: float, height: float) -> Figure:
    """An empty white figure that lays itself out.

    Args:
        width: Width, in [inch].
        height: Height, in [inch].

    Returns:
        A figure that no pyplot window knows of.

    Source:
        None (matplotlib, object-oriented interface).
    """
    return Figure(figsize=(width, height), facecolor="white", layout="constrained")


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
    axes.set_title(title, loc="left", fontsize=PANEL_SIZE, fontweight="bold", color=INK)
    axes.set_xlabel(x_label, fontsize=TEXT_SIZE, color=INK)
    axes.set_ylabel(y_label, fontsize=TEXT_SIZE, color=INK)
    axes.tick_params(labelsize=TEXT_SIZE, colors=INK, length=3, width=0.6)
    axes.grid(visible=True, color=GRID, linewidth=0.5)
    axes.set_axisbelow(True)
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(FAINT)
        spine.set_linewidth(0.6)


def head(figure: Figure, title: str, *, note: str | None, warning: str | None = None) -> None:
    """Write the head of a figure: title, then in smaller print what the reader has to know.

    Args:
        figure: The figure.
        title: The title.
        note: Where the data come from, for example "synthetic"; None if there is nothing to say.
        warning: What is wrong with what is shown, or None.

    Source:
        None (reporting).
    """
    lines = [title, *(line for line in (note, warning) if line)]
    text: Text = figure.suptitle("\n".join(lines), x=0.01, ha="left", fontsize=TITLE_SIZE, color=INK)
    text.set_color(MEASURED if warning else INK)


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
