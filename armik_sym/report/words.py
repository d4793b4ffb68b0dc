"""Names and numbers as a reader who did not write the code wants them."""

from __future__ import annotations

import math
import re

import numpy as np

_EXPONENT = re.compile(r"-?\d+(?:\.\d+)?e[+-]?\d+")
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_SMALLEST_WORTH_A_NUMBER = 1e-6


def joint_title(name: str) -> str:
    """The name of a joint in words: "shoulder_flexion" → "Shoulder flexion".

    Args:
        name: Name of the joint.

    Returns:
        The name in words.

    Source:
        None (reporting).
    """
    words = name.replace("_", " ").strip()
    return words[:1].upper() + words[1:]


def at_most(value: float, unit: str) -> str:
    """The largest of some errors in words; what no instrument could see is not spelled out.

    Args:
        value: The largest error, in `unit`.
        unit: Its unit.

    Returns:
        Text such as "at most 0.12 mm" or "below 0.000001 mm".

    Source:
        None (reporting).
    """
    if value < _SMALLEST_WORTH_A_NUMBER:
        return f"below 0.000001 {unit}"
    return f"at most {value:.3g} {unit}"


def plain(value: float) -> str:
    """A small number with one digit and without an exponent: 5.7e-8 → "0.00000006".

    Args:
        value: The number.

    Returns:
        The text.

    Source:
        None (reporting).
    """
    return np.format_float_positional(value, precision=1, fractional=False, trim="-")


def without_exponents(text: str) -> str:
    """A text whose numbers are written out: "3.27e+04°/s" → "32700°/s", "1.6e-12°" → "0.000001°".

    Args:
        text: The text; numbers below 0.000001 are written as that bound.

    Returns:
        The text.

    Source:
        None (reporting).
    """
    return _EXPONENT.sub(_written_out, text)


def _written_out(found: re.Match[str]) -> str:
    value = float(found[0])
    if 0 < abs(value) < _SMALLEST_WORTH_A_NUMBER:
        return f"{'-' if value < 0 else ''}{_SMALLEST_WORTH_A_NUMBER:.6f}"
    if abs(value) >= 1:
        return f"{value:.0f}"
    return np.format_float_positional(value, precision=2, fractional=False, trim="-")


def power_of_ten(value: float, position: int | None = None) -> str:
    """A tick of a logarithmic scale: 1e-9 → "10⁻⁹".

    Args:
        value: The number, a power of ten.
        position: Which tick it is; matplotlib says so, nobody asks.

    Returns:
        The text, in plain characters.

    Source:
        None (reporting).
    """
    del position
    if value <= 0:
        return ""
    return "10" + str(round(math.log10(value))).translate(_SUPERSCRIPTS)
