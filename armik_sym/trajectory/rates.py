"""Joint speed and acceleration as linear maps of the sampled angles, for any time stamps."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NEAREST = 0.1
# At high sampling rates second differences weigh 1/h³: brought back to the size IPOPT's own constants are
# made for. A factor on the objective changes no optimum.
_LARGEST_CURVATURE = 1e4
# IPOPT satisfies constraints to 1e-10; limits are drawn in by more than that, so that they hold exactly.
_RELATIVE_MARGIN = 1e-8
MARGIN = 2e-10


def speed_matrix(time: Array) -> sp.csr_array:
    """D with (D q)_k = (q_{k+1} - q_k)/h_k, h_k = t_{k+1} - t_k.

    Args:
        time: Time stamps, shape (n,), in [s].

    Returns:
        Sparse matrix of shape (n - 1, n), in [1/s].

    Source:
        None (forward differences).
    """
    n = len(time)
    shift = sp.eye_array(n - 1, n, k=1) - sp.eye_array(n - 1, n)
    return sp.csr_array(sp.diags_array(1.0 / np.diff(time)) @ shift)


def acceleration_matrix(time: Array) -> sp.csr_array:
    """D2 with (D2 q)_k = (v_k - v_{k-1})/½(h_{k-1} + h_k) for the inner samples k = 1 … n-2.

    Args:
        time: Time stamps, shape (n,), in [s].

    Returns:
        Sparse matrix of shape (max(n - 2, 0), n), in [1/s²].

    Source:
        None (second divided differences).
    """
    n = len(time)
    if n < 3:
        return sp.csr_array((0, n))
    speed = speed_matrix(time)
    spacing = 0.5 * (time[2:] - time[:-2])
    return sp.csr_array(sp.diags_array(1.0 / spacing) @ (speed[1:] - speed[:-1]))


def sample_durations(time: Array) -> Array:
    """The share of time each sample stands for (trapezoidal rule).

    Args:
        time: Time stamps, shape (n,), in [s].

    Returns:
        Shape (n,), in [s]; they add up to the duration.

    Source:
        None (trapezoidal rule).
    """
    half = 0.5 * np.diff(time)
    durations: Array = np.concatenate([half, [0.0]]) + np.concatenate([[0.0], half])
    return durations


def smoothness_matrix(
    time: Array, speed_weight: float, acceleration_weight: float, posture_weight: float
) -> sp.csr_array:
    """K with ½ qᵀ K q = ½ ∫ speed_weight·q̇² + acceleration_weight·q̈² + posture_weight·q² dt.

    Samples nearer to each other than a tenth of the median spacing count as that far apart: 1/h³ of a
    stray time stamp would otherwise drown everything else.

    Args:
        time: Time stamps, shape (n,), in [s].
        speed_weight: Weight of squared speed.
        acceleration_weight: Weight of squared acceleration, in [s²].
        posture_weight: Weight of the squared angle, in [1/s²].

    Returns:
        Symmetric, five bands, shape (n, n).

    Source:
        None (this package).
    """
    rows = smoothness_rows(time, speed_weight, acceleration_weight, posture_weight)
    return sp.csr_array(rows.T @ rows)


def smoothness_rows(
    time: Array, speed_weight: float, acceleration_weight: float, posture_weight: float
) -> sp.csr_array:
    """S with SᵀS = K of `smoothness_matrix`: the objective as a sum of squares, which rounding spares.

    Args:
        time: As for `smoothness_matrix`, in [s].
        speed_weight: As for `smoothness_matrix`.
        acceleration_weight: As for `smoothness_matrix`, in [s²].
        posture_weight: As for `smoothness_matrix`, in [1/s²].

    Returns:
        The rows of `smoothness_weights`, one kind after the other, shape (n - 1 + max(n - 2, 0) + n, n).

    Source:
        None (this package).
    """
    return rows_of_weights(*smoothness_weights(time, speed_weight, acceleration_weight, posture_weight))


def rows_of_weights(speed: Array, bend: Array, hold: Array) -> sp.csr_array:
    """The squares of `smoothness_weights` as rows of a matrix, one kind after the other.

    Args:
        speed: Factors of differences, shape (n - 1,).
        bend: Factors of three neighbours, shape (max(n - 2, 0), 3).
        hold: Factors of single samples, shape (n,).

    Returns:
        Shape (n - 1 + max(n - 2, 0) + n, n).

    Source:
        None (bookkeeping).
    """
    n = len(hold)
    rows = [_banded([-speed, speed], n), *([_banded(list(bend.T), n)] if n >= 3 else [])]
    return sp.csr_array(sp.vstack([*rows, sp.diags_array(hold)]))


def smoothness_weights(
    time: Array, speed_weight: float, acceleration_weight: float, posture_weight: float
) -> tuple[Array, Array, Array]:
    """The three kinds of squares of the objective.

    √(w_v/h_k)·(q_{k+1} - q_k);  √(w_a s_k)·(D2 q)_k by three factors;  √(w_p d_k)·q_k.

    Args:
        time: As for `smoothness_matrix`, in [s].
        speed_weight: As for `smoothness_matrix`.
        acceleration_weight: As for `smoothness_matrix`, in [s²].
        posture_weight: As for `smoothness_matrix`, in [1/s²].

    Returns:
        Factors, shapes (n - 1,), (max(n - 2, 0), 3) and (n,).

    Source:
        None (this package).
    """
    spacing = np.diff(time)
    h = np.maximum(spacing, _NEAREST * np.median(spacing)) if spacing.size else spacing
    share = 0.5 * (h[:-1] + h[1:])
    factor = np.sqrt(acceleration_weight / share)
    bend = np.column_stack([factor / h[:-1], -factor * (1 / h[:-1] + 1 / h[1:]), factor / h[1:]])
    return np.sqrt(speed_weight / h), bend, np.sqrt(posture_weight * sample_durations(time))


def objective_scale(curvature: float) -> float:
    """The factor that brings an objective to the size IPOPT is made for.

    Args:
        curvature: Largest second derivative over one angle.

    Returns:
        At most 1.

    Source:
        None (this package).
    """
    return _LARGEST_CURVATURE / max(_LARGEST_CURVATURE, curvature)


def drawn_in(limit: Array) -> Array:
    """Limits on rates as IPOPT gets them, so that those that were asked for hold exactly.

    Args:
        limit: Limits on speed or acceleration, of any shape.

    Returns:
        Smaller ones, of the same shape.

    Source:
        None (this package).
    """
    return np.asarray(np.maximum(limit * (1 - _RELATIVE_MARGIN) - MARGIN, 0.5 * limit))


def _banded(bands: list[Array], n: int) -> sp.csr_array:
    """Row k holds the k-th entry of every band, from column k on."""
    rows, count = len(bands[0]), len(bands)
    columns = np.arange(rows)[:, None] + np.arange(count)
    pointers = np.arange(rows + 1) * count
    return sp.csr_array((np.column_stack(bands).ravel(), columns.ravel(), pointers), shape=(rows, n))
