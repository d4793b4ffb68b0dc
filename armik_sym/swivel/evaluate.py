"""The Functions of the closed form in NumPy: many samples at once."""

from __future__ import annotations

import ctypes

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.compiled.address import address
from armik_sym.compiled.backend import Backend
from armik_sym.compiled.build import Library
from armik_sym.swivel.expressions import swivel_functions
from armik_sym.swivel.library import swivel_library
from armik_sym.symbolic.dense_function import evaluate_rows

Array = NDArray[np.float64]


def evaluate(name: str, *inputs: ArrayLike, backend: Backend = "auto") -> Array:
    """One of the Functions of the closed form.

    Args:
        name: Name of the function.
        inputs: Each of shape (n, size), or (size,) for all alike.
        backend: "auto", "c" or "vm".

    Returns:
        Shape (n, size of the output).

    Source:
        None (packaging).
    """
    library = swivel_library(backend)
    if library is None:
        return evaluate_rows(swivel_functions()[name], *inputs)
    return _in_c(library, name, [rows_of(value) for value in inputs])


def _in_c(library: Library, name: str, rows: list[Array]) -> Array:
    counts = {len(value) for value in rows}
    n = 0 if 0 in counts else max(counts)
    if counts - {n, 1}:
        raise ValueError(f"{name}: inputs have {sorted(counts)} rows, expected {n} or 1")
    out = np.empty((n, swivel_functions()[name].size1_out(0)))
    loop = getattr(library.handle, f"armik_{name}_rows")
    loop.restype = None
    places: list[ctypes.c_void_p | ctypes.c_ssize_t] = []
    for value in rows:
        places += [address(value), ctypes.c_ssize_t(step_of(value) if len(value) == n else 0)]
    loop(ctypes.c_ssize_t(n), *places, address(out))
    return out


def rows_of(value: ArrayLike) -> Array:
    """Rows of numbers that lie side by side; the rows themselves may be apart, or all the same.

    Args:
        value: Shape (n, …), or (size,) or a number for one row.

    Returns:
        The array as it is if it is like that, else a copy; at least two axes.

    Source:
        None (packaging).
    """
    rows = np.atleast_2d(np.asarray(value, dtype=np.float64))
    if rows.size and (
        not rows[0].flags.c_contiguous or rows.strides[0] % rows.itemsize or rows.strides[0] < 0
    ):
        return np.ascontiguousarray(rows)
    return rows


def step_of(rows: Array) -> int:
    """Distance between rows.

    Args:
        rows: As of `rows_of`.

    Returns:
        In numbers.

    Source:
        None (packaging).
    """
    return rows.strides[0] // rows.itemsize
