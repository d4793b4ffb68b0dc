"""Rows of numbers below a header: what trc, mot, sto and Nexus files have in common."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.units import Unit, is_number, to_si

Array = NDArray[np.float64]

_GAPS = frozenset(("", "nan", "-nan", "+nan", "-nan(ind)", "nan(ind)"))
_MARKS = ((";", "semicolons"), ("\t", "tabs"), (",", "commas"))


@dataclass(frozen=True)
class NumberRows:
    """Numbers below a header.

    Attributes:
        values: The numbers in SI, shape (n, columns); NaN for a gap.
        lines: Line number of every row, shape (n,).

    Source:
        None (bookkeeping).
    """

    values: Array
    lines: NDArray[np.int64]


def split(line: str, delimiter: str | None) -> list[str]:
    """Split a line into cells without the blanks around them.

    Args:
        line: The line.
        delimiter: What separates the cells; None for any white space.

    Returns:
        The cells.

    Source:
        None (bookkeeping).
    """
    return [cell.strip() for cell in line.split(delimiter)] if delimiter else line.split()


def without_empty_end(cells: list[str]) -> list[str]:
    """Cells without the empty ones at the end, which trailing delimiters make.

    Args:
        cells: The cells.

    Returns:
        The cells up to the last that is not empty.

    Source:
        None (bookkeeping).
    """
    end = len(cells)
    while end and not cells[end - 1]:
        end -= 1
    return cells[:end]


def read_rows(
    lines: NumberedLines,
    names: Sequence[str],
    units: Sequence[Unit],
    delimiter: str | None,
    gaps_from: int,
    stop_at_blank: bool = False,
    comments: bool = False,
) -> NumberRows:
    """Read rows of numbers up to the end of the file.

    Args:
        lines: The file, just below its header.
        names: Names of the columns, for messages.
        units: Units of the columns.
        delimiter: What separates cells; None for any white space.
        gaps_from: First column that may have gaps (empty cells, or nan).
        stop_at_blank: Whether a blank line below the first row ends the table.
        comments: Whether lines that start with '#' are comments.

    Returns:
        The rows; none at all gives zero rows.

    Raises:
        MotionFileError: If a row has another number of cells, or a cell is no number.

    Source:
        None (bookkeeping).
    """
    blanks = delimiter or ""
    numbers, at = array("d"), array("q")

    def next_row() -> str | None:
        if comments:
            return lines.next_uncommented()
        return lines.next_line() if stop_at_blank and at else lines.next_content(blanks)

    while (line := next_row()) is not None:
        if not line.strip(f"{blanks} \t"):
            break
        cells = split(line, delimiter)
        if len(cells) != len(names):
            cells = _fitting(lines, line, cells, len(names), delimiter)
        at.append(lines.number)
        for column, cell in enumerate(cells):
            if cell and is_number(cell):
                numbers.append(to_si(cell, units[column]))
            elif column >= gaps_from and cell.lower() in _GAPS:
                numbers.append(np.nan)
            else:
                raise lines.error(f"column {names[column]!r} {_not_a_number(cell)}")
    values = np.frombuffer(numbers, dtype=np.float64) if numbers else np.empty(0)
    rows = np.frombuffer(at, dtype=np.int64) if at else np.empty(0, dtype=np.int64)
    return NumberRows(values.reshape(len(at), len(names)).copy(), rows.copy())


def _fitting(
    lines: NumberedLines, line: str, cells: list[str], want: int, delimiter: str | None
) -> list[str]:
    """Cells without superfluous empty ones at the end, or an error that says what is wrong."""
    have = len(without_empty_end(cells))
    if have <= want <= len(cells):
        return cells[:want]
    said = f"has {have if have > want else len(cells)} cells, expected {want}"
    if len(cells) == 1 and want > 1:
        other = [word for mark, word in _MARKS if mark in line and mark != delimiter]
        if other:
            raise lines.error(f"{said}: it separates them by {other[0]}, unlike the header")
    if have == 2 * want - 1 or have == 2 * want:
        raise lines.error(f"{said}: decimal commas? Write numbers with a decimal point")
    failure = lines.error(said)
    if len(cells) < want and lines.next_content() is None:
        raise MotionFileError(
            f"{failure}: the file seems cut off; delete this line if the recording may end before it"
        )
    raise MotionFileError(f"{failure}, one for each column of the header")


def _not_a_number(cell: str) -> str:
    if not cell:
        return "is empty, expected a number"
    if is_number(cell.replace(",", ".")):
        return f"is {cell!r}, expected a number with a decimal point"
    return f"is {cell[:40]!r}, expected a number such as 12.5"
