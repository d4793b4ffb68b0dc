"""Expressions as CasADi Functions in the form that becomes C or is evaluated for many samples."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def dense_function(name: str, inputs: Mapping[str, ca.SX], value: ca.SX) -> ca.Function:
    """A Function with one dense output `out`, common subexpressions shared.

    Args:
        name: Name of the function.
        inputs: Symbols by name, in order.
        value: What it returns.

    Returns:
        The Function.

    Source:
        None (packaging).
    """
    return ca.Function(name, list(inputs.values()), [ca.cse(ca.densify(value))], list(inputs), ["out"])


def evaluate_rows(function: ca.Function, *inputs: ArrayLike) -> Array:
    """A Function of vectors for many samples at once, samples on axis 0.

    Args:
        function: Function of SX vectors with one vector as output.
        inputs: Each of shape (n, size), or (size,) for all samples alike.

    Returns:
        Shape (n, size of the output).

    Source:
        None (CasADi maps over columns).
    """
    rows = [np.atleast_2d(np.asarray(value, dtype=np.float64)) for value in inputs]
    if any(len(value) == 0 for value in rows):  # CasADi maps nothing to one column
        return np.zeros((0, function.size1_out(0)))
    return np.asarray(function(*[value.T for value in rows]), dtype=np.float64).T
