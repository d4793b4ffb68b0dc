"""Postures at many places of a swivel map: any mix of samples, branches and swivel angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.errors import ShapeError
from armik_sym.swivel.c_postures import compiled_postures
from armik_sym.swivel.closed_form import Postures, SwivelCurve
from armik_sym.swivel.library import swivel_library

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def postures_at(
    curves: tuple[SwivelCurve, SwivelCurve],
    sample: ArrayLike,
    branch: ArrayLike,
    psi: ArrayLike,
    wish: ArrayLike | None = None,
    backend: Backend = "auto",
) -> Postures:
    """All joint angles for samples, branches and swivel angles in any order.

    The same as `curve.rows(sample).postures(psi, shoulder, wrist, wish)` on the curve of each branch, without
    a copy of the curves.

    Args:
        curves: The postures with elbow side 1 and with -1, as in `FeasibleIntervals.curves`.
        sample: Index of the sample, shape (k,).
        branch: Index into `FeasibleIntervals.branches`, shape (k,) or a number.
        psi: Swivel angle, shape (k,) or a number, in [rad].
        wish: Postures that decide as in `SwivelCurve.postures`, shape (k, dof) or (dof,), in [rad]; the
            middle of the range of motion if left out.
        backend: "auto", "c" or "vm".

    Returns:
        Postures, one per row.

    Raises:
        ShapeError: If shapes do not fit, or an index is out of range.

    Source:
        Al-Faiz, eq. 13-47, corrected; Shimizu et al. (2008).
    """
    rows, side, at = _checked(curves, sample, branch, psi)
    dof = curves[0].spherical.arm.dof
    wished = None if wish is None else np.asarray(wish, dtype=np.float64)
    if wished is not None and wished.shape not in ((dof,), (len(rows), dof)):
        raise ShapeError(f"wish {wished.shape}: expected ({dof},) or ({len(rows)}, {dof})")
    library = swivel_library(backend)
    if library is None:
        return _one_elbow_after_the_other(curves, rows, side, at, wished)
    q, sines = compiled_postures(library, curves, rows, side, at, wished)
    return Postures(q, sines[:, 0], sines[:, 1])


def _checked(
    curves: tuple[SwivelCurve, SwivelCurve], sample: ArrayLike, branch: ArrayLike, psi: ArrayLike
) -> tuple[Indices, Indices, Array]:
    rows = np.asarray(sample)
    if rows.ndim != 1 or (rows.size and rows.dtype.kind not in "iu"):
        raise ShapeError(f"sample {rows.shape} of {rows.dtype}: expected indices of shape (k,)")
    rows = rows.astype(np.int64, copy=False)
    n, branches = len(curves[0].elbow), 2 * 2 ** len(curves[0].triples)
    try:
        side = np.broadcast_to(np.asarray(branch, dtype=np.int64), rows.shape)
        at = np.broadcast_to(np.asarray(psi, dtype=np.float64), rows.shape)
    except ValueError:
        raise ShapeError(
            f"branch {np.shape(branch)} and psi {np.shape(psi)}: expected {rows.shape} as sample has"
        ) from None
    for what, values, end in (("sample", rows, n), ("branch", side, branches)):
        if values.size and (values.min() < 0 or values.max() >= end):
            raise ShapeError(f"{what} {values.min()} to {values.max()}: expected 0 to {end - 1}")
    return rows, side, at


def _one_elbow_after_the_other(
    curves: tuple[SwivelCurve, SwivelCurve], rows: Indices, side: Indices, psi: Array, wish: Array | None
) -> Postures:
    groups = len(curves[0].triples)
    pairs = 2**groups
    out = Postures(np.empty((len(rows), curves[0].spherical.arm.dof)), np.ones(len(rows)), np.ones(len(rows)))
    for e, curve in enumerate(curves):
        mine = np.flatnonzero(side // pairs == e)
        if not mine.size:
            continue
        pair = side[mine] % pairs
        shoulder, wrist = (pair // 2, pair % 2) if groups == 2 else (pair, np.zeros_like(pair))
        wished = wish if wish is None else np.broadcast_to(wish, out.q.shape)[mine]
        part = curve.rows(rows[mine]).postures(psi[mine], 1 - 2 * shoulder, 1 - 2 * wrist, wished, "vm")
        out.q[mine] = part.q
        out.shoulder_sine[mine] = part.shoulder_sine
        out.wrist_sine[mine] = part.wrist_sine
    return out
