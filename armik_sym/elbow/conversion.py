"""Eq. (8) on arrays: three device angles to three human angles and back."""

from __future__ import annotations

import functools
from collections.abc import Callable

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.elbow.checks import checked_angles
from armik_sym.elbow.nearest import along_path, nearest_of_two
from armik_sym.errors import ShapeError
from armik_sym.symbolic import elbow_direction
from armik_sym.symbolic.dense_function import evaluate_rows

Array = NDArray[np.float64]


def device_to_human(q: ArrayLike, neighbour: ArrayLike | None = None) -> Array:
    """Human shoulder angles q' with which the upper arm points and turns as it does with q.

    C(q') = H B(q) H, H = diag(-1, 1, -1): q'1 = atan2(-sin q2, cos q1 cos q2), q'2 = -acos(sin q1 cos q2),
    q'3 = atan2(B23, -B21). Every posture has two solutions, q' and (q'1 + 180°, -q'2, q'3 + 180°); where
    sin q'2 = 0 (the arm held straight out to a side, along y) only q'1 ± q'3 is determined.

    The branch of eq. (8) ends at 90° of abduction: 120° of pure abduction, q = (120°, 0, 0), comes out as
    flexion 180°, abduction 60°, rotation -180°. Give a neighbour, or use `human_posture`, which keeps to the
    range of motion. Close to the side, at 90° of abduction, any choice of angles changes by half a turn
    within a small movement (gimbal lock): a continuous path ends on the branch it happens to pass on.

    Args:
        q: Device angles q1, q2, q3, shape (n, 3) or (3,), in [rad].
        neighbour: Human angles close by, in [rad]. None: the branch of eq. (8), q'2 in [-π, 0], q'1 and q'3
            in [-π, π], q'1 = 0 where it is not determined. Shape (3,): a continuous path, the first sample
            nearest to the neighbour and every other nearest to the one before, over all branches and full
            turns; where q'1 is not determined it stays and q'3 takes up the change. Shape (n, 3): one
            neighbour for every sample.

    Returns:
        q', shape (n, 3) or (3,), in [rad].

    Raises:
        ShapeError: If `q` or `neighbour` has another shape, or an angle is not finite.

    Source:
        Nguyen 2021, eq. 8 (ledger: nguyen2021 8; as printed it solves nothing).
    """
    return _convert(q, neighbour, "device_to_human", other_human)


def human_to_device(q_human: ArrayLike, neighbour: ArrayLike | None = None) -> Array:
    """Device angles q with which the upper arm points and turns as it does with q': undoes `device_to_human`.

    B(q) = H C(q') H: q1 = atan2(B22, B12), q2 = atan2(-B32, √(B12² + B22²)). Every posture has two solutions,
    q and (q1 + 180°, 180° - q2, q3 + 180°); where cos q2 = 0 only q1 ± q3 is determined.

    Args:
        q_human: Human angles q'1, q'2, q'3, shape (n, 3) or (3,), in [rad].
        neighbour: Device angles close by, in [rad]. None: the branch q2 in [-π/2, π/2], q1 and q3 in
            [-π, π], q1 = 0 where it is not determined. Shape (3,): a continuous path, the first sample
            nearest to the neighbour and every other nearest to the one before, over all branches and full
            turns; where q1 is not determined it stays. Shape (n, 3): one neighbour for every sample.

    Returns:
        q, shape (n, 3) or (3,), in [rad].

    Raises:
        ShapeError: If `q_human` or `neighbour` has another shape, or an angle is not finite.

    Source:
        Nguyen 2021, eq. 8 inverted (ledger: nguyen2021 8).
    """
    return _convert(q_human, neighbour, "human_to_device", other_device)


def other_human(q_human: Array) -> Array:
    """The second solution of a posture of the human shoulder: (q'1 + π, -q'2, q'3 + π).

    Args:
        q_human: Human angles, shape (..., 3), in [rad].

    Returns:
        Human angles of the same matrix C, shape (..., 3), in [rad].

    Source:
        Nguyen 2021, eq. 7.
    """
    return np.stack([q_human[..., 0] + np.pi, -q_human[..., 1], q_human[..., 2] + np.pi], axis=-1)


def other_device(q: Array) -> Array:
    """The second solution of a posture of the device: (q1 + π, π - q2, q3 + π).

    Args:
        q: Device angles, shape (..., 3), in [rad].

    Returns:
        Device angles of the same matrix B, shape (..., 3), in [rad].

    Source:
        Nguyen 2021, eq. 5.
    """
    return q * (1, -1, 1) + np.pi


def _convert(
    angles: ArrayLike, neighbour: ArrayLike | None, name: str, other: Callable[[Array], Array]
) -> Array:
    given = checked_angles(angles, f"{name}, angles")
    rows = given.reshape(-1, 3)
    if neighbour is None:
        return _principal(name, rows, 0.0)[0].reshape(given.shape)
    near = checked_angles(neighbour, f"{name}, neighbour")
    if near.ndim == 2:
        if near.shape != rows.shape:
            raise ShapeError(
                f"{name}, neighbour: shape {near.shape}, expected (3,) or {rows.shape}, one per sample"
            )
        found, _ = _principal(name, rows, near[:, 0])
        return nearest_of_two(found, other(found), near).reshape(given.shape)
    found, size = _principal(name, rows, near[0])
    singular = np.flatnonzero(size < elbow_direction.SINGULAR)

    def again(k: int, first: float) -> Array:
        """Sample k once more, with the first angle that the sample before it ended with."""
        sample: Array = _principal(name, rows[k : k + 1], first)[0][0]
        return sample

    path = along_path(found, other(found), near, frozenset(singular.tolist()), again, other)
    return path.reshape(given.shape)


def _principal(name: str, rows: Array, first_if_singular: float | Array) -> tuple[Array, Array]:
    """The principal branch and the sine (cosine) that vanishes at the singularity."""
    first = np.broadcast_to(np.asarray(first_if_singular, dtype=np.float64), (len(rows),))
    out = evaluate_rows(_function(name), rows, first[:, np.newaxis])
    return np.ascontiguousarray(out[:, :3]), out[:, 3]


@functools.cache
def _function(name: str) -> ca.Function:
    angles, first = ca.SX.sym("angles", 3), ca.SX.sym("first")
    return ca.Function(name, [angles, first], [getattr(elbow_direction, name)(angles, first)])
