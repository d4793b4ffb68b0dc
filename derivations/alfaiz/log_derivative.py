"""How the axis-angle residual of Al-Faiz, eq. (50)-(53) corrected, changes with the joint angles.

∂c/∂q = -J_r⁻¹(c) J_ω, where J_r⁻¹(c) = I + [c]×/2 + (1/δ² - (1 + cos δ)/(2 δ sin δ)) [c]×² with δ = ‖c‖ is
the inverse right Jacobian of SO(3), and J_ω the angular part of the geometric Jacobian.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import sympy as sp
from sympy import cos, sin

from derivations.alfaiz.axis_angle import corrected_l, difference_rotation, turned, vanishes
from derivations.alfaiz.newton_step import residual
from derivations.alfaiz.target_pose import TURN, hand, turn_axis

# From the residual c and its length to the matrix M in ∂c/∂q = -M J_ω.
Factor = Callable[[sp.Matrix, sp.Expr], sp.Matrix]

POSTURES = 200
POSTURE = (0.3, 0.5, -0.4, 1.0, 0.2, 0.4, -0.6)
_ROUNDING = 1e-8


def cross_matrix(v: sp.Matrix) -> sp.Matrix:
    """[v]×, with [v]× w = v × w.

    Args:
        v: SymPy matrix of shape (3, 1).

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        None (definition).
    """
    return sp.Matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def inverse_right_jacobian(c: sp.Matrix, delta: sp.Expr) -> sp.Matrix:
    """The inverse right Jacobian of SO(3).

    Args:
        c: Axis-angle vector, SymPy matrix of shape (3, 1).
        delta: Its length, not 0.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Solà, Deray & Atchuthan, A micro Lie theory (2018), eq. 144.
    """
    K = cross_matrix(c)
    factor = 1 / delta**2 - (1 + cos(delta)) / (2 * delta * sin(delta))
    return sp.Matrix(sp.eye(3) + K / 2 + factor * K * K)


def is_derivative(factor: Factor) -> bool:
    """Whether c changes by -M ω when the hand turns with ω, for every axis, angle and ω.

    Args:
        factor: The statement, M.

    Returns:
        True if the three components agree exactly.

    Source:
        Al-Faiz, eq. 50-53, differentiated: (R^d Rᵀ)' = -R^d Rᵀ [ω]×, as R' = [ω]× R.
    """
    omega = sp.Matrix(sp.symbols("omega1:4", real=True))
    RT, axis = difference_rotation(), turn_axis()
    rate = -RT * cross_matrix(omega)
    angle_rate = -rate.trace() / (2 * sin(TURN))  # trace RT = 1 + 2 cos δ
    axis_rate = (corrected_l(rate) - 2 * cos(TURN) * angle_rate * axis) / (2 * sin(TURN))  # l = 2 sin δ axis
    stated = -factor(TURN * axis, TURN) * omega
    return vanishes(angle_rate * axis + TURN * axis_rate - stated)


def largest_miss(factor: Factor) -> float:
    """How far -M J_ω is from ∂c/∂q on the arm, both through CasADi.

    Args:
        factor: The statement, M.

    Returns:
        Largest difference at random postures and targets, misaligned by 6° to 170°.

    Source:
        Al-Faiz, eq. 50-53, corrected.
    """
    matrix = _compiled(factor)
    rng = np.random.default_rng(0)
    misses = []
    for q in rng.uniform(-np.pi, np.pi, (POSTURES, 7)):
        axis = rng.normal(size=3)
        e, D, J = _at(q, axis / np.linalg.norm(axis), rng.uniform(0.1, 2.97))
        misses.append(np.abs(D + np.array(matrix(e)) @ J).max())
    return float(max(misses))


def is_derivative_of_the_arm(factor: Factor) -> bool:
    """Whether the statement holds exactly, and on the arm in numbers.

    Args:
        factor: The statement, M.

    Returns:
        True if so.

    Source:
        Al-Faiz, eq. 50-53, corrected.
    """
    return is_derivative(factor) and largest_miss(factor) < _ROUNDING


def leaves_the_residual(factor: Factor) -> bool:
    """Whether M c = c and Mᵀ c = c, so that neither a Newton step nor the gradient feels M.

    Args:
        factor: The statement, M.

    Returns:
        True if so for every c, exactly.

    Source:
        Al-Faiz, eq. 55 and 61.
    """
    c = TURN * turn_axis()
    M = factor(c, TURN)
    return vanishes(M * c - c) and vanishes(M.T * c - c)


def distance_from_minus_geometric(degrees: float) -> float:
    """Largest entry of ∂c/∂q + J_ω at one posture, the target turned about the base's x axis.

    Args:
        degrees: Misalignment, in [°].

    Returns:
        The entry.

    Source:
        Al-Faiz, eq. 50-53, corrected; through CasADi.
    """
    _, D, J = _at(np.array(POSTURE), np.array([1.0, 0.0, 0.0]), float(np.deg2rad(degrees)))
    return float(np.abs(D + J).max())


def _at(q: np.ndarray, axis: np.ndarray, angle: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Orientation residual, its derivative and J_ω for a target turned from the hand."""
    p, R, _ = (np.array(value) for value in hand()(q))
    e, D, J = (np.array(value) for value in residual()(q, p, turned(axis, angle) @ R))
    return e[3:], D[3:], J[3:]


def _compiled(factor: Factor) -> ca.Function:
    names, c = sp.symbols("c1:4 delta", real=True), ca.SX.sym("c", 3)
    M = factor(sp.Matrix(names[:3]), names[3])
    functions = [{"sin": ca.sin, "cos": ca.cos}]
    values = [*ca.vertsplit(c), ca.norm_2(c)]
    rows = [
        ca.horzcat(*[ca.SX(sp.lambdify(names, x, functions)(*values)) for x in M[i, :]]) for i in range(3)
    ]
    return ca.Function("M", [c], [ca.vertcat(*rows)])
