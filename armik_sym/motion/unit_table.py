"""Comma-separated tables whose header declares a unit for every column: `time [s],x [mm],…`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError
from armik_sym.motion.table_header import Column, header_columns, row_cells
from armik_sym.motion.text_file import read_lines, write_lines
from armik_sym.motion.units import Unit, from_si, is_number, to_si

_COMMENT = "#"
_NOTE = "note:"


@dataclass(frozen=True)
class UnitTable:
    """A table as read, cells still text.

    Attributes:
        path: The file.
        columns: The columns by name, in file order.
        header_line: Line number of the header, from 1.
        lines: Line number of every sample, from 1.
        rows: Cells of every sample.
        note: Where the data come from: what a comment line "# note: …" says, else empty.

    Source:
        RFC 4180 (comma-separated values).
    """

    path: Path
    columns: Mapping[str, Column]
    header_line: int
    lines: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""

    def place(self, index: int) -> str:
        """Words for where a sample is: "line 12 (sample 3)".

        Args:
            index: Index of the sample.

        Returns:
            The words.

        Source:
            None (reporting).
        """
        return f"line {self.lines[index]} (sample {index})"

    def values(self, name: str, unit: Unit) -> NDArray[np.float64]:
        """One column in SI units.

        Args:
            name: Name of the column.
            unit: Its unit.

        Returns:
            Values in SI, shape (n,).

        Raises:
            MotionFileError: If a cell is not a finite number.

        Source:
            None (bookkeeping).
        """
        index = self.columns[name].index
        cells = [row[index] for row in self.rows]
        for line, cell in zip(self.lines, cells, strict=True):
            if not is_number(cell):
                raise MotionFileError(f"{self.path}: line {line}, column {name!r} {_not_a_number(cell)}")
        return np.array([to_si(cell, unit) for cell in cells], dtype=np.float64)


def read_table(path: Path) -> UnitTable:
    """Read a table: lines starting with '#' are comments, then one header row, then one row a sample.

    Args:
        path: The file.

    Returns:
        The table, cells still text.

    Raises:
        MotionFileError: If the file is missing, unreadable, not such a table, or cut off.

    Source:
        RFC 4180 (comma-separated values).
    """
    numbered = [(number, line) for number, line in enumerate(read_lines(path), 1) if line.strip()]
    content = [(number, line) for number, line in numbered if not line.lstrip().startswith(_COMMENT)]
    if not content:
        raise MotionFileError(f"{path}: only comments, expected a header row such as 'time [s],x [mm],…'")
    (header_line, heading), body = content[0], content[1:]
    columns = header_columns(path, header_line, heading)
    if not body:
        raise MotionFileError(f"{path}: the header on line {header_line} is followed by no samples")
    rows = [row_cells(path, number, line) for number, line in body]
    for i, (number, _) in enumerate(body):
        if len(rows[i]) != len(columns):
            last = i == len(body) - 1
            raise MotionFileError(f"{path}: line {number} {_miscount(len(rows[i]), len(columns), last)}")
    return UnitTable(
        path, columns, header_line, tuple(number for number, _ in body), tuple(rows), _note(numbered)
    )


def write_table(
    path: Path,
    columns: Mapping[str, tuple[str, Unit]],
    values: NDArray[np.float64],
    comment: str | None = None,
) -> None:
    """Write a table with as many digits as every number needs.

    Args:
        path: The file.
        columns: For every column its name, and its unit by name and conversion.
        values: Values in SI, shape (n, columns).
        comment: Text for the first lines, each marked with '#', or None.

    Raises:
        MotionFileError: If the file cannot be written.

    Source:
        RFC 4180 (comma-separated values).
    """
    lines = [f"{_COMMENT} {line}".rstrip() for line in (comment or "").splitlines()]
    lines.append(",".join(f"{name} [{unit}]" for name, (unit, _) in columns.items()))
    units = [unit for _, unit in columns.values()]
    lines += [",".join(map(from_si, row, units)) for row in values.tolist()]
    write_lines(path, lines)


def _note(numbered: list[tuple[int, str]]) -> str:
    comments = (line.strip().lstrip(_COMMENT).strip() for _, line in numbered if line.lstrip()[0] == _COMMENT)
    notes = (text[len(_NOTE) :].strip() for text in comments if text.lower().startswith(_NOTE))
    return next(notes, "")


def _miscount(have: int, want: int, last: bool) -> str:
    said = f"has {have} cells, expected {want}"
    if last and have < want:
        return f"{said}: the file seems cut off; delete this line if the recording may end before it"
    if have == 2 * want:
        return f"{said}: decimal commas? Write numbers with a decimal point"
    return f"{said}, one for each column of the header"


def _not_a_number(cell: str) -> str:
    if not cell:
        return "is empty, expected a number: fill the gap or delete the line"
    if cell.lower().lstrip("+-") in ("nan", "inf", "infinity", "na", "null", "none"):
        return f"is {cell!r}, expected a finite number: fill the gap or delete the line"
    return f"is {cell!r}, expected a number with a decimal point such as 12.5"
