"""The header row of a table: names, and units in brackets."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

from armik_sym.errors import MotionFileError
from armik_sym.motion.units import is_number

_HEADING = re.compile(r"(?P<name>[^\[\]]*?)\s*(\[\s*(?P<unit>[^\[\]]*?)\s*\])?\Z")


@dataclass(frozen=True)
class Column:
    """One column of a table.

    Attributes:
        name: Its name, without the unit.
        unit: The unit in brackets, or None if the header declares none.
        index: Position in the row, from 0.
    """

    name: str
    unit: str | None
    index: int


def header_columns(path: Path, number: int, heading: str) -> dict[str, Column]:
    """Parse a header row: names, each with an optional unit in brackets.

    Args:
        path: The file, for messages.
        number: Line number of the header, from 1.
        heading: The line.

    Returns:
        Columns by name, in file order.

    Raises:
        MotionFileError: If the line is no header, or a name is empty or occurs twice.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    cells = row_cells(path, number, heading)
    for mark, word in ((";", "semicolons"), ("\t", "tabs")):
        if len(cells) == 1 and mark in heading:
            raise MotionFileError(f"{path}: line {number} separates its columns by {word}: use commas")
    if all(is_number(cell) for cell in cells):
        raise MotionFileError(
            f"{path}: line {number} holds numbers where the header row should be, such as "
            "'time [s],x [mm],y [mm],z [mm]'"
        )
    columns: dict[str, Column] = {}
    for index, cell in enumerate(cells):
        match = _HEADING.match(cell)
        name = match["name"] if match else ""
        if match is None or not name:
            raise MotionFileError(
                f"{path}: line {number}: column {index + 1} of the header is {cell!r}, expected a name and a "
                "unit in brackets such as 'time [s]'"
            )
        if name in columns:
            raise MotionFileError(f"{path}: line {number}: column {name!r} occurs twice in the header")
        columns[name] = Column(name, match["unit"], index)
    return columns


def row_cells(path: Path, number: int, line: str) -> tuple[str, ...]:
    """Split a line into its cells, without the blanks around them.

    Args:
        path: The file, for messages.
        number: Line number, from 1.
        line: The line.

    Returns:
        The cells.

    Raises:
        MotionFileError: If quotes do not match.

    Source:
        RFC 4180 (comma-separated values).
    """
    try:
        return tuple(cell.strip() for cell in next(csv.reader([line], strict=True)))
    except csv.Error as error:
        raise MotionFileError(f"{path}: line {number} is not comma-separated text: {error}") from None
