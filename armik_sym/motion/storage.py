"""Reading and writing OpenSim's `.mot` and `.sto` files."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np

from armik_sym.errors import MotionFileError, UnitError
from armik_sym.motion.number_rows import read_rows, split, without_empty_end
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.promised_rows import compare_rows, count_of, joined, warn
from armik_sym.motion.storage_table import StorageTable
from armik_sym.motion.table_checks import check_table_names, check_times, errors_of_file
from armik_sym.motion.text_file import write_lines
from armik_sym.motion.units import Unit

_LONGEST_HEADER = 1000
_PAIR = re.compile(r"\s*(?P<key>\w+)\s*(=|\s)\s*(?P<value>.*?)[\s,]*\Z")
_COUNTS = {"nrows": "nrows", "datarows": "nrows", "ncolumns": "ncolumns", "datacolumns": "ncolumns"}
_DEGREES = {"yes": True, "y": True, "no": False, "n": False}
_TIME = "time"


def read_storage(path: str | os.PathLike[str]) -> StorageTable:
    """Read a `.mot` or `.sto` file, its columns separated by tabs, commas or blanks.

    Numbers stay as they are; `StorageTable.joint_motion` turns columns into joint angles. A header that
    promises another number of rows or columns than there are is answered by a `MotionFileWarning`,
    which the note repeats.

    Args:
        path: The file.

    Returns:
        The table.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or not of this form; names the line.
        UnitError: If `inDegrees` is neither yes nor no.

    Source:
        OpenSim documentation, "Storage (.sto) files" and "Motion (.mot) files".
    """
    file = Path(path)
    with NumberedLines(file) as lines:
        title, header = _header(lines)
        names, delimiter = _columns(lines)
        at = lines.number
        rows = read_rows(lines, names, [Unit()] * len(names), delimiter, gaps_from=1)
    if not len(rows.values):
        raise MotionFileError(f"{file}: the header ends on line {at} and is followed by no rows")
    time = rows.values[:, 0]
    check_times(file, time, rows.lines)
    counts = {key: count_of(file, line, key, text) for key, (text, line) in header.items() if key in _COUNTS}
    promised = {_COUNTS[key]: count for key, count in counts.items()}
    odd = compare_rows(file, "nRows", promised.get("nrows"), len(time))
    wide = promised.get("ncolumns", len(names))
    if wide != len(names):
        odd = joined(odd, warn(file, f"the header promises {wide} columns (nColumns) and names {len(names)}"))
    degrees = _in_degrees(file, header)
    with errors_of_file(file):
        return StorageTable(time, tuple(names[1:]), rows.values[:, 1:], degrees, title, odd, file.name)


def write_storage(path: str | os.PathLike[str], table: StorageTable, comment: str = "") -> None:
    """Write a `.mot` or `.sto` file, separated by tabs, with as many digits as every number needs.

    Read again, times and values are the same to the last bit; gaps are written as `nan`.

    Args:
        path: The file; its folder must exist.
        table: The table.
        comment: Text for the header, or "".

    Raises:
        MotionFileError: If a name or the comment cannot be written, or the file cannot.

    Source:
        OpenSim documentation, "Storage (.sto) files".
    """
    file = Path(path)
    check_table_names(file, table.names, forbidden=" \t,;", what="column")
    if any(name.lower() == _TIME for name in table.names):
        raise MotionFileError(f"{file}: column 'time' cannot be written: the times are called so")
    said = [line for line in comment.splitlines() if line.strip()]
    if any("endheader" in line.lower() for line in [table.title, *said]):
        raise MotionFileError(f"{file}: title and comment must not hold 'endheader', which ends the header")
    fields = [line for line in [table.title, *said] if _says_field(line)]
    if fields:
        raise MotionFileError(f"{file}: title and comment must not hold {fields[0]!r}, a field of the header")
    degrees = [] if table.in_degrees is None else [f"inDegrees={'yes' if table.in_degrees else 'no'}"]
    lines = [
        " ".join(table.title.split()) or "Coordinates",
        "version=1",
        f"nRows={len(table)}",
        f"nColumns={len(table.names) + 1}",
        *degrees,
        *said,
        "endheader",
        "\t".join((_TIME, *table.names)),
    ]
    lines += ["\t".join(map(repr, row)) for row in np.column_stack([table.time, table.values]).tolist()]
    write_lines(file, lines)


def _header(lines: NumberedLines) -> tuple[str, dict[str, tuple[str, int]]]:
    """The title, and value and line number of every field by its name in small letters."""
    title = ""
    fields: dict[str, tuple[str, int]] = {}
    while (line := lines.next_line()) is not None:
        text = line.strip(", \t")
        if text.lower() == "endheader":
            return title, fields
        if lines.number == 1:
            title = text
        if lines.number > _LONGEST_HEADER:
            raise lines.error(
                "is still header: expected 'endheader' long before, is this a .mot or .sto file?"
            )
        match = _PAIR.match(line)
        if match and ("=" in line or match["key"].lower() in _COUNTS):
            fields.setdefault(match["key"].lower(), (match["value"].strip(), lines.number))
    if not lines.number:
        raise MotionFileError(f"{lines.path}: the file is empty")
    raise MotionFileError(
        f"{lines.path}: no line 'endheader' in {lines.number} lines: the file is cut off, or no .mot or .sto "
        "file"
    )


def _says_field(line: str) -> bool:
    match = _PAIR.match(line)
    return match is not None and match["key"].lower() in (*_COUNTS, "indegrees", "datatype")


def _columns(lines: NumberedLines) -> tuple[list[str], str | None]:
    """Names of the columns, and what separates them (None: blanks)."""
    line = lines.next_content(",")
    if line is None:
        raise lines.error("ends the header and the file: expected the names of the columns after it")
    delimiter = "\t" if "\t" in line else "," if "," in line else None
    names = without_empty_end(split(line, delimiter))
    if ";" in line:
        raise lines.error("separates its columns by semicolons: use tabs")
    if names[0].lower() != _TIME or len(names) < 2:
        raise lines.error(f"starts with {names[0][:40]!r}, expected 'time' and at least one other column")
    check_table_names(lines.path, names, lines.number, what="column")
    return names, delimiter


def _in_degrees(file: Path, header: dict[str, tuple[str, int]]) -> bool | None:
    kind, at = header.get("datatype", ("double", 0))
    if kind.lower() != "double":
        raise MotionFileError(f"{file}: line {at}: DataType is {kind!r}, only tables of 'double' can be read")
    if "indegrees" not in header:
        return None
    text, at = header["indegrees"]
    if text.lower() not in _DEGREES:
        raise UnitError(f"{file}: line {at}: inDegrees is {text!r}, expected yes or no")
    return _DEGREES[text.lower()]
