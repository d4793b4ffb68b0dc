"""Names of the joint limits at the edges of the bands, where there is room for them."""

from __future__ import annotations

import itertools
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from armik_sym.arm.limit_words import limit_words
from armik_sym.report.style import INK, LIMIT, TEXT_SIZE
from armik_sym.report.swivel_map_bands import Bands, Strip
from armik_sym.swivel.map_class import SwivelMap

Array = NDArray[np.float64]
Taken = NDArray[np.float64]

# Sizes in inches: a character, a line of text; a cell of the raster, the least edge worth a name.
CHARACTER, TEXT_HEIGHT = 0.061, 0.13
_CELL, _LEAST_EDGE = 0.03, 0.3
# A second name for the same limit only on an edge of this length.
_LONG_EDGE = 2.0
# What it costs to cover things, per cell.
_BAND, _LINE, _TEXT, _SECOND_LINE = 0.35, 2.0, 50.0, 3.0
_TRIES = 31
# Ends of two edges nearer than this belong together.
_JOINED = 0.12
_LEAST_EDGE_DOT = 0.15
# Distances of a text from its edge, and by how much of its half it may stand beyond the end of the edge.
_AWAY, _OVERHANG = np.arange(0.05, 0.36, 0.06), 0.7


@dataclass(frozen=True, eq=False)
class EdgeRun:
    """A stretch of a band's edge that one limit makes.

    Attributes:
        joint: The joint.
        upper: Whether it is its upper limit.
        top: Whether it is the upper edge of the band.
        x: Times, shape (k,), in [inch] from the left of the panel.
        y: Heights, shape (k,), in [inch] from its foot.
    """

    joint: int
    upper: bool
    top: bool
    x: Array
    y: Array

    @property
    def length(self) -> float:
        """Its extent in time, in [inch]."""
        return float(self.x[-1] - self.x[0])


