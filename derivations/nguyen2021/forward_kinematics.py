"""Nguyen 2021, §2.2: the transform, the table, and the wrist position."""

from __future__ import annotations

import sympy as sp
from sympy import cos, pi, sin

from armik_sym.arm import DHConvention
from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.identity import Identity
from derivations.nguyen2021.chain import Q, frame
from derivations.random_points import largest_difference

PAPER = "nguyen2021"
_q1, _q2, _q3, _q4 = Q[:4]
_theta, _alpha, _a, _d = sp.symbols("theta alpha a d", real=True)


def printed_transform() -> sp.Matrix:
    """Eq. (1) as printed.

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Nguyen 2021, eq. 1.
    """
    c, s, ca, sa = cos(_theta), sin(_theta), cos(_alpha), sin(_alpha)
    return sp.Matrix(
        [
            [c, -s, 0, _a],
            [s * ca, c * ca, -sa, -_d * sa],
            [s * sa, s * sa, -ca, -_d * ca],
            [0, 0, 0, 1],
        ]
    )


def corrected_transform() -> sp.Matrix:
    """Eq. (1) with its third row mended: the modified (proximal) DH transform.

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Craig, Introduction to Robotics, eq. 3.6.
    """
    T = printed_transform()
    T[2, 1], T[2, 2], T[2, 3] = cos(_theta) * sin(_alpha), cos(_alpha), _d * cos(_alpha)
    return T


def printed_position() -> sp.Matrix:
    """Eq. (3) as printed, in [mm].

    Returns:
        SymPy matrix of shape (3, 1).

    Source:
        Nguyen 2021, eq. 3.
    """
    q1, q2, q3, q4 = _q1, _q2, _q3, _q4
    upper = sp.Rational(2869, 10)
    # Not evaluated, so that it is shown as printed; SymPy would make -cos(q2) of it.
    s2, c2 = sin(q2 - pi / 2, evaluate=False), cos(q2 - pi / 2, evaluate=False)
    x = (
        upper * cos(q1) * s2
        - 336 * sin(q4) * (sin(q1) * sin(q3) - cos(q1) * cos(q3) * c2)
        + 336 * cos(q1) * cos(q4) * s2
    )
    y = (
        upper * sin(q1) * s2
        + 336 * sin(q4) * (cos(q1) * sin(q3) + cos(q3) * c2 * sin(q1))
        + 336 * cos(q4) * sin(q1) * s2
    )
    z = upper * c2 + 336 * cos(q4) * c2 - 336 * cos(q3) * sin(q4) * s2 + 143
    return sp.Matrix([x, y, z])


def _is_rigid(T: sp.Matrix) -> bool:
    R = T[:3, :3]
    return all(is_exactly_zero(entry) for entry in R.T * R - sp.eye(3)) and is_exactly_zero(R.det() - 1)


def _check_transform() -> Evidence:
    if _is_rigid(printed_transform()):
        return Evidence(Verdict.HOLDS, "RᵀR = I and det R = 1, reduced to zero over the rationals")
    R = printed_transform().subs({_theta: 0, _alpha: pi / 2})
    determinant = R[:3, :3].det()
    verdict = Verdict.CORRECTED if _is_rigid(corrected_transform()) else Verdict.FALSE
    return Evidence(
        verdict,
        "corrected form: RᵀR = I and det R = 1, reduced to zero over the rationals",
        f"at theta = 0, alpha = 90°: det R = {determinant}, and a rotation has 1",
    )


def _check_table() -> Evidence:
    """Which reading of Table 4 gives eq. (3): conventions times row 2's d."""
    printed = printed_position()
    misses = {}
    for convention in DHConvention:
        for d2 in (0, 7):
            position = frame(5, convention, d2)[:3, 3]
            if all(is_exactly_zero(a - b) for a, b in zip(printed, position, strict=True)):
                misses[convention.value, d2] = 0.0
            else:
                misses[convention.value, d2] = largest_difference(printed, position)
    words = ", ".join(f"{name} rows with d2 = {d2}: {miss:.3g} mm" for (name, d2), miss in misses.items())
    only = [reading for reading, miss in misses.items() if miss == 0.0] == [("standard", 0)]
    return Evidence(
        Verdict.CORRECTED if only else Verdict.FALSE,
        f"largest miss of eq. (3) for each reading: {words}",
        "row 2 as printed (d = 7 mm) puts the wrist 7 mm off eq. (3) in every posture",
    )


# Rows of θ, d [mm], a [mm], α [°] as printed.
_TABLE_4 = Formula(
    r"(\theta,\ d,\ a,\ \alpha)",
    sp.Matrix(
        [
            [sp.Symbol("q_1"), 143, 0, 90],
            [90 - sp.Symbol("q_2"), 7, 0, -90],
            [sp.Symbol("q_3"), sp.Rational(2869, 10), 0, -90],
            [sp.Symbol("q_4"), 0, 0, 90],
            [90 + sp.Symbol("q_5"), 336, 0, 90],
            [90 + sp.Symbol("q_6"), 0, 0, -90],
            [sp.Symbol("q_7"), 0, 0, 0],
        ]
    ),
)

CLAIMS = (
    Claim(
        PAPER,
        "1",
        "the transform of one DH row",
        Verdict.CORRECTED,
        "Printed in the layout of the modified (proximal) convention, but no rigid transform: its third row "
        "has a wrong factor and two wrong signs. The rest of the paper follows the standard convention.",
        Check(
            _check_transform,
            (Formula("T_{i-1}^i", printed_transform()),),
            (Formula("T_{i-1}^i", corrected_transform()),),
        ),
        derivation="The first two rows are those of Craig's modified transform; the third has to be normal "
        "to them. Read as modified rows, Table 4 misses eq. (3) by far (see there).",
        correction="third row sθ·sα, cθ·sα, cα, d·cα (a modified row); for Table 4, a standard row",
    ),
    Claim(
        PAPER,
        "Table 4",
        "DH parameters of the E-HMCS",
        Verdict.CORRECTED,
        "Read as standard rows and with d = 0 in row 2 the table gives eq. (3) exactly; no other reading "
        "does.",
        Check(_check_table, (_TABLE_4,), (Formula("d_2", sp.Integer(0)),)),
        derivation="All four readings (standard or modified rows, d = 0 or 7 mm in row 2) are put through "
        "`armik_sym.symbolic` and compared with eq. (3).",
        correction="row 2: d = 0 instead of 7 mm; rows follow the standard convention, not eq. (1)",
    ),
    Claim(
        PAPER,
        "2",
        "the chain up to the wrist",
        Verdict.DEFINITION,
        "T_0^5 is the product of the first five row transforms; its last column is the wrist.",
        definition=(Formula("T_0^5", r"T_0^1 \times T_1^2 \times T_2^3 \times T_3^4 \times T_4^5"),),
    ),
    Claim(
        PAPER,
        "3",
        "position of the wrist",
        Verdict.HOLDS,
        "The printed coordinates are those of the origin of frame 5, with Table 4 read as above.",
        Identity(printed_position(), frame(5)[:3, 3], symbol="p"),
        derivation="p = (x_E, y_E, z_E) in millimetres: last column of T_0^5, standard rows, d = 0 in row 2.",
    ),
)
