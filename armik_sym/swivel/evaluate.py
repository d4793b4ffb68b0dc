"""The Functions of the closed form in NumPy: many samples at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.swivel.expressions import swivel_functions

Array = NDArray[np.float64]


def evaluate(name: str, *inputs: ArrayLike) -> Array:
    """One of the Functions of the closed form.

    Args:
        name: Name of the function.
        inputs: Each of shape (n, size), or (size,) for all alike.

    Returns:
        Shape (n, size of the output).

    Source:
        None (packaging).
    """
    rows = [np.atleast_2d(np.asarray(value, dtype=np.float64)) for value in inputs]
    if 0 in (len(value) for value in rows):
        return np.zeros((0, swivel_functions()[name].size1_out(0)))
    return np.asarray(swivel_functions()[name](*[value.T for value in rows]), dtype=np.float64).T
