"""Calling the C loops over feasible intervals and over what blocks."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.address import address
from armik_sym.compiled.build import Library
from armik_sym.swivel.c_structs import CCurves

if TYPE_CHECKING:
    from armik_sym.swivel.closed_form import SwivelCurve

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

# Six joints, two limits, two cuts each: 24 arcs. Between feasible runs are arcs that are not.
MOST_INTERVALS = 12

_BLOCK = 1024


def compiled_intervals(
    library: Library, curves: tuple[SwivelCurve, SwivelCurve]
) -> tuple[Indices, Indices, Array, Array, Flags]:
    """Feasible intervals of all samples and branches.

    Args:
        library: The library.
        curves: Curves with elbow side 1 and with -1.

    Returns:
        Sample, branch, start and end of every interval, sorted by sample, branch and start, shape (k,),
        angles in [rad]; whether a branch has none, shape (n, branches).

    Source:
        None (packaging).
    """
    n, branches = len(curves[0].elbow), 2 * 2 ** len(curves[0].triples)
    room = min(n, _BLOCK) * branches * MOST_INTERVALS
    integers, angles = np.empty((2, room), dtype=np.int64), np.empty((2, room))
    work = [address(row) for row in (*integers, *angles)]
    empty = np.empty((n, branches), dtype=np.bool_)
    c_curves = CCurves(*curves)
    loop = library.handle.armik_swivel_intervals
    loop.restype = ctypes.c_ssize_t
    indices, ends = [np.zeros((2, 0), dtype=np.int64)], [np.zeros((2, 0))]
    for first in range(0, n, _BLOCK):
        part = empty[first : first + _BLOCK]
        places = ctypes.c_ssize_t(first), ctypes.c_ssize_t(len(part))
        count = loop(*c_curves.arguments, *places, *work, address(part))
        indices.append(integers[:, :count].copy())
        ends.append(angles[:, :count].copy())
    sample, branch = np.concatenate(indices, axis=1)
    start, end = np.concatenate(ends, axis=1)
    return sample, branch, start, end, empty


def compiled_blocking(
    library: Library, curves: tuple[SwivelCurve, SwivelCurve], sample: Indices, branch: int | None
) -> tuple[Indices, Array, Indices, Array, Array]:
    """What blocks samples.

    Args:
        library: The library.
        curves: Curves with elbow side 1 and with -1.
        sample: Indices of samples, within bounds, shape (k,).
        branch: Only this branch; None for the best one.

    Returns:
        Branch, swivel angle in [rad], joint, missing angle in [rad] and shortfall in [m], shape (k,) each.

    Source:
        None (packaging).
    """
    k = len(sample)
    branches, joint = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
    psi, missing, shortfall = np.empty(k), np.empty(k), np.empty(k)
    c_curves = CCurves(*curves)
    loop = library.handle.armik_swivel_blocking
    loop.restype = None
    rows = np.ascontiguousarray(sample)  # kept alive during the call
    loop(
        *c_curves.arguments,
        ctypes.c_ssize_t(k),
        address(rows),
        ctypes.c_int64(-1 if branch is None else branch),
        *(address(array) for array in (branches, psi, joint, missing, shortfall)),
    )
    return branches, psi, joint, missing, shortfall
