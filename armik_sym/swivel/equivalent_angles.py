"""Which of the angles q + 2πk a joint takes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import ROUNDING, TURN

Array = NDArray[np.float64]


def nearest_in_range(angle: Array, lower: Array, upper: Array, wish: Array) -> Array:
    """Of all angle + 2πk the one inside the range nearest to a wish, or leaving the range least.

    Args:
        angle: Angles, shape (…, k), in [rad].
        lower: Lower limits, shape (k,), in [rad].
        upper: Upper limits, shape (k,), in [rad].
        wish: Wished angles, shape (…, k), in [rad].

    Returns:
        Shape (…, k), in [rad].

    Source:
        None (this package).
    """
    inside_wish = np.clip(wish, lower, upper)
    q = angle + TURN * np.floor((inside_wish - angle) / TURN + 0.5)
    down = (q > upper + ROUNDING) & (lower - (q - TURN) < q - upper)
    up = (q < lower - ROUNDING) & (q + TURN - upper < lower - q)
    return np.asarray(q - TURN * down + TURN * up)


def margin(angle: Array, lower: Array, upper: Array) -> Array:
    """How far the best of all angle + 2πk is inside the range: negative by how much it misses it.

    Args:
        angle: Angles, shape (…, k), in [rad].
        lower: Lower limits, shape (k,), in [rad].
        upper: Upper limits, shape (k,), in [rad].

    Returns:
        Half the range minus the distance from its middle, shape (…, k), in [rad].

    Source:
        None (this package).
    """
    away = angle - 0.5 * (lower + upper)
    return np.asarray(0.5 * (upper - lower) - np.abs(without_turns(away)))


def largest_difference(q: Array, other: Array, width: Array) -> Array:
    """How far postures are apart in the joint in which they are farthest apart.

    Joints with more than a full turn take the shorter way round; a range of one turn tells angles 2π apart.

    Args:
        q: Postures, shape (k, dof), in [rad].
        other: Others, shape (k, dof), in [rad].
        width: Widths of the ranges of motion, shape (dof,), in [rad].

    Returns:
        Shape (k,), in [rad].

    Source:
        None (definition).
    """
    away = q - other
    turns = np.rint(away / TURN) * (width > TURN + ROUNDING)
    return np.asarray(np.abs(away - TURN * turns).max(axis=1))


def without_turns(angle: Array) -> Array:
    """Angles without whole turns: between -π and π.

    Args:
        angle: Angles of any shape, in [rad].

    Returns:
        The same shape, in [rad].

    Source:
        Definition.
    """
    return np.asarray(angle - TURN * np.rint(angle / TURN))
