"""One branch of a swivel map: bands tinted by clearance, named edges, lines, and samples without posture."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MultipleLocator
from matplotlib.transforms import blended_transform_factory
from numpy.typing import NDArray

from armik_sym.report.style import FAINT, INK, LIMIT, TEXT_SIZE, remark, style_axes
from armik_sym.report.swivel_map_bands import Bands
from armik_sym.report.swivel_map_guides import elbow_guides
from armik_sym.report.swivel_map_labels import (
    CHARACTER,
    TEXT_HEIGHT,
    Raster,
    edge_runs,
    mark_changes,
    to_inches,
    write,
    write_edges,
)
from armik_sym.swivel.branch_words import ONLY_BRANCH
from armik_sym.swivel.map_class import SwivelMap
from armik_sym.swivel.map_text import missing_words, reasons, runs

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Size = tuple[float, float]

# Clearance from which a tint holds, in [deg], and the tint: darker is safer, in a grey print, too.
TINTS = ((0.0, "#E9F1F8"), (5.0, "#D2E3F0"), (10.0, "#B7D2E6"), (20.0, "#97BEDA"), (30.0, "#78AACE"))

GUIDE_LINE: dict[str, Any] = {"color": FAINT, "linewidth": 0.9, "linestyle": (0, (1, 2.5))}

_GRID = (150, 130)
_IMAGE = (900, 700)
_FAR = 1e3
_WHOLE = 360.0
_TURNS = (0.0, -_WHOLE, _WHOLE)
_STEPS = ((60.0, 10.0), (120.0, 15.0), (240.0, 30.0), (np.inf, 45.0))
# Characters that fit above a panel.
_ONE_LINE = 100
# Labels of guides need this height, labels of gaps this width, in [inch].
_GUIDE_HEIGHT, _GAP_WIDTH, _NARROW = 0.16, 1.0, 0.3
_GAPS_DRAWN, _GAPS_NAMED, _LOOKED_AT = 200, 4, 9
# A guide seen for a smaller share of the time gets no name.
_LEAST_SHARE = 0.2


@dataclass(frozen=True, eq=False)
class Line:
    """A joint trajectory on the map.

    Attributes:
        words: What it is.
        psi_deg: Swivel angle, unwrapped, shape (n,), in [deg].
        branch: Branch of every sample, shape (n,).
        style: How it is drawn.
    """

    words: str
    psi_deg: Array
    branch: Indices
    style: dict[str, Any]


def draw_panel(
    axes: Axes, map_: SwivelMap, branch: int, bands: Bands, lines: list[Line], size: Size, last: bool
) -> None:
    """Draw one branch.

    Args:
        axes: The panel.
        map_: The map.
        branch: The branch.
        bands: Its bands.
        lines: Trajectories; only what runs on this branch is drawn.
        size: Width and height of the panel, in [inch].
        last: Whether it is the lowest panel, which names the time axis.

    Source:
        None (this package).
    """
    title = _title(map_, branch)
    style_axes(axes, title, "time [s]" if last else "", "swivel angle [deg]")
    empty = int(map_.intervals.empty[:, branch].sum())
    words = "a posture at every sample" if not empty else f"no posture at {empty} of {len(map_)} samples"
    if len(title) + len(words) < _ONE_LINE:
        remark(axes, words, FAINT if not empty else INK)
    axes.set_xlim(map_.path.time[0], map_.path.time[-1])
    axes.set_ylim(bands.low, bands.high)
    height = bands.high - bands.low
    axes.yaxis.set_major_locator(MultipleLocator(next(step for most, step in _STEPS if height <= most)))
    raster = Raster(size)
    _draw_bands(axes, map_, branch, bands)
    _draw_edges(axes, bands, raster, size)
    _draw_guides(axes, map_, bands, size)
    for line in lines:
        psi = np.where(line.branch == branch, line.psi_deg, np.nan)
        if np.isfinite(psi).any():
            for turn in _TURNS:
                _draw_line(axes, map_.path.time, psi + turn, line.style, bands)
                raster.add_line(*to_inches(bands, map_.path.time, psi + turn, size))
    _draw_gaps(axes, map_, branch, raster)
    edges = edge_runs(map_, bands, size)
    mark_changes(axes, edges, size)
    write_edges(axes, map_, edges, raster)


def _title(map_: SwivelMap, branch: int) -> str:
    name = map_.branch_names[branch]
    return "All postures in the range of motion" if name == ONLY_BRANCH else f"Postures with {name}"


def _draw_line(axes: Axes, time: Array, psi: Array, style: dict[str, Any], bands: Bands) -> None:
    if not ((psi > bands.low) & (psi < bands.high)).any():
        return
    width = style["linewidth"] + 1.8
    axes.plot(
        time,
        psi,
        **style,
        solid_capstyle="round",
        path_effects=[withStroke(linewidth=width, foreground="white")],
    )


def _draw_bands(axes: Axes, map_: SwivelMap, branch: int, bands: Bands) -> None:
    """The exact bands in the lightest tint, and the darker tints as an image cut out by them."""
    shapes = bands.polygons()
    if not shapes:
        return
    lightest = TINTS[0][1]
    axes.add_collection(
        PolyCollection(shapes, facecolor=lightest, edgecolor=lightest, linewidth=0.3, zorder=0.5),
        autolim=False,
    )
    picture = axes.imshow(
        _tints(map_, branch, bands),
        extent=(bands.time[0], bands.time[-1], bands.low, bands.high),
        origin="lower",
        aspect="auto",
        interpolation="nearest",
        zorder=0.6,
    )
    outline = Path.make_compound_path(*(Path(np.vstack([shape, shape[:1]]), closed=True) for shape in shapes))
    picture.set_clip_path(outline, transform=axes.transData)


def _tints(map_: SwivelMap, branch: int, bands: Bands) -> Array:
    """Colours over time and swivel angle, from clearances on a coarser grid."""
    time = map_.path.time
    columns = np.linspace(time[0], time[-1], min(_GRID[0], len(bands.samples)))
    samples = np.unique(bands.samples[np.abs(bands.time[:, None] - columns).argmin(axis=0)])
    psi = np.linspace(bands.low, bands.high, _GRID[1])
    margin = np.rad2deg(map_.clearance(np.deg2rad(psi), branch, samples).margin)
    margin = np.clip(margin, -TINTS[1][0], TINTS[-1][0] + TINTS[1][0])
    at = np.linspace(time[0], time[-1], _IMAGE[0])
    # Two passes of linear interpolation: over time, then over the swivel angle.
    wide = np.array([np.interp(at, time[samples], margin[:, j]) for j in range(len(psi))])
    rows = np.linspace(bands.low, bands.high, _IMAGE[1])
    fine = np.array([np.interp(rows, psi, wide[:, i]) for i in range(len(at))]).T
    colours = np.array([to_rgb(colour) for _, colour in TINTS])
    return np.asarray(colours[np.clip(np.digitize(fine, [least for least, _ in TINTS]) - 1, 0, None)])


def _draw_edges(axes: Axes, bands: Bands, raster: Raster, size: Size) -> None:
    stroke: dict[str, Any] = {"color": LIMIT, "linewidth": 0.9, "zorder": 2}
    for one, other in bands.links:
        axes.plot([one[0], other[0]], [one[1], other[1]], **stroke)
    for strip in bands.strips:
        time = bands.time[strip.columns]
        start, end = np.array(strip.start), np.array(strip.end)
        there = ~np.array(strip.whole)
        for edge in (start, end):
            axes.plot(time, np.where(there, edge, np.nan), marker="." if len(time) == 1 else None, **stroke)
        for k, cut in ((0, not strip.parents), (-1, not strip.children)):
            inner = strip.columns[k] not in (0, len(bands.samples) - 1)
            if cut and inner and there[k]:
                axes.plot([time[k]] * 2, [start[k], end[k]], **stroke)
        x, low = to_inches(bands, time, start, size)
        raster.add_band(x, low, to_inches(bands, time, end, size)[1])


def _draw_guides(axes: Axes, map_: SwivelMap, bands: Bands, size: Size) -> None:
    """Dotted lines where the elbow is lowest, outermost and so on, named where they end."""
    named = []
    for guide in elbow_guides(map_, bands.samples):
        known = _without_jumps(guide.psi_deg)
        for turn in _TURNS:
            psi = np.where((known + turn > bands.low) & (known + turn < bands.high), known + turn, np.nan)
            seen = np.flatnonzero(np.isfinite(psi))
            if not seen.size:
                continue
            axes.plot(bands.time, psi, **GUIDE_LINE, zorder=1.5)
            if seen[-1] == len(psi) - 1:
                named.append((float(psi[-1]), guide.words))
            elif len(seen) > _LEAST_SHARE * len(psi):
                _name_inside(axes, bands.time[seen[-1]], psi[seen[-1]], guide.words, size)
    _name_at_the_right(axes, sorted(named), bands, size)


def _name_inside(axes: Axes, time: float, psi: float, words: str, size: Size) -> None:
    inches = axes.transLimits.transform((time, psi)) * size
    axes.annotate(
        words,
        (time, psi),
        xytext=(0, -2 if inches[1] > size[1] - 0.3 else 2),
        textcoords="offset points",
        ha="right",
        va="top" if inches[1] > size[1] - 0.3 else "bottom",
        fontsize=TEXT_SIZE,
        color=FAINT,
        zorder=6,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
    )


def _name_at_the_right(axes: Axes, named: list[tuple[float, str]], bands: Bands, size: Size) -> None:
    least = _GUIDE_HEIGHT / size[1] * (bands.high - bands.low)
    place = blended_transform_factory(axes.transAxes, axes.transData)
    top = -np.inf
    for y, words in named:
        top = max(y, top + least)
        axes.annotate(
            words,
            (1.0, y),
            xycoords=place,
            xytext=(1.0 + 0.16 / size[0], top),
            textcoords=place,
            fontsize=TEXT_SIZE,
            color=FAINT,
            va="center",
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": FAINT, "linewidth": 0.7, "shrinkA": 1, "shrinkB": 0},
        )


def _without_jumps(psi_deg: Array) -> Array:
    known = np.isfinite(psi_deg)
    out = psi_deg.copy()
    out[known] = np.rad2deg(np.unwrap(np.deg2rad(psi_deg[known])))
    return out


def _draw_gaps(axes: Axes, map_: SwivelMap, branch: int, raster: Raster) -> None:
    """Samples without a posture on this branch: hatched, and the widest stretches with the reason."""
    time = map_.path.time
    gaps = list(runs(np.flatnonzero(map_.intervals.empty[:, branch])))
    middles = np.concatenate([time[:1], 0.5 * (time[1:] + time[:-1]), time[-1:]])
    spans = [(float(middles[gap[0]]), float(middles[gap[-1] + 1])) for gap in gaps]
    widest = sorted(range(len(gaps)), key=lambda i: spans[i][0] - spans[i][1])
    for i in widest[:_GAPS_DRAWN]:
        axes.axvspan(
            *spans[i], facecolor="#F4F4F4", edgecolor="#C4C4C4", hatch="////", linewidth=0, zorder=0.4
        )
    for i in widest[:_GAPS_NAMED]:
        inches = tuple((t - time[0]) / (time[-1] - time[0]) * raster.size[0] for t in spans[i])
        if inches[1] - inches[0] >= _NARROW:
            looked_at = gaps[i][:: max(1, len(gaps[i]) // _LOOKED_AT)]
            words = missing_words(*max(reasons(map_, looked_at, branch), key=lambda why: why[1]))
            blocked = map_.intervals.empty[gaps[i]].all()
            text = f"{'no posture' if blocked else 'not on this branch'}: {words}"
            _write_in_gap(axes, text, (inches[0], inches[1]), raster)


def _write_in_gap(axes: Axes, text: str, span: tuple[float, float], raster: Raster) -> None:
    """Upright where the gap is narrow; at the height where it covers least."""
    upright = span[1] - span[0] < _GAP_WIDTH
    width = raster.size[1] if upright else span[1] - span[0]
    lines = textwrap.wrap(text, max(12, int(0.92 * width / CHARACTER)))
    half = 0.5 * CHARACTER * max(len(line) for line in lines), 0.5 * TEXT_HEIGHT * len(lines)
    if upright:
        half = half[1], half[0]
    x = 0.5 * sum(span)
    y = raster.emptiest(x, half)
    raster.add_text(x, y, half)
    place = x / raster.size[0], y / raster.size[1]
    write(axes, place, "\n".join(lines), halo=3, zorder=8, rotation=90 if upright else 0)
