"""Comma-separated tables whose header declares a unit for every column: `time [s],x [mm],…`."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.table_header import Column, header_columns, row_cells
from armik_sym.motion.text_file import write_lines
from armik_sym.motion.units import Unit, from_si, is_number, to_si

_COMMENT = "#"
_NOTE = "note:"
# Rows that are enough to propose a unit.
_PREVIEW = 1000


@dataclass(frozen=True)
class UnitTable:
    """A table as read, in SI.

    Attributes:
        columns: The columns by name, in file order.
        lines: Line number of every sample, from 1, shape (n,).
        numbers: The numbers in SI, shape (n, columns).
        note: Where the data come from: what a comment line "# note: …" says, else empty.

    Source:
        RFC 4180 (comma-separated values).
    """

    columns: Mapping[str, Column]
    lines: NDArray[np.int64]
    numbers: NDArray[np.float64]
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

    def of(self, names: Sequence[str]) -> NDArray[np.float64]:
        """Some columns, in SI.

        Args:
            names: Names of k columns.

        Returns:
            Their values, shape (n, k).

        Source:
            None (bookkeeping).
        """
        return self.numbers[:, [self.columns[name].index for name in names]]


class OpenTable:
    """A table whose header was read, and whose rows are still in the file.

    Attributes:
        path: The file.
        columns: The columns by name, in file order.
        header_line: Line number of the header, from 1.

    Raises:
        MotionFileError: If the file has no header row.

    Source:
        RFC 4180 (comma-separated values).
    """

    def __init__(self, lines: NumberedLines) -> None:
        self._lines = lines
        self.path = lines.path
        heading = lines.next_uncommented()
        if heading is None:
            said = "only comments, expected" if lines.comments else "the file is empty, expected"
            raise MotionFileError(f"{self.path}: {said} a header row such as 'time [s],x [mm],…'")
        self.header_line = lines.number
        self.columns = header_columns(self.path, self.header_line, heading)

    @cached_property
    def preview(self) -> list[tuple[str, ...]]:
        """Cells of the first rows, as text, for proposals only: the table cannot be read any more."""
        rows: list[tuple[str, ...]] = []
        while len(rows) < _PREVIEW and (line := self._lines.next_uncommented()) is not None:
            rows.append(self._cells(line))
        return [row for row in rows if len(row) == len(self.columns)]

    def read(self, units: Mapping[str, Unit]) -> UnitTable:
        """Read the rows, one at a time, so that garbage is refused at its first line.

        Args:
            units: Unit of every column that is wanted; others may hold anything, and are NaN.

        Returns:
            The table.

        Raises:
            MotionFileError: If a row has another number of cells, a cell is no finite number, or there are
                no rows.

        Source:
            RFC 4180 (comma-separated values).
        """
        order = [(name, units.get(name)) for name in self.columns]
        numbers, at = array("d"), array("q")
        while (line := self._lines.next_uncommented()) is not None:
            cells = self._cells(line)
            if len(cells) != len(order):
                raise self._miscounted(len(cells))
            at.append(self._lines.number)
            for cell, (name, unit) in zip(cells, order, strict=True):
                if unit is not None and not is_number(cell):
                    raise MotionFileError(
                        f"{self.path}: line {self._lines.number}, column {name!r} {_not_a_number(cell)}"
                    )
                numbers.append(math.nan if unit is None else to_si(cell, unit))
        if not at:
            raise MotionFileError(
                f"{self.path}: the header on line {self.header_line} is followed by no samples"
            )
        values = np.array(numbers, dtype=np.float64).reshape(len(at), len(order))
        return UnitTable(self.columns, np.array(at, dtype=np.int64), values, self._lines.said(_NOTE))

    def _cells(self, line: str) -> tuple[str, ...]:
        if '"' in line:
            return row_cells(self.path, self._lines.number, line)
        return tuple(cell.strip() for cell in line.split(","))

    def _miscounted(self, have: int) -> MotionFileError:
        want = len(self.columns)
        failure = self._lines.error(f"has {have} cells, expected {want}")
        if have < want and self._lines.next_uncommented() is None:
            return MotionFileError(
                f"{failure}: the file seems cut off; delete this line if the recording may end before it"
            )
        if have == 2 * want:
            return MotionFileError(f"{failure}: decimal commas? Write numbers with a decimal point")
        return MotionFileError(f"{failure}, one for each column of the header")


@contextmanager
def open_table(path: Path) -> Iterator[OpenTable]:
    """Open a table: lines starting with '#' are comments, then one header row, then one row a sample.

    Args:
        path: The file.

    Returns:
        The table, read as far as its header.

    Raises:
        MotionFileError: If the file is missing, unreadable or has no header row.

    Source:
        RFC 4180 (comma-separated values).
    """
    with NumberedLines(path) as lines:
        yield OpenTable(lines)


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


def _not_a_number(cell: str) -> str:
    if not cell:
        return "is empty, expected a number: fill the gap or delete the line"
    if cell.lower().lstrip("+-") in ("nan", "inf", "infinity", "na", "null", "none"):
        return f"is {cell!r}, expected a finite number: fill the gap or delete the line"
    return f"is {cell!r}, expected a number with a decimal point such as 12.5"
