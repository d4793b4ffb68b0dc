"""Reading TOML values with errors that name the file, the key and what is allowed."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from armik_sym.errors import ArmFileError, ArmikError, UnitError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ANGLE_UNITS: Mapping[str, float] = {"rad": 1.0, "deg": math.pi / 180.0}
LENGTH_UNITS: Mapping[str, float] = {"m": 1.0, "cm": 0.01, "mm": 0.001}

_FULL_TURN = 2 * math.pi
# Squares of larger numbers are infinite.
_LARGEST = 1e100
_LONGEST = 100_000
_MOST_DOTS = 500


def load_toml(path: Path) -> dict[str, Any]:
    """Parse a TOML file.

    Args:
        path: The file.

    Returns:
        Its content.

    Raises:
        ArmFileError: If the file is missing, unreadable or not TOML.

    Source:
        TOML 1.0.
    """
    return parse_toml(_text(path), str(path), ArmFileError)


def parse_toml(text: str, name: str, failure: type[ArmikError]) -> dict[str, Any]:
    """Parse TOML that may be damaged, in bounded time.

    Args:
        text: The text.
        name: Where it comes from, beginning messages.
        failure: The error to raise.

    Returns:
        Its content.

    Raises:
        ArmikError: The one given, if it is not TOML, or nothing like a file of this package.

    Source:
        TOML 1.0.
    """
    # The parser takes minutes for a key of many thousand parts.
    crowded = [i for i, line in enumerate(text.split("\n"), 1) if line.count(".") > _MOST_DOTS]
    if crowded:
        raise failure(
            f"{name}: line {crowded[0]} has more than {_MOST_DOTS} dots, as no file of this package"
        )
    try:
        return dict(tomllib.loads(text))
    except RecursionError:
        raise failure(f"{name}: brackets are nested too deeply") from None
    except ValueError as error:  # not TOML, or a whole number of many thousand digits
        raise failure(f"{name}: not valid TOML: {error}") from None


def _text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            raw = file.read(_LONGEST + 1)
        if len(raw) > _LONGEST:
            raise ArmFileError(f"{path}: has more than {_LONGEST} bytes, as no file of this package")
        # As files opened as text: all line ends are one.
        return raw.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except FileNotFoundError:
        raise ArmFileError(f"{path}: no such file") from None
    except (OSError, ValueError) as error:
        if isinstance(error, ArmFileError):
            raise
        raise ArmFileError(f"{path}: cannot be read: {error}") from None


def check_keys(path: Path, where: str, table: Mapping[str, Any], allowed: Collection[str]) -> None:
    """Refuse keys that nothing reads, so that a spelling mistake cannot pass for a setting.

    Args:
        path: The file, for the message.
        where: The table, for the message.
        table: The parsed table.
        allowed: Keys that are read.

    Raises:
        ArmFileError: If the table has another key.

    Source:
        None (bookkeeping).
    """
    unknown = [key for key in table if key not in allowed]
    if unknown:
        raise ArmFileError(
            f"{path}: {where} has unknown key {unknown[0]!r}: allowed are {', '.join(allowed)}"
        )


def sub_table(path: Path, table: Mapping[str, Any], key: str) -> dict[str, Any]:
    """The table under a key, empty if the key is absent.

    Args:
        path: The file, for the message.
        table: The parsed file.
        key: The key of the table.

    Returns:
        The table.

    Raises:
        ArmFileError: If the value is no table.

    Source:
        None (bookkeeping).
    """
    value = table.get(key, {})
    if not isinstance(value, dict):
        raise ArmFileError(f"{path}: {key} is {value!r}, expected a table [{key}]")
    return value


def unit_factor(path: Path, table: Mapping[str, Any], key: str, units: Mapping[str, float]) -> float:
    """Factor from a declared unit to SI: value_SI = factor · value.

    Args:
        path: The file, for the message.
        table: The parsed file.
        key: `angle_unit` or `length_unit`.
        units: Factors by unit name.

    Returns:
        The factor.

    Raises:
        UnitError: If the unit is not declared or unknown.

    Source:
        None (SI).
    """
    unit = table.get(key)
    if not isinstance(unit, str) or unit not in units:
        said = "is missing" if unit is None else f"is {unit!r}"
        raise UnitError(
            f"{path}: {key} {said}: say in which unit the numbers are, for example "
            f'{key} = "{list(units)[-1]}" (allowed: {", ".join(units)})'
        )
    return units[unit]


def number(path: Path, where: str, value: object) -> float:
    """A finite number, or an error that names the key.

    Args:
        path: The file, for the message.
        where: The key, for the message.
        value: The parsed value.

    Returns:
        The number.

    Raises:
        ArmFileError: If the value is no finite number.

    Source:
        None (bookkeeping).
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= _LARGEST:
        raise ArmFileError(f"{path}: {where} is {value!r}, expected a finite number up to {_LARGEST:g}")
    return float(value)


def limit_pair(
    path: Path, where: str, value: object, factor: float, *, angle: bool = True
) -> tuple[float, float]:
    """A pair [lower, upper] in SI units.

    Args:
        path: The file, for the message.
        where: The key, for the message.
        value: The parsed value, `[lower, upper]` in the declared unit.
        factor: From the declared unit to [rad] or [m].
        angle: True for angles, False for lengths.

    Returns:
        Lower and upper limit, in [rad] or [m].

    Raises:
        ArmFileError: If the value is no pair of numbers, or lower exceeds upper.
        UnitError: If the values are declared as radians but exceed a full turn.

    Source:
        None (bookkeeping).
    """
    if not isinstance(value, list) or len(value) != 2:
        raise ArmFileError(f"{path}: {where} is {value!r}, expected [lower, upper]")
    lower, upper = (number(path, where, item) for item in value)
    if lower > upper:
        raise ArmFileError(f"{path}: {where} has lower limit {lower:g} above upper limit {upper:g}")
    if angle and factor == 1.0 and max(abs(lower), abs(upper)) > _FULL_TURN:
        raise UnitError(
            f"{path}: {where} is [{lower:g}, {upper:g}] rad, more than a full turn: if these are degrees, "
            'say angle_unit = "deg"'
        )
    return lower * factor, upper * factor
