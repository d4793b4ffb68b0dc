"""The Functions of the closed form in NumPy: many samples at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.swivel.expressions import swivel_functions
from armik_sym.symbolic.dense_function import evaluate_rows

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
    return evaluate_rows(swivel_functions()[name], *inputs)
