"""Units a header declares: none is ever guessed, and a missing one is answered with the line to write."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from armik_sym.errors import UnitError
from armik_sym.motion.unit_table import OpenTable
from armik_sym.motion.units import NO_UNITS, Unit, is_number

Units = Mapping[str, Unit]


def column_units(
    table: OpenTable, allowed: Mapping[str, Units], guess: Callable[[OpenTable, str], str]
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
    table: OpenTable,
    missing: list[str],
    allowed: Mapping[str, Units],
    guess: Callable[[OpenTable, str], str],
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


def largest(table: OpenTable, name: str) -> float:
    """Largest magnitude in the first rows of a column as written; cells that are no numbers do not count.

    Args:
        table: The table, whose rows cannot be read any more afterwards.
        name: The column.

    Returns:
        max |value| in the unit of the file, 0 if there is none.

    Source:
        None (bookkeeping).
    """
    index = table.columns[name].index
    cells = (row[index] for row in table.preview)
    return max((abs(float(cell)) for cell in cells if is_number(cell)), default=0.0)


def likely_time_unit(table: OpenTable, name: str) -> str:
    """What a time column without a unit looks like: steps of 1 and more are milliseconds.

    Args:
        table: The table.
        name: The column.

    Returns:
        "s" or "ms".

    Source:
        None (rule of thumb: recordings have 1 to 1000 samples per second).
    """
    return "ms" if largest(table, name) >= len(table.preview) else "s"
