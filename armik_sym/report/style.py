"""One look for all figures: colours everyone can tell apart, direct labels, units on every axis.

Colours are those of Okabe and Ito; they differ in lightness too, and line styles repeat what colour
says, so that a grey print stays readable.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

Array = NDArray[np.float64]

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


_TO_X_LABEL, _TO_Y_LABEL = 0.26, 0.46
_MOST_TICKS = 6
_LABEL_DISTANCE = 9.0


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
