"""Calling the C loop over postures."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.address import address
from armik_sym.compiled.build import Library
from armik_sym.swivel.c_structs import CCurves
from armik_sym.swivel.evaluate import rows_of, step_of

if TYPE_CHECKING:
    from armik_sym.swivel.closed_form import SwivelCurve

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def compiled_postures(
    library: Library,
    curves: tuple[SwivelCurve, SwivelCurve],
    sample: Indices | None,
    branch: Indices,
    psi: Array,
    wish: Array | None,
) -> tuple[Array, Array]:
    """Postures for samples, branches and swivel angles in any order.

    Args:
        library: The library.
        curves: Curves with elbow side 1 and with -1; twice the same one if all branches
            are of side 1.
        sample: Indices of samples, within bounds, shape (k,); None for 0, 1, 2, …
        branch: Branches, within bounds, shape (k,).
        psi: Swivel angles, shape (k,), in [rad].
        wish: Wished postures, shape (k, dof) or (dof,), in [rad]; None for the middle of the range.

    Returns:
        Angles, shape (k, dof), in [rad]; sines of shoulder and wrist, shape (k, 2).

    Source:
        None (packaging).
    """
    k = len(branch)
    q, sines = np.empty((k, curves[0].spherical.arm.dof)), np.empty((k, 2))
    places = None if sample is None else np.ascontiguousarray(sample, dtype=np.int64)
    branches, angles = np.ascontiguousarray(branch, dtype=np.int64), np.ascontiguousarray(psi)
    wished = None if wish is None else rows_of(wish)
    step = step_of(wished) if wished is not None and len(wished) == k else 0
    c_curves = CCurves(*curves)
    loop = library.handle.armik_swivel_postures
    loop.restype = None
    loop(
        *c_curves.arguments,
        ctypes.c_ssize_t(k),
        *(address(array) for array in (places, branches, angles, wished)),
        ctypes.c_ssize_t(step),
        address(q),
        address(sines),
    )
    return q, sines
