"""Rigid transforms as 4×4 NumPy matrices."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.exact_angle import cos_sin
from armik_sym.errors import ArmModelError

_TOLERANCE = 1e-9


def rotation_x(angle: float) -> NDArray[np.float64]:
    """Rx(angle): the rotation about x.

    Args:
        angle: Angle in [rad].

    Returns:
        Homogeneous transform, shape (4, 4).

    Source:
        None (elementary).
    """
    c, s = cos_sin(angle)
    return np.array([[1.0, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])


def check_rigid(transform: ArrayLike, what: str) -> NDArray[np.float64]:
    """Return a read-only copy of a rigid transform, refuse anything else.

    Rᵀ R = I and det R = +1 to 1e-9, last row (0, 0, 0, 1).

    Args:
        transform: The matrix, shape (4, 4); lengths in [m].
        what: What it is, for the message ("base", "tool").

    Returns:
        A read-only float64 copy, shape (4, 4).

    Raises:
        ArmModelError: If the matrix is not a rigid transform.

    Source:
        None (definition of SE(3)).
    """
    try:
        T = np.array(transform, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArmModelError(f"{what} transform is not numeric, expected a 4×4 matrix") from None
    if T.shape != (4, 4) or not np.all(np.isfinite(T)):
        raise ArmModelError(f"{what} transform has shape {T.shape}, expected a finite 4×4 matrix")
    R = T[:3, :3]
    error = float(np.abs(R.T @ R - np.eye(3)).max())
    if error <= _TOLERANCE:
        error = max(error, abs(float(np.linalg.det(R)) - 1.0))
    if error > _TOLERANCE or np.abs(T[3] - [0, 0, 0, 1]).max() > 0:
        raise ArmModelError(
            f"{what} transform is not rigid: RᵀR differs from I, or det R from +1, by {error:.2g} "
            f"(allowed {_TOLERANCE:g}), and the last row must be 0 0 0 1"
        )
    T.flags.writeable = False
    return T
