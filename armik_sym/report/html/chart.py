"""A chart of the report: traces and layout for plotly.js, in the look of the figures for print."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.report.style import ALLOWED, FAINT, GRID, INK, LIMIT, MEASURED, SOLVED

if TYPE_CHECKING:
    import plotly.graph_objects as go

Array = NDArray[np.float64]

# A small chart has no room for more samples than this, a wide one not for more than twice that.
MOST_SAMPLES = 300
MARGIN = {"l": 56, "r": 14, "t": 12, "b": 40}
TOP = 0.08

SOLVED_LINE = {"color": SOLVED, "width": 2.6}
MEASURED_LINE = {"color": MEASURED, "width": 2, "dash": "5px,4px"}
# Told apart by their dashes, too: black, purple, green, brown.
OTHER_LINES = (
    {"color": INK, "width": 1.3, "dash": "1px,3px"},
    {"color": "#7A3E9D", "width": 1.6, "dash": "9px,3px,2px,3px"},
    {"color": "#00694E", "width": 1.6, "dash": "3px,3px"},
    {"color": "#8A5A00", "width": 1.6, "dash": "12px,4px"},
)


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart.

    Attributes:
        title: What it shows, as text.
        remark: The number to take away, as text.
        says: What a reader who cannot see it should know.
        figure: Traces and layout of plotly.
        height: In [px].
        timed: Whether its horizontal axis is the time of the motion.
        role: What the page does with it: "" or "map".
    """

    title: str
    remark: str
    says: str
    figure: go.Figure
    height: int = 210
    timed: bool = True
    role: str = ""

    def data(self) -> dict[str, Any]:
        """Traces and layout as the page reads them.

        Returns:
            Plain dictionaries; numbers packed by plotly.

        Source:
            None (plotly).
        """
        packed: dict[str, Any] = json.loads(self.figure.to_json() or "{}")
        return {"data": packed["data"], "layout": packed["layout"], "timed": self.timed, "role": self.role}


def new_chart(traces: Iterable[Any], x_title: str, y_title: str, **axes: Any) -> go.Figure:
    """A figure in the common look.

    Args:
        traces: Traces of plotly, or dictionaries of them.
        x_title: Quantity and unit of the horizontal axis.
        y_title: Quantity and unit of the vertical axis.
        **axes: `xaxis` and `yaxis`, dictionaries with more about them, and further parts of the layout.

    Returns:
        The figure.

    Source:
        None (plotly).
    """
    import plotly.graph_objects as go

    common: dict[str, Any] = {
        "showline": True, "linecolor": FAINT, "linewidth": 0.8, "gridcolor": GRID, "gridwidth": 0.6,
        "zeroline": False, "ticks": "outside", "ticklen": 3, "tickcolor": FAINT, "automargin": False,
    }  # fmt: skip
    titles = {"xaxis": x_title, "yaxis": y_title}
    layout = {
        key: {**common, "title": {"text": titles[key], "standoff": 6}, **axes.pop(key, {})} for key in titles
    }
    return go.Figure(
        data=list(traces),
        layout={
            "template": go.layout.Template(),
            "font": {"family": "system-ui, sans-serif", "size": 12, "color": INK},
            "paper_bgcolor": "white",
            "plot_bgcolor": "white",
            "margin": MARGIN,
            "showlegend": False,
            "hovermode": "x unified",
            "hoverlabel": {"bgcolor": "white", "bordercolor": FAINT, "font": {"color": INK}},
            **layout,
            **axes,
        },
    )


def line(x: ArrayLike, y: ArrayLike, name: str, style: dict[str, Any], unit: str) -> dict[str, Any]:
    """A line over time.

    Args:
        x: Times, shape (n,), in [s].
        y: Values, shape (n,), in `unit`.
        name: What it is; any text.
        style: Colour, width and dash.
        unit: Unit, as shown.

    Returns:
        A trace.

    Source:
        None (plotly).
    """
    return {
        "type": "scatter", "mode": "lines", "x": small(x), "y": small(y), "name": safe(name), "line": style,
        "hovertemplate": f"%{{y:.4~g}} {unit}",
    }  # fmt: skip


