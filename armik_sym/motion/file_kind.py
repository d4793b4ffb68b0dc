"""What a file holds: markers, joint angles or a hand path."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

from armik_sym.errors import MotionFileError
from armik_sym.motion.marker_csv import is_marker_header
from armik_sym.motion.nexus_csv import SECTIONS, first_cell
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.table_header import header_columns

Kind = Literal["markers", "motion", "path"]

_BY_ENDING: dict[str, Kind] = {
    ".trc": "markers",
    ".c3d": "markers",
    ".bvh": "markers",
    ".mot": "motion",
    ".sto": "motion",
}


def file_kind(path: str | os.PathLike[str]) -> Kind:
    """What a file holds, by its ending and, for `.csv`, by its header.

    Args:
        path: The file.

    Returns:
        "markers", "motion" (joint angles) or "path" (of the hand).

    Raises:
        MotionFileError: If the ending is unknown, or a `.csv` is missing or has no header row.

    Source:
        None (see `docs/files.md`).
    """
    file = Path(path)
    ending = file.suffix.lower()
    if ending in _BY_ENDING:
        return _BY_ENDING[ending]
    if ending != ".csv":
        raise MotionFileError(
            f"{file}: cannot read {ending or 'a file without ending'!r}: valid are "
            f"{', '.join((*_BY_ENDING, '.csv'))}"
        )
    with NumberedLines(file) as lines:
        line = lines.next_uncommented()
        if line is None:
            raise MotionFileError(f"{file}: no header row such as 'time [s],x [mm],…'")
        if first_cell(line) in SECTIONS:
            return "markers"
        names = list(header_columns(file, lines.number, line))
    if is_marker_header(names):
        return "markers"
    # One that lacks a coordinate is a path that says so when it is read.
    return "path" if {"x", "y", "z"} & set(names) else "motion"
