"""Angles as given by a caller, checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import ShapeError

Array = NDArray[np.float64]


def checked_angles(values: ArrayLike, what: str, *, more: bool = False) -> Array:
    """Three angles per sample as an array; further columns are let through on request.

    Args:
        values: Angles, shape (n, 3) or (3,), in [rad]; with `more` (n, k) or (k,), k ≥ 3.
        what: What they are, beginning a message.
        more: Whether further columns may follow the three.

    Returns:
        The array, shape as given.

    Raises:
        ShapeError: If the shape is another one, or something is no finite real number.

    Source:
        None (input check).
    """
    expected = "(n, k) or (k,) with k ≥ 3" if more else "(n, 3) or (3,)"
    try:
        given = np.asarray(values)
        real = given.dtype.kind in "fiub"
        array = given.astype(np.float64) if real else np.empty(0)
    except (TypeError, ValueError):
        real = False
    if not real:
        raise ShapeError(f"{what}: {values!r:.80}, expected an array of real numbers {expected}, in [rad]")
    columns = array.shape[-1] if array.ndim in (1, 2) else 0
    if columns != 3 and not (more and columns > 3):
        raise ShapeError(f"{what}: shape {array.shape}, expected {expected}, in [rad]")
    bad = np.argwhere(~np.isfinite(array))
    if bad.size:
        place = f"angle {bad[0][-1] + 1}" + (f" of sample {bad[0][0]}" if array.ndim == 2 else "")
        raise ShapeError(f"{what}: {place} is {array[tuple(bad[0])]}, expected a finite number in [rad]")
    return array
