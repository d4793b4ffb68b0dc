"""What counts as a number where a user gives one."""

from __future__ import annotations

import math
import numbers


def is_number(value: object, *, infinite_ok: bool = False) -> bool:
    """Whether a value is a finite real number, and neither a truth value nor text.

    Args:
        value: Anything.
        infinite_ok: Whether plus infinity counts as well, where it means "no limit".

    Returns:
        True if it is.

    Source:
        None (bookkeeping).
    """
    if not isinstance(value, numbers.Real) or isinstance(value, bool):
        return False
    return math.isfinite(value) or (infinite_ok and float(value) == math.inf)
