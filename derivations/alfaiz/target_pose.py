"""A target whose residual is known: the hand, turned about the axis of one joint of the same arm.

Turning joint 3 from 0 to δ turns the hand by δ about that joint's axis, whatever the rest of the arm does.
The axis is the third column of the geometric Jacobian and takes every direction as q1 and q2 vary. So R^d Rᵀ
must have the axis-angle vector δ · axis.
"""

from __future__ import annotations

import functools

import casadi as ca
import sympy as sp

from armik_sym.arm.catalog import alfaiz
from armik_sym.symbolic import express
from derivations.alfaiz.chain import L3, L4, Q, frame
from derivations.from_casadi import to_sympy

TURN = sp.Symbol("delta", real=True)


@functools.cache
def geometric_jacobian() -> sp.Matrix:
    """Geometric Jacobian of the hand in the base frame, [v; ω] = J q̇.

    Returns:
        SymPy matrix of shape (6, 7).

    Source:
        Siciliano et al., Robotics (2009), eq. 3.30, through `armik_sym.symbolic`.
    """
    expressions = express(alfaiz())
    return to_sympy(expressions.jacobian, [expressions.q, expressions.lengths], [Q, (L4, L3)])


def current_rotation() -> sp.Matrix:
    """R(θ): frame 3 with joint 3 at 0.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Al-Faiz, eq. 3, through the chain.
    """
    return sp.Matrix(frame(3)[:3, :3].subs(Q[2], 0))


def target_rotation() -> sp.Matrix:
    """R^d: frame 3 with joint 3 at δ.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Al-Faiz, eq. 3, through the chain.
    """
    return sp.Matrix(frame(3)[:3, :3].subs(Q[2], TURN))


def turn_axis() -> sp.Matrix:
    """Axis of joint 3 in the base frame.

    Returns:
        Unit vector, SymPy matrix of shape (3, 1).

    Source:
        Siciliano et al., Robotics (2009), eq. 3.30, through `armik_sym.symbolic`.
    """
    return sp.Matrix(geometric_jacobian()[3:, 2])


@functools.cache
def hand() -> ca.Function:
    """Pose and geometric Jacobian of the hand with the catalogue's lengths, through CasADi.

    Returns:
        Function q → position (3, 1) in [m], rotation (3, 3), Jacobian (6, 7).

    Source:
        Al-Faiz, eq. 3, through `armik_sym.symbolic`.
    """
    expressions = express(alfaiz(), lengths="baked")
    outputs = [expressions.position, expressions.rotation, expressions.jacobian]
    return ca.Function("hand", [expressions.q], outputs)
