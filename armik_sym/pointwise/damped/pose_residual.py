"""How far a hand is from its target: position difference and axis-angle vector, corrected or as printed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from armik_sym.motion.rotation_vector import rotation_vector

Array = NDArray[np.float64]


def pose_residual(
    target: Array, p: Array, R: Array, J: Array, rows: int, weight: float, printed: bool
) -> tuple[Array, Array]:
    """Residual of a pose and the rows of the Jacobian that change it: e = [p* - p; L·c(R* Rᵀ)].

    Args:
        target: Position and rotation row by row, shape (12,), in [m] and [1].
        p: Position of the hand, shape (3,), in [m].
        R: Rotation of the hand, shape (3, 3).
        J: Geometric Jacobian, shape (6, dof).
        rows: 6, or 3 where only the position counts.
        weight: Length L at which a turn of 1 rad counts like a shift, in [m].
        printed: Whether c is eq. 51-53 as printed.

    Returns:
        Residual, shape (rows,), in [m], infinite where the target is no rotation, and Jacobian rows, shape
        (rows, dof).

    Source:
        Al-Faiz, eq. 50-53.
    """
    shift = target[:3] - p
    if rows == 3:
        return shift, J[:3]
    E = target[3:].reshape(3, 3) @ R.T
    if not 2 < np.sum(E * E) < 4:  # 3 if it is a rotation
        return np.full(6, np.inf), J
    turn = printed_rotation_residual(E) if printed else rotation_vector(E)
    return np.concatenate([shift, weight * turn]), np.vstack([J[:3], weight * J[3:]])


def printed_rotation_residual(E: Array) -> Array:
    """Eq. 51 and 53 as printed: wrong signs and order of l, plain arc tangent, 0/0 read as 0.

    Args:
        E: Rotation from the hand to the target, shape (3, 3).

    Returns:
        Shape (3,), in [rad].

    Source:
        Al-Faiz, eq. 51 and 53, as printed; see `derivations/alfaiz/orientation_residual.py`.
    """
    l = np.array([E[0, 1] - E[1, 0], E[0, 2] - E[2, 0], E[1, 2] - E[2, 1]])  # noqa: E741 - the paper's name
    length, cosine = math.sqrt(float(l @ l)), float(np.trace(E)) - 1.0
    angle = math.atan(length / cosine) if abs(cosine) > 0 else 0.5 * math.pi
    return np.asarray(l * (angle / length if length > 0 else 0.0))
