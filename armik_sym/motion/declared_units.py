"""Units a header declares: none is ever guessed, and a missing one is answered with the line to write."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from armik_sym.errors import MotionFileError, UnitError
from armik_sym.motion.unit_table import UnitTable
from armik_sym.motion.units import NO_UNITS, Unit

Units = Mapping[str, Unit]


def column_units(
    table: UnitTable, allowed: Mapping[str, Units], guess: Callable[[UnitTable, str], str]
) -> dict[str, Unit]:
    """The declared unit of every column.

    Args:
        table: The table.
        allowed: Units by name for every column; `NO_UNITS` for pure numbers, which need not declare it.
        guess: Proposes a unit for a column that has none; only ever shown in the message.

    Returns:
        Unit by column name.

    Raises:
        UnitError: If a unit is missing or unknown; shows the header line to write.

    Source:
        None (SI).
    """
    missing = []
    units: dict[str, Unit] = {}
    for name, valid in allowed.items():
        unit = table.columns[name].unit
        if valid is NO_UNITS and not unit:
            units[name] = NO_UNITS["-"]
        elif not unit:
            missing.append(name)
        elif unit not in valid:
            raise UnitError(
                f"{table.path}: line {table.header_line}: column {name!r} has the unit {unit!r}, allowed: "
                f"{', '.join(valid)}"
            )
        else:
            units[name] = valid[unit]
    if missing:
        raise UnitError(_how_to_declare(table, missing, allowed, guess))
    return units


def _how_to_declare(
    table: UnitTable,
    missing: list[str],
    allowed: Mapping[str, Units],
    guess: Callable[[UnitTable, str], str],
) -> str:
    headings = []
    for name, column in table.columns.items():
        unit = guess(table, name) if name in missing else column.unit
        headings.append(f"{name} [{unit}]" if unit else name)
    groups = {tuple(allowed[name]): "" for name in missing}
    choices = "; ".join(
        f"{', '.join(name for name in missing if tuple(allowed[name]) == group)}: {' or '.join(group)}"
        for group in groups
    )
    return (
        f"{table.path}: line {table.header_line} declares no unit for {', '.join(missing)}. Units are never "
        f"guessed; if the numbers are what they look like, replace line {table.header_line} by\n"
        f"{','.join(headings)}\n(allowed are {choices})"
    )


def largest(table: UnitTable, name: str) -> float:
    """Largest magnitude in a column as written, 0 if its cells are not numbers.

    Args:
        table: The table.
        name: The column.

    Returns:
        max |value| in the unit of the file.

    Source:
        None (bookkeeping).
    """
    try:
        return float(np.abs(table.values(name, Unit())).max())
    except MotionFileError:
        return 0.0


def likely_time_unit(table: UnitTable, name: str) -> str:
    """What a time column without a unit looks like: steps of 1 and more are milliseconds.

    Args:
        table: The table.
        name: The column.

    Returns:
        "s" or "ms".

    Source:
        None (rule of thumb: recordings have 1 to 1000 samples per second).
    """
    return "ms" if largest(table, name) >= len(table.rows) else "s"
