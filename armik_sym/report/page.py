"""A figure as a page: its size, its head, its panels, and its way into a file."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec

from armik_sym.errors import MotionFileError
from armik_sym.report.style import INK, PANEL_SIZE, TITLE_SIZE

Size = tuple[float, float]

FORMATS = (".pdf", ".png", ".svg")

_RESOLUTION_DPI = 150
# Text in vector files stays text; the same figure gives the same file.
_SAVING: dict[Any, Any] = {"pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "armik_sym"}
# Margins in inches: of the page, of a line of the head, and around panels for their labels.
EDGE, _LINE = 0.15, 0.22
_LEFT, _ABOVE, _BELOW, _BESIDE, _BETWEEN = 0.7, 0.3, 0.5, 0.75, 0.75


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
    top = EDGE + _LINE * (1 + len(lines)) + _ABOVE
    width = _LEFT + columns * panel[0] + (columns - 1) * _BESIDE + EDGE
    height = top + rows * panel[1] + (rows - 1) * _BETWEEN + _BELOW
    figure = headed_page(title, lines, (width, height), _LINE)
    grid = figure.add_gridspec(
        rows,
        columns,
        left=_LEFT / width,
        right=1 - EDGE / width,
        top=1 - top / height,
        bottom=_BELOW / height,
        wspace=_BESIDE / panel[0],
        hspace=_BETWEEN / panel[1],
    )
    return figure, grid


def headed_page(title: str, lines: list[str], size: Size, line_height: float) -> Figure:
    """A white figure with a head and nothing below it.

    Args:
        title: First line of the head.
        lines: Lines below it.
        size: Width and height of the page, in [inch].
        line_height: From line to line, in [inch].

    Returns:
        A figure that no pyplot window knows of.

    Source:
        None (matplotlib, object-oriented interface).
    """
    width, height = size
    figure = Figure(figsize=size, facecolor="white")
    x, y = EDGE / width, 1 - EDGE / height
    figure.suptitle(title, x=x, y=y, ha="left", va="top", fontsize=TITLE_SIZE, color=INK)
    for i, line in enumerate(lines, 1):
        below = i * line_height / height
        figure.text(x, y - below, line, ha="left", va="top", fontsize=PANEL_SIZE, color=INK)
    return figure


def _packing(ending: str) -> dict[str, Any]:
    """PNG packed lightly: hardly larger, and a good part of the time a figure takes is saved."""
    how = {".png": {"compress_level": 1}, ".webp": {"lossless": True}}
    return {"pil_kwargs": how[ending]} if ending in how else {}


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
    try:
        _write(figure, file, file.suffix.lower())
    except OSError as error:
        raise MotionFileError(f"{file}: cannot be written: {error.strerror or error}") from None
    return file


def figure_bytes(figure: Figure, ending: str) -> bytes:
    """A figure as the bytes of a file.

    Args:
        figure: The figure.
        ending: ".pdf", ".png", ".svg" or ".webp".

    Returns:
        The bytes; the same figure gives the same bytes.

    Source:
        None (matplotlib).
    """
    buffer = io.BytesIO()
    _write(figure, buffer, ending)
    return buffer.getvalue()


def _write(figure: Figure, target: Path | io.BytesIO, ending: str) -> None:
    stamp = {".pdf": "CreationDate", ".svg": "Date"}.get(ending)
    metadata = {stamp: None} if stamp else None
    with mpl.rc_context(_SAVING):
        figure.savefig(
            target,
            format=ending[1:],
            dpi=_RESOLUTION_DPI,
            facecolor="white",
            metadata=metadata,
            **_packing(ending),
        )
