"""The swivel map on one page: where the elbow can be over time, and where it goes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from armik_sym.report.page import EDGE, headed_page
from armik_sym.report.style import INK, LIMIT, MEASURED, SOLVED, TEXT_SIZE
from armik_sym.report.swivel_map_bands import bands_of, into_window, window_of
from armik_sym.report.swivel_map_panel import GUIDE_LINE, TINTS, Line, draw_panel
from armik_sym.swivel.map_class import SwivelMap

Indices = NDArray[np.int64]

# All in inches: a panel when alone and when there are several, and what is around them.
_WIDTH, _ALONE, _ONE_OF_SEVERAL = 7.6, 3.7, 2.6
_LEFT, _RIGHT, _ABOVE, _BETWEEN, _BELOW, _KEY = 0.72, 1.3, 0.3, 0.42, 0.5, 0.5
_LINE = 0.21
_MOST_PANELS = 3
# Characters of a title that fit on a line.
_ONE_LINE = 95

_WHAT = (
    "With the hand where it has to be, the elbow can still swing about the line from shoulder to wrist: the "
    "swivel angle tells",
    "where it is. Shaded: every joint is inside its range of motion; the darker, the farther from any limit.",
)
_OTHERS: tuple[dict[str, Any], ...] = (
    {"color": INK, "linestyle": (0, (5, 2))},
    {"color": "#7A3E9D", "linestyle": (0, (5, 1.5, 1, 1.5))},
    {"color": "#00694E", "linestyle": (0, (2, 1.2))},
    {"color": "#8A5A00", "linestyle": (0, (8, 2, 1, 2, 1, 2))},
)


def swivel_map_figure(
    map_: SwivelMap,
    solution: Any = None,
    compare: Mapping[str, Any] | None = None,
    *,
    branch: int | Sequence[int] | None = None,
    title: str | None = None,
    note: str | None = None,
) -> Figure:
    """Draw a swivel map: time to the right, swivel angle up, one panel per branch.

    Args:
        map_: The map.
        solution: A `Solution`, or joint angles, shape (n, dof), in [rad], as a strong line.
        compare: More of them by name, as thin lines; "measured" looks as in the figures of joint angles.
        branch: Branches to draw; those the lines run on if left out, three at the most, or the widest.
        title: What the motion is.
        note: Where the data come from; None takes the note of the path.

    Returns:
        A figure; time in [s], swivel angle in [deg].

    Raises:
        ShapeError: If joint angles do not fit.

    Source:
        None (this package).
    """
    lines = _lines(map_, solution, compare or {})
    branches = [branch] if isinstance(branch, int) else list(branch) if branch else _branches(map_, lines)
    low, high = window_of(map_, branches, [line.psi_deg for line in lines])
    lines = [
        Line(line.words, into_window(line.psi_deg, low, high), line.branch, line.style) for line in lines
    ]
    head = [*([map_.path.note if note is None else note] if (note or map_.path.note) else []), *_WHAT]
    height = _ALONE if len(branches) == 1 else _ONE_OF_SEVERAL
    heading = [f"{title}: swivel map" if title else "Swivel map", _facts(map_)]
    if len(": ".join(heading)) <= _ONE_LINE:
        heading = [", ".join(heading) if title else ": ".join(heading)]
    figure, tops = _page(heading[0], [*heading[1:], *head], len(branches), height)
    for i, (one, top) in enumerate(zip(branches, tops, strict=True)):
        width_page, height_page = figure.get_size_inches()
        axes = figure.add_axes(
            (_LEFT / width_page, (top - height) / height_page, _WIDTH / width_page, height / height_page)
        )
        bands = bands_of(map_, one, low, high)
        draw_panel(axes, map_, one, bands, lines, (_WIDTH, height), last=i == len(branches) - 1)
    _draw_key(figure, lines)
    return figure


def _facts(map_: SwivelMap) -> str:
    facts = f"arm {map_.arm.name}, {len(map_)} samples"
    if len(map_.blocked):
        facts += f", {len(map_.blocked)} of them without any posture"
    return facts


def _lines(map_: SwivelMap, solution: Any, compare: Mapping[str, Any]) -> list[Line]:
    lines, styles = [], iter(_OTHERS * (1 + len(compare) // len(_OTHERS)))
    for name, motion in compare.items():
        at = map_.swivel_of(motion)
        measured = name.lower() == "measured"
        style = {"color": MEASURED, "linestyle": (0, (3, 2))} if measured else next(styles)
        psi = np.rad2deg(at.psi)
        lines.append(Line(name, psi, at.branch, {**style, "linewidth": 1.4, "zorder": 3}))
    if solution is not None:
        at = map_.swivel_of(solution)
        name = (
            f"solved ({solution.method})" if isinstance(getattr(solution, "method", None), str) else "solved"
        )
        strong = {"color": SOLVED, "linewidth": 2.6, "zorder": 4}
        lines.append(Line(name, np.rad2deg(at.psi), at.branch, strong))
    return lines


def _branches(map_: SwivelMap, lines: list[Line]) -> list[int]:
    """The branches most of the lines run on; without lines the one with the widest bands."""
    if not lines:
        return [int(map_.width.sum(axis=0).argmax())]
    count = sum(np.bincount(line.branch, minlength=len(map_.branches)) for line in lines)
    used = np.argsort(-np.asarray(count), kind="stable")[:_MOST_PANELS]
    return sorted(int(b) for b in used if np.asarray(count)[b])


def _page(title: str, head: list[str], panels: int, height: float) -> tuple[Figure, list[float]]:
    """A white page with its head, and the height of each panel's top above the foot, in [inch]."""
    above = EDGE + _LINE * (1 + len(head)) + _ABOVE
    tall = above + panels * height + (panels - 1) * _BETWEEN + _BELOW + _KEY
    figure = headed_page(title, head, (_LEFT + _WIDTH + _RIGHT, tall), _LINE)
    return figure, [tall - above - i * (height + _BETWEEN) for i in range(panels)]


def _draw_key(figure: Figure, lines: list[Line]) -> None:
    """What lines and tints mean, below the panels."""
    wide, tall = figure.get_size_inches()
    axes = figure.add_axes((_LEFT / wide, 0.06 / tall, (_WIDTH + _RIGHT - EDGE) / wide, _KEY / tall))
    axes.set_axis_off()
    look: dict[str, Any] = {
        "frameon": False, "fontsize": TEXT_SIZE, "labelcolor": INK, "borderaxespad": 0, "handletextpad": 0.5,
        "columnspacing": 1.3,
    }  # fmt: skip
    words = [f"{TINTS[i][0]:g}-{TINTS[i + 1][0]:g}°" for i in range(len(TINTS) - 1)] + [
        f"over {TINTS[-1][0]:g}°"
    ]
    tints = [
        Patch(facecolor=colour, edgecolor=LIMIT, linewidth=0.4, label=text)
        for (_, colour), text in zip(TINTS, words, strict=True)
    ]
    axes.text(0, 0.2, "Room to the nearest limit:", fontsize=TEXT_SIZE, color=INK, va="center")
    first = axes.legend(
        handles=tints, loc="center left", bbox_to_anchor=(0.19, 0.2), ncols=len(tints), **look
    )
    axes.add_artist(first)
    handles = [
        Line2D([], [], **{k: v for k, v in line.style.items() if k != "zorder"}, label=line.words)
        for line in reversed(lines)
    ]
    handles.append(Line2D([], [], **GUIDE_LINE, label="where the elbow points"))
    axes.legend(handles=handles, loc="center left", bbox_to_anchor=(0, 0.72), ncols=5, handlelength=3, **look)
