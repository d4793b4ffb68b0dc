"""Marker recordings of every form, by the ending of the file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path

from armik_sym.errors import MotionFileError, OptionError, UnitError
from armik_sym.motion.bvh import read_bvh
from armik_sym.motion.c3d import read_c3d, write_c3d
from armik_sym.motion.marker_csv import read_marker_csv, write_marker_csv
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.nexus_csv import SECTIONS, first_cell, read_nexus_csv, write_nexus_csv
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.trc import read_trc, write_trc

MARKER_FILES = (".trc", ".c3d", ".csv", ".bvh")

_WRITERS: Mapping[str, Callable[..., None]] = {
    ".trc": write_trc,
    ".c3d": write_c3d,
    ".csv": write_marker_csv,
}


def read_markers(path: str | os.PathLike[str], unit: str | float | None = None) -> MarkerRecording:
    """Read markers from a `.trc`, `.c3d`, `.csv` (Nexus or ours) or `.bvh` (joint centres) file.

    Args:
        path: The file.
        unit: For `.bvh` only, whose lengths have no unit: "m", "cm" or "mm", or metres per unit.

    Returns:
        The recording, in SI units; what was odd in the file stands in its note.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or of another form; names line or byte.
        UnitError: If a unit is not declared, unknown, or mixed with others.
        OptionError: If a unit is given for a file that declares its own.

    Source:
        None (see the readers of each form, and `docs/files.md`).
    """
    file = Path(path)
    ending = file.suffix.lower()
    if ending == ".bvh":
        if unit is None:
            raise UnitError(
                f"{file}: lengths in .bvh files have no unit: give it, as in read_markers(path, unit='cm'), "
                "or the number of metres in one unit"
            )
        return read_bvh(file).positions(unit)
    if unit is not None:
        raise OptionError(f"unit is {unit!r}, but {file.name} declares its own: only .bvh files do not")
    if ending == ".trc":
        return read_trc(file)
    if ending == ".c3d":
        return read_c3d(file)
    if ending == ".csv":
        return read_nexus_csv(file) if is_nexus_csv(file) else read_marker_csv(file)
    raise MotionFileError(
        f"{file}: cannot read markers from {ending or 'a file without ending'!r}: valid are "
        f"{', '.join(MARKER_FILES)}"
    )


def write_markers(
    path: str | os.PathLike[str], recording: MarkerRecording, unit: str = "mm", nexus: bool = False
) -> None:
    """Write markers as a `.trc`, `.c3d` or `.csv` file.

    Args:
        path: The file; its folder must exist.
        recording: The recording.
        unit: Unit to write lengths in, "m", "cm" or "mm".
        nexus: Whether a `.csv` is to be in the form of Vicon Nexus instead of ours.

    Raises:
        MotionFileError: If the ending is another one, or the file cannot be written.
        UnknownNameError: If the unit is another one.
        OptionError: If `ezc3d` is missing for `.c3d`.

    Source:
        None (see the writers of each form, and `docs/files.md`).
    """
    file = Path(path)
    ending = file.suffix.lower()
    if ending not in _WRITERS:
        raise MotionFileError(
            f"{file}: cannot write markers as {ending or 'a file without ending'!r}: valid are "
            f"{', '.join(_WRITERS)}"
        )
    writer = write_nexus_csv if nexus and ending == ".csv" else _WRITERS[ending]
    writer(file, recording, unit)


def is_nexus_csv(path: Path) -> bool:
    """Whether a file starts like an export of Vicon Nexus: with the name of a section.

    Args:
        path: The file.

    Returns:
        Whether it does.

    Raises:
        MotionFileError: If the file is missing or unreadable.

    Source:
        Vicon Nexus user guide, "Export ASCII".
    """
    with NumberedLines(path) as lines:
        line = lines.next_line(any_encoding=True) or ""
    return first_cell(line) in SECTIONS