def band(lower: float, upper: float) -> list[dict[str, Any]]:
    """A range as a band with its limits as lines, across the chart.

    Args:
        lower: Its lower end, in the unit of the chart.
        upper: Its upper end.

    Returns:
        Shapes.

    Source:
        None (plotly).
    """
    across = {"xref": "paper", "x0": 0, "x1": 1}
    inside = {
        "type": "rect", **across, "y0": lower, "y1": upper, "fillcolor": ALLOWED, "line": {"width": 0},
        "layer": "below",
    }  # fmt: skip
    return [inside, *(limit_line(value, None) for value in (lower, upper))]


def limit_line(value: float, dash: str | None = "6px,3px") -> dict[str, Any]:
    """A limit as a horizontal line.

    Args:
        value: Where, in the unit of the chart.
        dash: Dashes, or None for a solid line.

    Returns:
        A shape.

    Source:
        None (plotly).
    """
    look = {"color": LIMIT, "width": 1, **({"dash": dash} if dash else {})}
    return {
        "type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": value, "y1": value, "line": look,
        "layer": "between",
    }  # fmt: skip


def limit_words(value: float, words: str) -> dict[str, Any]:
    """The name of a limit, above its line at the right.

    Args:
        value: Where, in the unit of the chart.
        words: The name.

    Returns:
        An annotation.

    Source:
        None (plotly).
    """
    return {
        "xref": "paper", "x": 1, "xanchor": "right", "y": value, "yanchor": "bottom", "text": safe(words),
        "showarrow": False, "font": {"size": 11, "color": LIMIT},
    }  # fmt: skip


def style_of(name: str, number: int) -> dict[str, Any]:
    """How a motion is drawn, everywhere in the report.

    Args:
        name: Its name.
        number: How many others came before it.

    Returns:
        Colour, width and dash.

    Source:
        None (reporting).
    """
    return dict(MEASURED_LINE) if name == "measured" else dict(OTHER_LINES[number % len(OTHER_LINES)])


def styles_of(names: Iterable[str]) -> dict[str, dict[str, Any]]:
    """The look of every motion beside the solution.

    Args:
        names: Their names.

    Returns:
        Colour, width and dash by name.

    Source:
        None (reporting).
    """
    found: dict[str, dict[str, Any]] = {}
    for name in names:
        found[name] = style_of(name, sum(key != "measured" for key in found))
    return found


def shown_samples(values: ArrayLike, most: int = MOST_SAMPLES) -> NDArray[np.int64]:
    """Samples that a chart shows: all, or of every stretch the lowest and the highest: peaks stay.

    Args:
        values: What is drawn, shape (n,); NaN where nothing is.
        most: How many samples the chart has room for.

    Returns:
        Indices, shape (k,), the first and the last among them.

    Source:
        None (reporting).
    """
    drawn = np.nan_to_num(np.asarray(values, dtype=np.float64))
    n = len(drawn)
    if n <= most:
        return np.arange(n)
    kept = [0, n - 1]
    for part in np.array_split(np.arange(n), most // 2):
        kept += [int(part[drawn[part].argmin()]), int(part[drawn[part].argmax()])]
    return np.unique(kept)


def small(values: ArrayLike) -> NDArray[np.float32]:
    """Numbers as precise as a screen.

    Args:
        values: Any shape.

    Returns:
        The same in single precision, half the size in the file.

    Source:
        None (plotly packs arrays as they are).
    """
    return np.asarray(values, dtype=np.float32)


def safe(text: str) -> str:
    """Text for plotly, which reads some HTML in it.

    Args:
        text: Any text.

    Returns:
        The text, escaped.

    Source:
        None (plotly, "pseudo-HTML").
    """
    return html.escape(text, quote=False)
