"""The feasible bands of a swivel map as shapes: intervals of neighbouring samples joined, in degrees."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.map_class import SwivelMap

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# More columns than this cannot be told apart in print.
_MOST_COLUMNS = 600
_BINS = 720
_MOST_COUNTED = 4000
_WHOLE = 360.0
_BIN = _WHOLE / _BINS
_MIDDLES = -180.0 + (np.arange(_BINS) + 0.5) * _BIN
# Room above and below what is drawn, as a share of its height and at least, in [deg].
_ROOM, _LEAST_ROOM = 0.1, 6.0

Corner = tuple[float, float]


@dataclass
class Strip:
    """One band between the sample where it appears and the one where it ends or splits.

    Attributes:
        columns: Places in `Bands.samples`, consecutive.
        rows: Rows of `SwivelMap.intervals`.
        start: Lower edge, in [deg].
        end: Upper edge, in [deg].
        whole: Whether the band is the whole circle there, without edges.
        parents: Whether it continues something at the left.
        children: Whether something continues it at the right.
    """

    columns: list[int] = field(default_factory=list)
    rows: list[int] = field(default_factory=list)
    start: list[float] = field(default_factory=list)
    end: list[float] = field(default_factory=list)
    whole: list[bool] = field(default_factory=list)
    parents: bool = False
    children: bool = False

    def add(self, column: int, row: int, start: float, end: float, whole: bool) -> None:
        """Continue the strip by one sample.

        Args:
            column: The column.
            row: The interval.
            start: Lower edge, in [deg].
            end: Upper edge, in [deg].
            whole: Whether it is the whole circle.

        Source:
            None (bookkeeping).
        """
        self.columns.append(column)
        self.rows.append(row)
        self.start.append(start)
        self.end.append(end)
        self.whole.append(whole)


@dataclass(frozen=True, eq=False)
class Bands:
    """The bands of one branch in a window.

    Attributes:
        samples: The samples drawn, shape (m,).
        time: Their times, shape (m,), in [s].
        strips: The bands.
        bridges: Polygons that join strips where a band splits or two meet, shape (corners, 2) each.
        links: Edges that are missing there, as pairs of points.
        low: Foot of the window, in [deg].
        high: Top of the window, in [deg].
    """

    samples: Indices
    time: Array
    strips: list[Strip]
    bridges: list[Array]
    links: list[tuple[Corner, Corner]]
    low: float
    high: float

    def polygons(self) -> list[Array]:
        """Outlines of everything feasible, shape (corners, 2) each, in [s] and [deg]."""
        half = 0.5 * float(np.diff(self.time).min(initial=np.inf)) if len(self.time) > 1 else 0.5
        shapes = []
        for strip in self.strips:
            t = self.time[strip.columns]
            if len(t) == 1:  # a sample alone is as wide as a sample
                t = np.array([t[0] - half, t[0] + half])
            start, end = (np.resize(np.array(edge), len(t)) for edge in (strip.start, strip.end))
            shapes.append(np.column_stack([np.concatenate([t, t[::-1]]), np.concatenate([start, end[::-1]])]))
        return [*shapes, *self.bridges]


def drawn_samples(map_: SwivelMap, branch: int) -> Indices:
    """The samples to draw: all, or evenly spaced ones and those where the branch begins or ends.

    Args:
        map_: The map.
        branch: The branch.

    Returns:
        Increasing indices.

    Source:
        None (drawing).
    """
    n = len(map_)
    if n <= _MOST_COLUMNS:
        return np.arange(n)
    time = map_.path.time
    even = np.searchsorted(time, np.linspace(time[0], time[-1], _MOST_COLUMNS))
    changes = np.flatnonzero(np.diff(map_.intervals.empty[:, branch]))
    changes = changes[:: max(1, len(changes) // _MOST_COLUMNS)]
    return np.unique(np.concatenate([np.minimum(even, n - 1), changes, changes + 1]))


def window_of(map_: SwivelMap, branches: Sequence[int], lines_deg: Sequence[Array]) -> tuple[float, float]:
    """Swivel angles to show, cut where least is cut apart.

    The circle is cut inside the longest stretch that the fewest samples can use, and never through a line:
    a line that goes around more than once gets a window of more than a turn.

    Args:
        map_: The map.
        branches: The branches that are drawn.
        lines_deg: Swivel angles of the lines, unwrapped, in [deg]; the most important last.

    Returns:
        Foot and top, in [deg].

    Source:
        None (drawing).
    """
    count = _usable(map_, branches)
    low, high = -180.0, 180.0
    if lines_deg:
        base = float(np.median(lines_deg[-1]))
        moved = [into_window(line, base - 180.0, base + 180.0) for line in lines_deg]
        least, most = (float(f([f(line) for line in moved])) for f in (np.min, np.max))
        low, high = least - _LEAST_ROOM, most + _LEAST_ROOM
        if high - low >= _WHOLE:
            return _centred(low, high)
        count[_bins_between(low, high)] = np.inf
    if np.isfinite(count).any() and count[np.isfinite(count)].max() + bool(lines_deg) > 0:
        first, length = _longest_run(count <= count.min())
        low = -180.0 + first * _BIN
        # Where nothing is, nothing has to be shown; otherwise cut in the middle.
        low, width = (low + length * _BIN, _WHOLE - length * _BIN) if count.min() == 0 else (
            low + 0.5 * length * _BIN, _WHOLE
        )  # fmt: skip
        room = min(max(_ROOM * width, _LEAST_ROOM), 0.5 * (_WHOLE - width))
        low, high = low - room, low + width + room
    return _centred(low, high)


def _usable(map_: SwivelMap, branches: Sequence[int]) -> Array:
    """How many intervals contain each bin of swivel angles."""
    intervals = map_.intervals
    rows = np.flatnonzero(np.isin(intervals.branch, branches))
    rows = rows[:: max(1, len(rows) // _MOST_COUNTED)]
    start, end = np.rad2deg(intervals.start[rows]), np.rad2deg(intervals.end[rows])
    return np.array(
        [np.count_nonzero(np.mod(at - start, _WHOLE) <= end - start) for at in _MIDDLES], dtype=float
    )


def _bins_between(low: float, high: float) -> NDArray[np.bool_]:
    return np.asarray(np.mod(_MIDDLES - low, _WHOLE) <= high - low)


def _centred(low: float, high: float) -> tuple[float, float]:
    turns = float(_WHOLE * np.round(0.5 * (low + high) / _WHOLE))
    return low - turns, high - turns


def into_window(line_deg: Array, low: float, high: float) -> Array:
    """A line moved by whole turns so that most of it is in a window.

    Args:
        line_deg: Swivel angles, unwrapped, shape (n,), in [deg].
        low: Foot of the window, in [deg].
        high: Top of the window, in [deg].

    Returns:
        The same line, moved.

    Source:
        None (drawing).
    """
    return np.asarray(line_deg + _WHOLE * np.round((0.5 * (low + high) - np.median(line_deg)) / _WHOLE))


def bands_of(map_: SwivelMap, branch: int, low: float, high: float) -> Bands:
    """Join the intervals of neighbouring samples that overlap.

    Args:
        map_: The map.
        branch: The branch.
        low: Foot of the window, in [deg].
        high: Top of the window, in [deg].

    Returns:
        The bands.

    Source:
        None (drawing).
    """
    samples = drawn_samples(map_, branch)
    time = map_.path.time[samples]
    bands = Bands(samples, time, [], [], [], low, high)
    open_: list[Strip] = []
    for column, pieces in enumerate(_pieces(map_, branch, samples, low, high)):
        following: list[Strip] = []
        for parents, children in _families(open_, pieces):
            if len(parents) == len(children) == 1:
                heirs = parents
            else:
                heirs = [Strip(parents=bool(parents)) for _ in children]
                bands.strips.extend(heirs)
                if parents and children:
                    _join(bands, time[column - 1 : column + 1], parents, children)
            for strip, piece in zip(heirs, children, strict=True):
                strip.add(column, *piece)
            following += heirs
        open_ = following
    return bands


Piece = tuple[int, float, float, bool]


def _pieces(map_: SwivelMap, branch: int, samples: Indices, low: float, high: float) -> list[list[Piece]]:
    """For every column its intervals, moved by turns to wherever they show in the window."""
    intervals = map_.intervals
    rows = np.flatnonzero(intervals.branch == branch)
    first = np.searchsorted(intervals.sample[rows], samples)
    last = np.searchsorted(intervals.sample[rows], samples, side="right")
    found = []
    for a, b in zip(first, last, strict=True):
        mine: list[Piece] = []
        for row in rows[a:b]:
            start, end = (float(np.rad2deg(edge[row])) for edge in (intervals.start, intervals.end))
            if intervals.start[row] == -np.pi and intervals.end[row] == np.pi:
                mine.append((int(row), low - _WHOLE, high + _WHOLE, True))
                continue
            turns = range(int(np.ceil((low - end) / _WHOLE)), int(np.floor((high - start) / _WHOLE)) + 1)
            mine += [(int(row), start + _WHOLE * k, end + _WHOLE * k, False) for k in turns]
        found.append(mine)
    return found


def _families(strips: list[Strip], pieces: list[Piece]) -> list[tuple[list[Strip], list[Piece]]]:
    """Strips and the intervals of the next sample in groups that overlap each other, from below."""
    left = [(strip.start[-1], strip.end[-1]) for strip in strips]
    both = sorted(
        [(*edges, 0, i) for i, edges in enumerate(left)] + [(p[1], p[2], 1, i) for i, p in enumerate(pieces)]
    )
    families: list[tuple[list[Strip], list[Piece]]] = []
    top = -np.inf
    for start, end, kind, i in both:
        if start > top:
            families.append(([], []))
        if kind:
            families[-1][1].append(pieces[i])
        else:
            families[-1][0].append(strips[i])
        top = max(top, end)
    return families


def _join(bands: Bands, time: Array, parents: list[Strip], children: list[Piece]) -> None:
    """Fill and outline the place where a band splits or bands meet."""
    t0, t1 = (float(t) for t in time)
    left = [(strip.start[-1], strip.end[-1]) for strip in parents]
    right = [(start, end) for _, start, end, _ in children]
    (low0, high0), (low1, high1) = ((edges[0][0], max(top for _, top in edges)) for edges in (left, right))
    bands.bridges.append(np.array([(t0, low0), (t1, low1), (t1, high1), (t0, high0)]))
    bands.links.extend([((t0, low0), (t1, low1)), ((t0, high0), (t1, high1))])
    for t, edges in ((t0, left), (t1, right)):
        bands.links.extend(((t, below[1]), (t, above[0])) for below, above in itertools.pairwise(edges))
    for strip in parents:
        strip.children = True


def _longest_run(mask: NDArray[np.bool_]) -> tuple[int, int]:
    """First place and length of the longest run of True on a circle."""
    if mask.all():
        return 0, 0
    begin = int(np.argmin(mask))
    turned = np.concatenate([np.roll(mask, -begin), [False]])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], turned]).astype(np.int8)))
    starts, ends = edges[::2], edges[1::2]
    k = int(np.argmax(ends - starts))
    return (int(starts[k]) + begin) % len(mask), int(ends[k] - starts[k])
