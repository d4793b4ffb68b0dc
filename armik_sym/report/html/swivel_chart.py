"""The swivel map as a chart: where the elbow can be over time, on the side where the solved motion bends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.limit_words import limit_words
from armik_sym.report.html.chapter import Chapter
from armik_sym.report.html.chart import (
    MOST_SAMPLES,
    SOLVED_LINE,
    Chart,
    line,
    new_chart,
    safe,
    shown_samples,
    small,
    styles_of,
)
from armik_sym.report.style import FAINT, INK, LIMIT
from armik_sym.report.swivel_map_bands import Bands, bands_of, into_window, window_of
from armik_sym.report.swivel_map_guides import elbow_guides
from armik_sym.report.swivel_map_panel import TINTS
from armik_sym.swivel.map_class import SwivelMap
from armik_sym.swivel.map_text import runs

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_COLUMNS, _STEP = 160, 1.5
_OUTSIDE, _NO_POSTURE = "rgba(255,255,255,0)", "rgba(120,120,120,0.22)"
_MOST_GAPS = 60
_LEAST_EDGE, _MOST_NAMES = 0.14, 8
_NEAR = 14.0
_TURNS = (0.0, -360.0, 360.0)
_MARGIN = {"l": 60, "r": 118, "t": 14, "b": 42}


@dataclass(frozen=True, eq=False)
class _Lines:
    """Motions on the map: swivel angle in the window, NaN where a motion bends to another side."""

    low: float
    high: float
    branch: Indices
    solved: Array
    others: dict[str, Array]
    left_out: tuple[str, ...]


def swivel_chart(chapter: Chapter) -> Chart | None:
    """The swivel map of a chapter; None where there is none.

    Shown is, at every sample, the branch that the solved motion runs on: what the swivel slider of the page
    can reach.

    Args:
        chapter: The chapter.

    Returns:
        The chart.

    Source:
        None (this package).
    """
    map_ = chapter.map
    if map_ is None:
        return None
    lines = _lines(chapter, map_)
    bands = [bands_of(map_, int(b), lines.low, lines.high) for b in np.unique(lines.branch)]
    traces = [_tinted(map_, lines), *_edges(map_, bands, lines), *_guides(map_, lines)]
    styles, time = styles_of(lines.others), map_.path.time
    for name, psi in lines.others.items():
        if np.isfinite(psi).any():
            rows = shown_samples(psi, 2 * MOST_SAMPLES)
            traces.append(line(time[rows], psi[rows], name, styles[name], "°") | {"connectgaps": False})
    rows = shown_samples(lines.solved, 2 * MOST_SAMPLES)
    traces.append(line(time[rows], lines.solved[rows], "solved", SOLVED_LINE, "°"))
    figure = new_chart(
        traces,
        "time [s]",
        "swivel angle of the elbow [deg]",
        xaxis={"range": [float(time[0]), float(time[-1])], "showgrid": False},
        yaxis={"range": [lines.low, lines.high], "dtick": _dtick(lines.high - lines.low), "showgrid": False},
        annotations=[*_edge_names(map_, bands, lines), *_guide_names(map_, lines), *_gap_names(map_, lines)],
        shapes=_gaps(map_),
        margin=_MARGIN,
        hovermode="closest",
    )
    width = float(np.rad2deg(map_.width[np.arange(len(map_)), lines.branch].min()))
    remark = f"at least {width:.0f}° free at every instant" if width > 0 else "no posture at some instants"
    if lines.left_out:
        remark += f"; drawn in part, because bent to another side: {', '.join(lines.left_out)}"
    says = f"Where the elbow can be over time: {remark}."
    return Chart("Where the elbow can be", remark, says, figure, 400, role="map")


def _lines(chapter: Chapter, map_: SwivelMap) -> _Lines:
    solved = map_.swivel_of(chapter.solution)
    psi_deg = np.rad2deg(solved.psi)
    found, left_out = {}, []
    for name, q in chapter.motions.items():
        at = map_.swivel_of(q)
        same = at.branch == solved.branch
        found[name] = np.where(same, np.rad2deg(at.psi), np.nan)
        left_out += [] if same.all() else [name]
    low, high = window_of(map_, [int(b) for b in np.unique(solved.branch)], [psi_deg])
    inside = {name: _into(psi, low, high) for name, psi in found.items()}
    return _Lines(low, high, solved.branch, into_window(psi_deg, low, high), inside, tuple(left_out))


def _into(psi_deg: Array, low: float, high: float) -> Array:
    """A line that has holes, in the window; cut where it leaves at one side and comes back at the other."""
    wrapped = low + np.mod(psi_deg - low, 360.0)
    wrapped[wrapped > high] = np.nan
    jumps = np.abs(np.diff(wrapped, prepend=wrapped[:1])) > 180.0
    return np.where(jumps, np.nan, wrapped)


def _tinted(map_: SwivelMap, lines: _Lines) -> dict[str, Any]:
    """Room to the nearest limit in classes, as a coloured grid."""
    rows = np.unique(np.linspace(0, len(map_) - 1, min(_COLUMNS, len(map_))).round().astype(np.int64))
    psi = np.arange(lines.low, lines.high + _STEP, _STEP)
    classes = np.full((len(psi), len(rows)), -1, dtype=np.int8)
    for branch in np.unique(lines.branch):
        here = np.flatnonzero(lines.branch[rows] == branch)
        margin = np.rad2deg(map_.clearance(np.deg2rad(psi), int(branch), rows[here]).margin)
        classes[:, here] = (np.digitize(margin, [least for least, _ in TINTS]) - 1).T.astype(np.int8)
    colours = [_OUTSIDE, *(colour for _, colour in TINTS)]
    scale = [(end / len(colours), colour) for i, colour in enumerate(colours) for end in (i, i + 1)]
    return {
        "type": "heatmap", "x": small(map_.path.time[rows]), "y": small(psi), "z": classes, "zmin": -1.5,
        "zmax": len(TINTS) - 0.5, "colorscale": scale, "showscale": False, "hoverinfo": "none",
        "zsmooth": False,
    }  # fmt: skip


def _stretches(bands: list[Bands], lines: _Lines) -> Iterator[tuple[Array, Array, Indices, bool]]:
    """Edges of all bands: times, heights (NaN off the motion's branch), intervals, whether at the top."""
    for one, branch in zip(bands, np.unique(lines.branch), strict=True):
        for strip in one.strips:
            mine = (lines.branch[one.samples[strip.columns]] == branch) & ~np.array(strip.whole)
            rows = np.array(strip.rows)
            for edge, top in ((strip.start, False), (strip.end, True)):
                y = np.where(mine, np.array(edge), np.nan)
                if np.isfinite(y).any():
                    yield one.time[strip.columns], y, rows, top


def _edges(map_: SwivelMap, bands: list[Bands], lines: _Lines) -> list[dict[str, Any]]:
    """All edges, one trace with gaps for each limit."""
    found: dict[tuple[int, bool], tuple[list[float], list[float]]] = {}
    for time, height, rows, top in _stretches(bands, lines):
        ends = map_.interval_ends(rows)
        joints, uppers = ends.joint[:, int(top)], ends.upper[:, int(top)]
        for key in {(int(j), bool(u)) for j, u in zip(joints, uppers, strict=True)}:
            x, y = found.setdefault(key, ([], []))
            mine = (joints == key[0]) & (uppers == key[1])
            mine[1:] |= mine[:-1].copy()  # up to the point where another limit takes over
            x += [*np.where(mine, time, np.nan), np.nan]
            y += [*np.where(mine, height, np.nan), np.nan]
    drawn = []
    for (joint, upper), (x, y) in found.items():
        here = np.isfinite(y)
        kept = here | np.concatenate([[False], here[:-1]])
        name = safe(limit_words(map_.arm, joint, upper)) if joint >= 0 else ""
        drawn.append(
            {
                "type": "scatter", "mode": "lines", "x": small(x)[kept], "y": small(y)[kept], "name": name,
                "line": {"color": LIMIT, "width": 1}, "hovertemplate": f"{name}<extra></extra>",
            }
        )  # fmt: skip
    return drawn


def _edge_names(map_: SwivelMap, bands: list[Bands], lines: _Lines) -> list[dict[str, Any]]:
    """Names of the limits along the longest stretches of the edges."""
    time, found = map_.path.time, []
    for t, y, rows, top in _stretches(bands, lines):
        ends = map_.interval_ends(rows)
        key = np.column_stack([ends.joint[:, int(top)], ends.upper[:, int(top)], ~np.isfinite(y)])
        cuts = np.flatnonzero((np.diff(key, axis=0) != 0).any(axis=1)) + 1
        for part in np.split(np.arange(len(t)), cuts):
            share = float(t[part[-1]] - t[part[0]]) / map_.path.duration
            if share >= _LEAST_EDGE and np.isfinite(y[part]).all() and ends.joint[part[0], int(top)] >= 0:
                k = part[len(part) // 2]
                limit = limit_words(map_.arm, int(ends.joint[k, int(top)]), bool(ends.upper[k, int(top)]))
                found.append((share, float(t[k]), float(y[k]), top, limit))
    placed: list[dict[str, Any]] = []
    for _, x, y_at, top, words in sorted(found, key=lambda one: -one[0])[:_MOST_NAMES]:
        near = any(
            abs(x - p["x"]) < 0.3 * (time[-1] - time[0]) and abs(y_at - p["y"]) < _NEAR for p in placed
        )
        if not near and lines.low + 4 < y_at < lines.high - 4:
            placed.append(
                {
                    "x": x, "y": y_at, "text": safe(words), "showarrow": False, "yshift": 9 if top else -9,
                    "font": {"size": 11, "color": INK}, "bgcolor": "rgba(255,255,255,0.75)", "borderpad": 0,
                }
            )  # fmt: skip
    return placed


def _guides(map_: SwivelMap, lines: _Lines) -> list[dict[str, Any]]:
    rows = shown_samples(np.arange(len(map_)))
    style = {"color": FAINT, "width": 1, "dash": "1px,4px"}
    drawn = []
    for guide in elbow_guides(map_, rows):
        for turn in _TURNS:
            psi = np.where(
                (guide.psi_deg + turn > lines.low) & (guide.psi_deg + turn < lines.high),
                guide.psi_deg + turn,
                np.nan,
            )
            jumps = np.abs(np.diff(psi, prepend=psi[:1])) > 90.0
            if np.isfinite(psi).any():
                drawn.append(
                    line(map_.path.time[rows], np.where(jumps, np.nan, psi), guide.words, style, "°")
                )
    return drawn


def _guide_names(map_: SwivelMap, lines: _Lines) -> list[dict[str, Any]]:
    """Where the elbow points, in words, at the right end of the dotted lines."""
    names = []
    for guide in elbow_guides(map_, np.array([len(map_) - 1])):
        for turn in _TURNS:
            y = float(guide.psi_deg[0]) + turn
            if lines.low < y < lines.high:
                names.append((y, guide.words))
    least = 0.045 * (lines.high - lines.low)
    placed, top = [], -np.inf
    for y, words in sorted(names):
        top = max(y, top + least)
        placed.append(
            {
                "xref": "paper", "x": 1.008, "xanchor": "left", "y": top, "text": safe(words),
                "showarrow": False, "font": {"size": 11, "color": FAINT},
            }
        )  # fmt: skip
    return placed


def _gap_ends(map_: SwivelMap) -> list[tuple[float, float]]:
    """Stretches of time without any posture."""
    time = map_.path.time
    middles = np.concatenate([time[:1], 0.5 * (time[1:] + time[:-1]), time[-1:]])
    return [(float(middles[gap[0]]), float(middles[gap[-1] + 1])) for gap in runs(map_.blocked)]


def _gaps(map_: SwivelMap) -> list[dict[str, Any]]:
    return [
        {
            "type": "rect", "x0": start, "x1": end, "yref": "paper", "y0": 0, "y1": 1,
            "fillcolor": _NO_POSTURE, "line": {"width": 0}, "layer": "between",
        }
        for start, end in _gap_ends(map_)[:_MOST_GAPS]
    ]  # fmt: skip


def _gap_names(map_: SwivelMap, lines: _Lines) -> list[dict[str, Any]]:
    """What the widest gap is."""
    widest = max(_gap_ends(map_), key=lambda gap: gap[1] - gap[0], default=None)
    if widest is None or widest[1] - widest[0] < _LEAST_EDGE * map_.path.duration:
        return []
    low = lines.low + 0.06 * (lines.high - lines.low)
    return [{"x": 0.5 * sum(widest), "y": low, "text": "no posture here", "showarrow": False}]


def _dtick(height: float) -> float:
    return next(
        step for most, step in ((60.0, 10.0), (120.0, 20.0), (240.0, 30.0), (np.inf, 45.0)) if height <= most
    )
