"""The vector l of Al-Faiz, eq. (53), and where a Newton step with it leads."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import sympy as sp

from derivations.alfaiz.chain import Q, frame
from derivations.alfaiz.target_pose import current_rotation, geometric_jacobian, hand, target_rotation
from derivations.exact_zero import is_exactly_zero

_DEGREE = np.pi / 180

# The printed l is the right one, reflected at the plane with this normal.
MIRROR_NORMAL = sp.Matrix([1, 0, 1]) / sp.sqrt(2)
MIRROR = sp.eye(3) - 2 * MIRROR_NORMAL * MIRROR_NORMAL.T


def printed_l(RT: sp.Matrix) -> sp.Matrix:
    """Eq. (53) as printed.

    Args:
        RT: The matrix R^d R(θ)ᵀ of eq. (52), or anything linear in its place.

    Returns:
        SymPy matrix of shape (3, 1).

    Source:
        Al-Faiz, eq. 53.
    """
    return sp.Matrix([RT[0, 1] - RT[1, 0], RT[0, 2] - RT[2, 0], RT[1, 2] - RT[2, 1]])


def corrected_l(RT: sp.Matrix) -> sp.Matrix:
    """Eq. (53) in the order x, y, z, every entry with its sign.

    Args:
        RT: As for `printed_l`.

    Returns:
        SymPy matrix of shape (3, 1).

    Source:
        Siciliano et al., Robotics (2009), eq. 2.27-2.28.
    """
    return sp.Matrix([RT[2, 1] - RT[1, 2], RT[0, 2] - RT[2, 0], RT[1, 0] - RT[0, 1]])


def difference_rotation() -> sp.Matrix:
    """RT = R^d R(θ)ᵀ of eq. (52) for a target turned by δ.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Al-Faiz, eq. 52, through the chain.
    """
    return sp.Matrix(target_rotation() * current_rotation().T)


def vanishes(matrix: sp.Matrix) -> bool:
    """Whether all entries of a matrix are exactly zero.

    Args:
        matrix: SymPy matrix.

    Returns:
        True if so.

    Source:
        None (exact proof).
    """
    return all(is_exactly_zero(sp.sympify(entry)) for entry in matrix)


def is_mirrored(l: Callable[[sp.Matrix], sp.Matrix], mirror: sp.Matrix) -> bool:
    """Whether an l is the right one times a matrix, and its derivative at the target minus that times J_ω.

    Args:
        l: The vector as a function of RT.
        mirror: The matrix.

    Returns:
        True if l = mirror · (right l) for every RT, and ∂(l/2)/∂θ = -mirror · J_ω where R(θ) = R^d, exactly.

    Source:
        Al-Faiz, eq. 52-53. Where R(θ) = R^d the factor before l in eq. (51) is 1/2.
    """
    RT = sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"r_{i + 1}{j + 1}"))
    R = sp.Matrix(frame(3)[:3, :3])
    slopes = sp.Matrix.hstack(*[l(R * R.diff(q).T) / 2 for q in Q[:3]])
    J = sp.Matrix(geometric_jacobian()[3:, :3])
    return vanishes(l(RT) - mirror * corrected_l(RT)) and vanishes(slopes + mirror * J)


def after_one_step(l: Callable[[sp.Matrix], sp.Matrix], axis: sp.Matrix, degrees: float) -> float:
    """How far the hand is from the target after one Newton step with the geometric Jacobian.

    Args:
        l: The vector as a function of RT.
        axis: Unit axis of the misalignment in the base frame.
        degrees: Its angle, in [°].

    Returns:
        Angle between hand and target after the step q + J_ω⁺ c, in [°].

    Source:
        Al-Faiz, eq. 50-55.
    """
    q = np.array([0.3, 0.5, -0.4, 1.0, 0.2, 0.4, -0.6])
    R, J = (np.array(value) for value in hand()(q)[1:])
    a = np.array(axis, dtype=float).ravel()
    target = turned(a, degrees * _DEGREE) @ R
    vector = np.array(l(sp.Matrix(target @ R.T)), dtype=float).ravel()
    c = degrees * _DEGREE * vector / np.linalg.norm(vector)
    reached = np.array(hand()(q + np.linalg.pinv(J[3:]) @ c)[1])
    return float(np.arccos(np.clip((np.trace(target @ reached.T) - 1) / 2, -1, 1)) / _DEGREE)


def turned(a: np.ndarray, angle: float) -> np.ndarray:
    """Rotation about a unit axis.

    Args:
        a: Axis, shape (3,).
        angle: In [rad].

    Returns:
        Rotation matrix, shape (3, 3).

    Source:
        Rodrigues.
    """
    K = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def growth(l: Callable[[sp.Matrix], sp.Matrix], degrees_from_normal: int) -> float:
    """By how much one Newton step with the geometric Jacobian changes a misalignment of 10°.

    Args:
        l: The vector as a function of RT.
        degrees_from_normal: Angle of its axis with the normal of the mirror, in [°].

    Returns:
        Misalignment after the step over misalignment before.

    Source:
        Al-Faiz, eq. 50-55.
    """
    angle = sp.rad(degrees_from_normal)
    axis = sp.cos(angle) * MIRROR_NORMAL + sp.sin(angle) * sp.Matrix([0, 1, 0])
    return after_one_step(l, axis, 10) / 10