class Raster:
    """A panel as cells: what a text would cover.

    Args:
        size: Width and height of the panel, in [inch].
    """

    def __init__(self, size: tuple[float, float]) -> None:
        self.size = size
        shape = (max(1, int(size[1] / _CELL)), max(1, int(size[0] / _CELL)))
        self.cost: Taken = np.zeros(shape)

    def add_band(self, x: Array, start: Array, end: Array) -> None:
        """Mark a band.

        Args:
            x: Times, increasing, shape (k,), in [inch].
            start: Lower edge, shape (k,), in [inch].
            end: Upper edge, shape (k,), in [inch].

        Source:
            None (drawing).
        """
        rows, columns = self.cost.shape
        at = (np.arange(columns) + 0.5) * _CELL
        inside = (at >= x[0]) & (at <= x[-1])
        low, high = np.interp(at, x, start), np.interp(at, x, end)
        y = ((np.arange(rows) + 0.5) * _CELL)[:, None]
        self.cost += _BAND * ((y >= low) & (y <= high) & inside)

    def add_line(self, x: Array, y: Array) -> None:
        """Mark a line.

        Args:
            x: Times, shape (k,), in [inch].
            y: Heights, shape (k,), in [inch]; NaN where there is no line.

        Source:
            None (drawing).
        """
        rows, columns = self.cost.shape
        seen = np.isfinite(y) & (y >= 0) & (y < self.size[1]) & (x >= 0) & (x < self.size[0])
        for shift in (-1, 0, 1):
            i = np.clip((y[seen] / _CELL).astype(int) + shift, 0, rows - 1)
            j = np.clip((x[seen] / _CELL).astype(int), 0, columns - 1)
            self.cost[i, j] = np.maximum(self.cost[i, j], _LINE)

    def add_text(self, x: float, y: float, half: tuple[float, float]) -> None:
        """Mark a text that is already there.

        Args:
            x: Its middle, in [inch].
            y: Its middle, in [inch].
            half: Half its width and height, in [inch].

        Source:
            None (drawing).
        """
        self._box(x, y, np.array(half))[...] += _TEXT

    def emptiest(self, x: float, half: tuple[float, float]) -> float:
        """The height at which a text covers least.

        Args:
            x: Its middle, in [inch].
            half: Half its width and height, in [inch].

        Returns:
            The height of its middle, in [inch].

        Source:
            None (drawing).
        """
        foot, top = half[1] + 0.05, self.size[1] - half[1] - 0.05
        middle = 0.5 * self.size[1]
        if top <= foot:
            return middle
        tries = np.linspace(foot, top, _TRIES)
        costs = [self._cost(x, float(y), np.array(half)) + 0.5 * abs(y - middle) for y in tries]
        return float(tries[int(np.argmin(costs))])

    def place(self, run: EdgeRun, words: str) -> tuple[float, float, str] | None:
        """The best middle for a text along an edge, which it then occupies.

        Args:
            run: The edge.
            words: The text.

        Returns:
            The middle in [inch] and the text, on two lines if that covers less; None if it would cover
            another text everywhere.

        Source:
            None (drawing).
        """
        best, least = None, _TEXT
        for lines in ([words], textwrap.wrap(words, 2 + (len(words) + 1) // 2)):
            half = 0.5 * np.array([CHARACTER * max(len(line) for line in lines), TEXT_HEIGHT * len(lines)])
            for x, y, extra in self._tries(run, half):
                cost = self._cost(x, y, half) + extra + _SECOND_LINE * (len(lines) - 1)
                if cost < least:
                    best, least, taken = (x, y, "\n".join(lines)), cost, half
        if best is not None:
            self._box(best[0], best[1], taken)[...] += _TEXT
        return best

    def _tries(self, run: EdgeRun, half: Array) -> Iterator[tuple[float, float, float]]:
        """Middles of a text along an edge, and what they cost for being far from its middle."""
        middle, reach = 0.5 * (run.x[0] + run.x[-1]), 0.5 * run.length + _OVERHANG * half[0]
        for at in np.linspace(-1, 1, _TRIES):
            x = float(np.clip(middle + at * reach, half[0], self.size[0] - half[0]))
            edge = run.y[np.abs(run.x - x) <= half[0]]
            if edge.size:
                outer = edge.max() if run.top else edge.min()
                for away in _AWAY:
                    y = outer + (half[1] + away) * (1 if run.top else -1)
                    yield x, float(y), float(4 * away + 1.5 * abs(at))

    def _box(self, x: float, y: float, half: Array) -> Taken:
        rows, columns = self.cost.shape
        i = slice(max(0, int((y - half[1]) / _CELL)), min(rows, int((y + half[1]) / _CELL) + 1))
        j = slice(max(0, int((x - half[0]) / _CELL)), min(columns, int((x + half[0]) / _CELL) + 1))
        return self.cost[i, j]

    def _cost(self, x: float, y: float, half: Array) -> float:
        if y - half[1] < 0 or y + half[1] > self.size[1]:
            return float("inf")
        box = self._box(x, y, half)
        return float(box.max() if box.max() >= _TEXT else box.sum())


def edge_runs(map_: SwivelMap, bands: Bands, size: tuple[float, float]) -> list[EdgeRun]:
    """The edges of all bands, cut where another limit takes over; longest first.

    Args:
        map_: The map.
        bands: The bands drawn.
        size: Width and height of the panel, in [inch].

    Returns:
        The stretches inside the window.

    Source:
        None (drawing).
    """
    rows = sorted({row for strip in bands.strips for row in strip.rows})
    ends = map_.interval_ends(np.array(rows, dtype=np.int64))
    at = {row: i for i, row in enumerate(rows)}
    found = []
    for strip in bands.strips:
        places = [at[row] for row in strip.rows]
        for top, edge in ((False, strip.start), (True, strip.end)):
            limits = [(int(ends.joint[i, int(top)]), bool(ends.upper[i, int(top)])) for i in places]
            found += _runs_of(strip, np.array(edge), limits, top, bands, size)
    return sorted(found, key=lambda run: -run.length)


def _runs_of(
    strip: Strip,
    edge: Array,
    limits: list[tuple[int, bool]],
    top: bool,
    bands: Bands,
    size: tuple[float, float],
) -> list[EdgeRun]:
    x, y = to_inches(bands, bands.time[strip.columns], edge, size)
    shown = (y >= 0) & (y <= size[1])
    keys = [(*limit, bool(seen)) for limit, seen in zip(limits, shown, strict=True)]
    found = []
    for (joint, upper, seen), places in itertools.groupby(range(len(keys)), key=lambda k: keys[k]):
        k = list(places)
        if seen and joint >= 0:
            found.append(EdgeRun(joint, upper, top, x[k], y[k]))
    return found


def to_inches(bands: Bands, time: Array, psi_deg: Array, size: tuple[float, float]) -> tuple[Array, Array]:
    """Data as places on the panel.

    Args:
        bands: The bands, which know the window.
        time: Times, shape (k,), in [s].
        psi_deg: Swivel angles, shape (k,), in [deg].
        size: Width and height of the panel, in [inch].

    Returns:
        Both in [inch] from the lower left corner.

    Source:
        None (drawing).
    """
    x = (time - bands.time[0]) / (bands.time[-1] - bands.time[0]) * size[0]
    return np.asarray(x), np.asarray((psi_deg - bands.low) / (bands.high - bands.low) * size[1])


def mark_changes(axes: Axes, runs: list[EdgeRun], size: tuple[float, float]) -> None:
    """Put a dot on an edge where another limit takes over.

    Args:
        axes: The panel.
        runs: The edges.
        size: Width and height of the panel, in [inch].

    Source:
        None (drawing).
    """
    long = [run for run in runs if run.length > _LEAST_EDGE_DOT]
    ends = {
        top: np.array([(run.x[-1], run.y[-1]) for run in long if run.top == top]) for top in (False, True)
    }
    for run in long:
        before = ends[run.top] - (run.x[0], run.y[0])
        if (np.hypot(*before.T) < _JOINED).any():
            place = (run.x[0] / size[0], run.y[0] / size[1])
            axes.plot(*place, "o", color=LIMIT, markersize=3, transform=axes.transAxes, zorder=3)


def write_edges(axes: Axes, map_: SwivelMap, runs: list[EdgeRun], raster: Raster) -> None:
    """Write the names of the limits beside the edges, each where its edge is longest.

    Args:
        axes: The panel.
        map_: The map.
        runs: The edges.
        raster: What is drawn already.

    Source:
        None (drawing).
    """
    named: set[tuple[int, bool]] = set()
    for run in runs:
        limit = (run.joint, run.upper)
        if run.length < (_LONG_EDGE if limit in named else _LEAST_EDGE):
            continue
        words = limit_words(map_.arm, *limit)
        place = raster.place(run, words)
        if place is None:
            continue
        named.add(limit)
        x, y, text = place
        write(axes, (x / raster.size[0], y / raster.size[1]), text, halo=2.5, zorder=7)


def write(
    axes: Axes, at: tuple[float, float], text: str, *, halo: float, zorder: float, rotation: float = 0
) -> None:
    """Write around a point of a panel, readable on top of bands and lines.

    Args:
        axes: The panel.
        at: The middle of the text, as shares of width and height of the panel.
        text: The text.
        halo: Width of the white outline, in [pt].
        zorder: What it covers.
        rotation: Angle of the text, in [deg].

    Source:
        None (drawing).
    """
    axes.text(
        *at,
        text,
        transform=axes.transAxes,
        rotation=rotation,
        ha="center",
        va="center",
        fontsize=TEXT_SIZE,
        color=INK,
        zorder=zorder,
        path_effects=[withStroke(linewidth=halo, foreground="white")],
    )
