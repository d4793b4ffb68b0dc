"""Nguyen 2021, §2.2: the transform and the wrist position."""

from __future__ import annotations

import functools

import sympy as sp
from sympy import cos, pi, sin

from armik_sym.arm import DHConvention, DHLink
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.identity import Identity
from derivations.nguyen2021.chain import Q, frame, one_row
from derivations.random_points import largest_difference

PAPER = "nguyen2021"
_ROUNDING = 1e-9
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
    q1, q2, q3, q4 = Q[:4]
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


def check_transform(printed: sp.Matrix, corrected: sp.Matrix) -> Evidence:
    """Is the printed transform rigid, and is the corrected one the modified row of this package?

    Args:
        printed: The transform as printed, SymPy matrix of shape (4, 4).
        corrected: The transform with the smallest correction.

    Returns:
        The verdict.

    Source:
        Nguyen 2021, eq. 1.
    """
    if _is_rigid(printed) and _is_modified_row(printed):
        return Evidence(Verdict.HOLDS, _PROVED)
    at_point = printed.subs({_theta: 0, _alpha: pi / 2})
    verdict = Verdict.CORRECTED
    if not _is_rigid(corrected) or not _is_modified_row(corrected):
        verdict = Verdict.FALSE
    return Evidence(
        verdict,
        f"corrected form: {_PROVED}",
        f"at theta = 0, alpha = 90°: det R = {at_point[:3, :3].det()}, and a rotation has 1",
    )


_PROVED = (
    "RᵀR = I and det R = 1, reduced to zero over the rationals; equal to the modified row of "
    "`armik_sym.symbolic` for α = 0, 90° and -90° (Table 4), exactly and at 1,000 random points in CasADi"
)


def _is_rigid(T: sp.Matrix) -> bool:
    R = T[:3, :3]
    return all(is_exactly_zero(entry) for entry in R.T * R - sp.eye(3)) and is_exactly_zero(R.det() - 1)


def _is_modified_row(T: sp.Matrix) -> bool:
    for alpha in (0, pi / 2, -pi / 2):
        link = DHLink("row", d="d", a="a", alpha=float(alpha))
        row = one_row(link, DHConvention.MODIFIED, (_theta, _d, _a))
        here = T.subs(_alpha, alpha)
        exact = all(is_exactly_zero(x - y) for x, y in zip(here, row, strict=True))
        if not exact or largest_difference(here, row) > _ROUNDING:
            return False
    return True


CLAIMS = (
    Claim(
        PAPER,
        "1",
        "the transform of one DH row",
        Verdict.CORRECTED,
        "Printed in the layout of the modified (proximal) convention, but no rigid transform: its third row "
        "has a wrong factor and two wrong signs. The rest of the paper follows the standard convention.",
        Check(
            functools.partial(check_transform, printed_transform(), corrected_transform()),
            (Formula("T_{i-1}^i", printed_transform()),),
            (Formula("T_{i-1}^i", corrected_transform()),),
        ),
        derivation="The first two rows are those of Craig's modified transform; the third has to be normal "
        "to them. Read as modified rows, Table 4 misses eq. (3) by far (see there).",
        correction="third row sθ·sα, cθ·sα, cα, d·cα (a modified row); for Table 4, a standard row",
        extraction="the factors C a_i and S a_i, with a Latin a, are read as cos α_i and sin α_i: the text "
        "calls S and C sine and cosine, and the a_i at the end of the first row is a length",
        fault=Fault.MISPRINT,
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
        "The printed coordinates are those of the origin of frame 5, with Table 4 read as said there: "
        "standard rows, and d = 0 in row 2. If the device has the printed 7 mm, a term is missing here "
        "(see Table 4).",
        Identity(printed_position(), frame(5)[:3, 3], symbol="p"),
        derivation="p = (x_E, y_E, z_E) in millimetres: last column of T_0^5, standard rows, d = 0 in row 2.",
    ),
)
