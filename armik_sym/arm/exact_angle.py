"""Sine and cosine of constant angles, exact at multiples of 90°.

DH tables are full of right angles. `math.cos(math.pi / 2)` is 6e-17, not 0: left in, it fills
matrices that are mostly zeros with noise terms and hides structure from the symbolic side.
"""

from __future__ import annotations

import math

_RIGHT = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def quarter_turns(angle: float) -> int | None:
    r"""Return k if `angle` is k quarter turns to rounding, otherwise None.

    angle = k·π/2, decided to a few units in the last place.

    Args:
        angle: The angle, in [rad].

    Returns:
        The whole number of quarter turns, reduced to 0…3, or None.

    Source:
        None (floating-point bookkeeping).
    """
    turns = angle / (math.pi / 2)
    nearest = round(turns)
    return nearest % 4 if abs(turns - nearest) <= 8 * math.ulp(max(1.0, abs(turns))) else None


def cos_sin(angle: float) -> tuple[float, float]:
    """Return (cos, sin) of a constant angle, exact at multiples of 90°.

    Args:
        angle: The angle, in [rad].

    Returns:
        Cosine and sine.

    Source:
        None (elementary).
    """
    turns = quarter_turns(angle)
    return _RIGHT[turns] if turns is not None else (math.cos(angle), math.sin(angle))
