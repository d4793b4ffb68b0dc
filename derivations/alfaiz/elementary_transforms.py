"""Homogeneous matrices in SymPy: the building blocks of eq. (1) and (2), and the model's own DH row."""

from __future__ import annotations

import casadi as ca
import sympy as sp
from sympy import cos, sin

from armik_sym.arm import DHConvention
from armik_sym.arm.dh import DHLink
from armik_sym.symbolic.link_transform import link_transform
from derivations.from_casadi import to_sympy


def homogeneous(R: sp.Matrix, p: sp.Matrix) -> sp.Matrix:
    """[R p; 0 1].

    Args:
        R: SymPy matrix of shape (3, 3).
        p: SymPy matrix of shape (3, 1).

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, eq. 1.
    """
    return sp.Matrix.vstack(sp.Matrix.hstack(R, p), sp.Matrix([[0, 0, 0, 1]]))


def rot_x(angle: sp.Expr) -> sp.Matrix:
    """Rotation about x.

    Args:
        angle: In [rad].

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Craig, Introduction to Robotics, ch. 2.
    """
    c, s = cos(angle), sin(angle)
    return homogeneous(sp.Matrix([[1, 0, 0], [0, c, -s], [0, s, c]]), sp.zeros(3, 1))


def rot_z(angle: sp.Expr) -> sp.Matrix:
    """Rotation about z.

    Args:
        angle: In [rad].

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Craig, Introduction to Robotics, ch. 2.
    """
    c, s = cos(angle), sin(angle)
    return homogeneous(sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]]), sp.zeros(3, 1))


def shift(x: sp.Expr, y: sp.Expr, z: sp.Expr) -> sp.Matrix:
    """Translation.

    Args:
        x: Along x.
        y: Along y.
        z: Along z.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, eq. 1.
    """
    return homogeneous(sp.eye(3), sp.Matrix([x, y, z]))


def modified_row(alpha: float, theta: sp.Expr, a: sp.Expr, d: sp.Expr) -> sp.Matrix:
    """One modified DH row, through `armik_sym.symbolic`.

    Args:
        alpha: A number, in [rad].
        theta: Joint angle, offset included, in [rad].
        a: Shift along x.
        d: Shift along z.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, eq. 2, through `armik_sym.symbolic`.
    """
    q, lengths = ca.SX.sym("q"), ca.SX.sym("lengths", 2)
    link = DHLink("row", alpha=alpha, a="a", d="d")
    T = link_transform(link, DHConvention.MODIFIED, q, {"a": lengths[0], "d": lengths[1]})
    return to_sympy(T, [q, lengths], [[theta], [a, d]])
