"""Units a motion file may declare, and numbers as text in them.

Units that differ from SI by a power of ten are converted on the decimal text, so that metres written
as millimetres and read again are the same metres to the last bit.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Context, Decimal

from armik_sym.errors import UnknownNameError

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\Z", re.ASCII)
_CONTEXT = Context(prec=800)
_LONGEST_PLAIN = 20
# Beyond this, times and rates run out of the numbers a computer has.
_FASTEST = 1e100


@dataclass(frozen=True)
class Unit:
    """A unit: value_SI = value · 10^shift · factor.

    Attributes:
        shift: Power of ten, applied to the decimal text without rounding.
        factor: Factor that is no power of ten.

    Source:
        SI.
    """

    shift: int = 0
    factor: float = 1.0


TIME_UNITS: Mapping[str, Unit] = {"s": Unit(), "ms": Unit(-3)}
LENGTH_UNITS: Mapping[str, Unit] = {"m": Unit(), "cm": Unit(-2), "mm": Unit(-3)}
ANGLE_UNITS: Mapping[str, Unit] = {"rad": Unit(), "deg": Unit(factor=math.pi / 180.0)}
NO_UNITS: Mapping[str, Unit] = {"-": Unit(), "1": Unit()}


def length_unit(name: str) -> Unit:
    """A unit of length by its name.

    Args:
        name: "m", "cm" or "mm".

    Returns:
        The unit.

    Raises:
        UnknownNameError: If the unit is another one.

    Source:
        SI.
    """
    if name not in LENGTH_UNITS:
        raise UnknownNameError("unit of length", name, LENGTH_UNITS)
    return LENGTH_UNITS[name]


def is_number(text: str) -> bool:
    """True if the text is one finite decimal number, written with a point.

    Args:
        text: The text of a cell.

    Returns:
        Whether it can be read.

    Source:
        None (bookkeeping).
    """
    return bool(_NUMBER.match(text)) and math.isfinite(float(text))


def is_rate(text: str) -> bool:
    """True if the text is a number that can be a rate, or a time between samples.

    Args:
        text: The text of a cell.

    Returns:
        Whether it is a positive number whose inverse is one, too.

    Source:
        None (bookkeeping).
    """
    return is_number(text) and 1.0 / _FASTEST <= float(text) <= _FASTEST


def to_si(text: str, unit: Unit) -> float:
    """Read a number: value_SI = value · 10^shift · factor, rounded once.

    Args:
        text: A number for which `is_number` holds.
        unit: Its unit.

    Returns:
        The value in SI.

    Source:
        SI.
    """
    value = float(text)
    if value == 0.0:
        return value
    if unit.shift and "e" not in text and "E" not in text:
        value = float(f"{text}e{unit.shift}")
    elif unit.shift:
        value = float(Decimal(text).scaleb(unit.shift, _CONTEXT))
    return value * unit.factor


def from_si(value: float, unit: Unit) -> str:
    """Write a number with as many digits as it needs: value = value_SI · 10^-shift / factor.

    Args:
        value: A finite value in SI.
        unit: The unit to write it in.

    Returns:
        Text that `to_si` turns into the same float64 (for degrees: to the last digit but one).

    Source:
        SI.
    """
    number = Decimal(repr(float(value) / unit.factor)).scaleb(-unit.shift, _CONTEXT)
    return format(number, "f") if abs(number.adjusted()) <= _LONGEST_PLAIN else str(number)
