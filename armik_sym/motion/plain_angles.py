"""Joint angles in tables that declare neither time nor units: the caller must."""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np

from armik_sym.errors import MotionFileError, OptionError, UnknownNameError
from armik_sym.motion.number_rows import read_rows, without_empty_end
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.storage_table import StorageTable
from armik_sym.motion.table_checks import check_table_names, errors_of_file
from armik_sym.motion.table_header import row_cells
from armik_sym.motion.units import ANGLE_UNITS, Unit, is_number


def read_plain_angles(path: str | os.PathLike[str], rate: float, unit: str) -> StorageTable:
    """Read a comma-separated table of names in one row and numbers below, one row a sample.

    t_i = i / rate. Nothing in such a file says its unit or rate, so both must be given.

    Args:
        path: The file.
        rate: Samples per second, in [Hz].
        unit: Unit of the angles, "deg" or "rad".

    Returns:
        The table, with empty cells as NaN.

    Raises:
        OptionError: If the rate is not positive.
        UnknownNameError: If the unit is another one.
        MotionFileError: If the file is missing, unreadable, cut off or not of this form; names the line.

    Source:
        RFC 4180 (comma-separated values).
    """
    if not (math.isfinite(rate) and rate > 0):
        raise OptionError(f"rate is {rate!r} Hz, expected a positive number")
    if unit not in ANGLE_UNITS:
        raise UnknownNameError("angle unit", unit, ANGLE_UNITS)
    file = Path(path)
    with NumberedLines(file) as lines:
        heading = lines.next_content(",")
        if heading is None:
            raise MotionFileError(f"{file}: the file is empty")
        names = without_empty_end(list(row_cells(file, lines.number, heading)))
        if len(names) < 2 or any(is_number(name) for name in names):
            raise lines.error("holds no names separated by commas, expected the names of the columns")
        check_table_names(file, names, lines.number, what="column")
        rows = read_rows(lines, names, [Unit()] * len(names), ",", gaps_from=0)
    if not len(rows.values):
        raise MotionFileError(f"{file}: the names of the columns are followed by no rows")
    time = np.arange(len(rows.values)) / rate
    said = f"rate {rate:g} Hz and unit {unit} as given by the caller"
    with errors_of_file(file):
        return StorageTable(time, tuple(names), rows.values, unit == "deg", "", said, file.name)
