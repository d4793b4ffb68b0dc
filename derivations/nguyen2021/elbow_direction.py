"""Nguyen 2021, §2.3: the elbow-direction matrices of device and human arm."""

from __future__ import annotations

import casadi as ca
import sympy as sp
from sympy import cos, pi, sin

from armik_sym.symbolic.elbow_direction import device_elbow_direction, human_elbow_direction
from derivations.claim import Claim, Fault, Verdict
from derivations.from_casadi import to_sympy
from derivations.identity import Identity
from derivations.nguyen2021.chain import Q

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
    # Not evaluated, so that it is shown as printed; SymPy would make -cos(q2) of it.
    s, c = sin(q2 - pi / 2, evaluate=False), cos(q2 - pi / 2, evaluate=False)
    return sp.Matrix(
        [
            [
                cos(q1) * cos(q3) * c - sin(q1) * sin(q3),
                cos(q1) * s,
                -cos(q3) * sin(q1) - cos(q1) * c * sin(q3),
            ],
            [
                cos(q1) * sin(q3) + cos(q3) * c * sin(q1),
                -sin(q1) * s,
                cos(q1) * cos(q3) - c * sin(q1) * sin(q3),
            ],
            [-cos(q3) * s, -c, sin(q3) * s],
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


def device_B() -> sp.Matrix:
    """B as derived: R_0^3 of the E-HMCS, the matrix `armik_sym.elbow` uses.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Nguyen 2021, Table 4, through `armik_sym.symbolic`.
    """
    q = ca.SX.sym("q", 3)
    return to_sympy(device_elbow_direction(q), [q], [Q[:3]])


def human_C() -> sp.Matrix:
    """C as derived: H R_0^3 H of the catalogue's human arm, H = diag(-1, 1, -1).

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Nguyen 2021, eq. 6-7, through `armik_sym.symbolic`.
    """
    q_human = ca.SX.sym("q_human", 3)
    return to_sympy(human_elbow_direction(q_human), [q_human], [P])


CLAIMS = (
    Claim(
        PAPER,
        "4-5",
        "elbow-direction matrix B of the E-HMCS",
        Verdict.CORRECTED,
        "B is the rotation R_0^3 of frame 3, but for the sign of B12; as printed it is no rotation at all, "
        "so a routine that orthonormalises it hides the misprint. Its second column points from the elbow "
        "to the shoulder.",
        Identity(printed_B(), device_B(), corrected_B(), symbol="B"),
        derivation="Rotation of the third frame of Table 4, rows read as standard ones.",
        correction="B12 = -cos(q1)·sin(q2 - π/2), that is cos(q1)·cos(q2)",
        extraction="the line for B22 runs on into the expression of B23; its first half is B22. "
        'The matrix is called A_3 in (4) and B3 in the condition "B3 = C3" below (7); its entries are B11 to '
        "B33, so both names are taken for this B",
        fault=Fault.MISPRINT,
    ),
    Claim(
        PAPER,
        "6-7",
        "elbow-direction matrix C of the human arm",
        Verdict.HOLDS,
        "C is a rotation, Ry(-q'1) Rz(-q'2) Ry(-q'3): flexion about y comes first, then abduction, then the "
        "turn of the upper arm. In anatomical angles: flexion = -q'1, abduction = q'2 + 90°, internal "
        "rotation = q'3 - 90°.",
        Identity(printed_C(), human_C(), symbol="C"),
        derivation="H R_0^3 H of the catalogue's human arm, H = diag(-1, 1, -1) a half turn about y: the "
        "zero of q' is the arm hanging down, in a base that is turned by half a turn.",
    ),
)
