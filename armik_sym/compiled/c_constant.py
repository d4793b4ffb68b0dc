"""Floating-point constants in C source."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from armik_sym.errors import OptionError

Precision = Literal["double", "float"]

SUFFIX = {"double": "", "float": "f"}


def check_precision(precision: str) -> Precision:
    """Return `precision` if it is one that C can be written for.

    Args:
        precision: "double" or "float".

    Returns:
        The same word.

    Raises:
        OptionError: If it is another word.

    Source:
        None (C99, 6.2.5).
    """
    if precision == "double":
        return "double"
    if precision == "float":
        return "float"
    raise OptionError(f"precision is {precision!r}: valid are double, float")


def c_constant(value: float, precision: Precision) -> str:
    """The shortest floating-point literal that reads back to the same number in that precision.

    Args:
        value: The number.
        precision: "double" or "float".

    Returns:
        C99 source text.

    Source:
        None (C99, 6.4.4.2).
    """
    if precision == "float":
        with np.errstate(over="ignore"):
            text = str(np.float32(value))
    else:
        text = repr(float(value))
    # Signed zero included: "-" before "-0.0" would read as a decrement.
    negative = math.copysign(1.0, value) < 0
    digits = text.lstrip("-")
    if digits == "nan":
        return f"(({precision})NAN)"
    digits = f"({precision})INFINITY" if digits == "inf" else f"{digits}{SUFFIX[precision]}"
    return f"(-{digits})" if negative else digits
