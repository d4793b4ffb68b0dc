"""Nguyen 2021, §2.3: the elbow-direction matrices of device and human arm."""

from __future__ import annotations

import sympy as sp
from sympy import cos, pi, sin

from armik_sym.arm.catalog import human
from armik_sym.symbolic import express
from derivations.claim import Claim, Verdict
from derivations.from_casadi import to_sympy
from derivations.identity import Identity
from derivations.nguyen2021.chain import Q, frame

PAPER = "nguyen2021"

# The angles q' of the human arm in eq. (7).
P = sp.symbols("p1:4", real=True)


def printed_B() -> sp.Matrix:
    """Eq. (5) as printed; of the line for B22, which holds two expressions, the first.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Nguyen 2021, eq. 4-5.
    """
    q1, q2, q3 = Q[:3]
    t = q2 - pi / 2
    return sp.Matrix(
        [
            [
                cos(q1) * cos(q3) * cos(t) - sin(q1) * sin(q3),
                cos(q1) * sin(t),
                -cos(q3) * sin(q1) - cos(q1) * cos(t) * sin(q3),
            ],
            [
                cos(q1) * sin(q3) + cos(q3) * cos(t) * sin(q1),
                -sin(q1) * sin(t),
                cos(q1) * cos(q3) - cos(t) * sin(q1) * sin(q3),
            ],
            [-cos(q3) * sin(t), -cos(t), sin(q3) * sin(t)],
        ]
    )


def corrected_B() -> sp.Matrix:
    """Eq. (5) with the sign of B12 mended: R_0^3 of the E-HMCS.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Nguyen 2021, eq. 5, corrected.
    """
    B = printed_B()
    B[0, 1] = -B[0, 1]
    return B


def printed_C() -> sp.Matrix:
    """Eq. (7) as printed, in the angles q' = p.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Nguyen 2021, eq. 6-7.
    """
    p1, p2, p3 = P
    return sp.Matrix(
        [
            [
                cos(p1) * cos(p2) * cos(p3) - sin(p1) * sin(p3),
                cos(p1) * sin(p2),
                -cos(p3) * sin(p1) - cos(p1) * cos(p2) * sin(p3),
            ],
            [-cos(p3) * sin(p2), cos(p2), sin(p2) * sin(p3)],
            [
                cos(p1) * sin(p3) + cos(p2) * cos(p3) * sin(p1),
                sin(p1) * sin(p2),
                cos(p1) * cos(p3) - cos(p2) * sin(p1) * sin(p3),
            ],
        ]
    )


def human_R_0_3() -> sp.Matrix:
    """R_0^3 of the catalogue's human arm in the angles of eq. (7), times diag(-1, 1, -1).

    flexion = 180° - q'1, abduction = q'2 + 90°, internal rotation = q'3 - 90°.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Nguyen 2021, eq. 6-7, through `armik_sym.symbolic`.
    """
    expressions = express(human())
    angles = [pi - P[0], P[1] + pi / 2, P[2] - pi / 2, *[sp.Integer(0)] * 4]
    lengths = [sp.Integer(0)] * 3
    T = to_sympy(expressions.frames[3], [expressions.q, expressions.lengths], [angles, lengths])
    return sp.Matrix(T[:3, :3] * sp.diag(-1, 1, -1))


CLAIMS = (
    Claim(
        PAPER,
        "4-5",
        "elbow-direction matrix B of the E-HMCS",
        Verdict.CORRECTED,
        "B is R_0^3, the rotation of frame 3, but for one sign; as printed it is no rotation.",
        Identity(printed_B(), sp.Matrix(frame(3)[:3, :3]), corrected_B(), symbol="B"),
        correction="B12 = -cos(q1)·sin(q2 - π/2)",
        extraction="the line for B22 runs on into the expression of B23; its first half is B22",
    ),
    Claim(
        PAPER,
        "6-7",
        "elbow-direction matrix C of the human arm",
        Verdict.HOLDS,
        "C is a rotation, Ry(-q'1) Rz(-q'2) Ry(-q'3), and equals R_0^3 diag(-1, 1, -1) of the catalogue's "
        "human arm with flexion = 180° - q'1, abduction = q'2 + 90°, internal rotation = q'3 - 90°.",
        Identity(printed_C(), human_R_0_3(), symbol="C"),
    ),
)
