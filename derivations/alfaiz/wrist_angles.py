"""Al-Faiz, §3.1, eq. (39)-(47): the three angles of the wrist.

θ5, θ6, θ7 are the joint angles q5, q6, q7; θ6 is taken without the offset of Table 1, as in eq. (38).
"""

from __future__ import annotations

import numpy as np
import sympy as sp
from sympy import atan, atan2, cos, pi, sin

from armik_sym.arm.catalog import alfaiz
from derivations.alfaiz.chain import Q
from derivations.alfaiz.exact_borders import Posture
from derivations.alfaiz.facts import BranchWithFacts, Fact, IdentityWithFacts
from derivations.alfaiz.letters import in_angles
from derivations.alfaiz.wrist_rotation import PAPER, wrist
from derivations.alfaiz.wrist_together import (
    a_quarter_is_reproduced,
    half_turns_never_cancel,
    is_second_solution,
    reproduced,
    singular_at_right_angle,
)
from derivations.branch import Branch
from derivations.claim import Claim, Fault, Verdict
from derivations.exact_zero import is_exactly_zero

_q5, _q6, _q7 = Q[4:]
_R = sp.Matrix(wrist()[:3, :3])
# The names of the entries, and σ, the sign of cos θ6.
_NAMES = sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"r_{i + 1}{j + 1}", real=True))
_SIGMA = sp.Symbol("sigma", real=True)
_r13, _r21, _r22, _r23, _r33 = _R[0, 2], _R[1, 0], _R[1, 1], _R[1, 2], _R[2, 2]
_FULL_TURN = (-pi, pi)
_HALF_TURN = (-pi / 2, pi / 2)
# Which of the two solutions for θ6 is taken: 1 for |θ6| < 90°, -1 for the other.
_branch = cos(_q6) / sp.Abs(cos(_q6))


def by_plain_arc_tangent(numerator: sp.Expr, denominator: sp.Expr) -> sp.Expr:
    """The pattern of eq. (44) and (47): a plain arc tangent, and π/2 where the denominator is zero.

    Args:
        numerator: Numerator, with its sign.
        denominator: Denominator.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 44 and 47.
    """
    return sp.Piecewise((atan(numerator / denominator), sp.Ne(denominator, 0)), (pi / 2, True))


def printed_angles(r: sp.Matrix) -> dict[sp.Symbol, sp.Expr]:
    """Eq. (40), (44) and (47) as printed.

    Args:
        r: The entries of the rotation, or their names, shape (3, 3).

    Returns:
        For q5, q6 and q7 the formula.

    Source:
        Al-Faiz, eq. 40, 44 and 47.
    """
    return {
        _q5: by_plain_arc_tangent(-r[2, 2], r[0, 2]),
        _q6: sp.asin(r[1, 2]),
        _q7: by_plain_arc_tangent(-r[1, 1], r[1, 0]),
    }


def corrected_angles(r: sp.Matrix, side: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """The same with every sign kept, for either solution.

    Args:
        r: The entries of the rotation, or their names, shape (3, 3).
        side: 1 for the solution with |θ6| < 90°, -1 for the other.

    Returns:
        For q5, q6 and q7 the formula.

    Source:
        Al-Faiz, eq. 40, 44 and 47, corrected.
    """
    return {
        _q5: atan2(-side * r[2, 2], side * r[0, 2]),
        _q6: atan2(r[1, 2], side * sp.sqrt(r[0, 2] ** 2 + r[2, 2] ** 2)),
        _q7: atan2(side * r[1, 1], -side * r[1, 0]),
    }


PRINTED, CORRECTED = printed_angles(_R), corrected_angles(_R, _branch)
_SHOWN, _SHOWN_CORRECTED = printed_angles(_NAMES), corrected_angles(_NAMES, _SIGMA)


def of_the_wrist(names: sp.Matrix) -> sp.Matrix:
    """What stands behind the names r_ij.

    Args:
        names: SymPy matrix in these names.

    Returns:
        The same in the joint angles.

    Source:
        Al-Faiz, eq. 37, through `armik_sym.symbolic`.
    """
    return names.subs(dict(zip(_NAMES, _R, strict=True)), simultaneous=True)


def _second_solution_out_of_range() -> bool:
    """|180° - θ6| ≥ 90° whenever |θ6| ≤ 90°; the range of motion of joint 6 has no more than ±90°."""
    rom, right_angle = alfaiz().rom, np.pi / 2 + 1e-9
    return bool(max(abs(rom.lower[5]), abs(rom.upper[5])) <= right_angle)


def _zero_denominators(angle: sp.Symbol) -> tuple[Posture, ...]:
    """±90°, in both solutions for θ6."""
    return tuple({angle: side * pi / 2, _q6: other} for other in (0, pi) for side in (1, -1))


def theta6_for_all_angles(form: sp.Expr) -> bool:
    """Whether a formula returns θ6 in all four quadrants.

    Args:
        form: The formula, in the true angles.

    Returns:
        True if it does, with 50 digits.

    Source:
        None (numerical test).
    """
    branch = Branch(r"\theta_6", form, _q6, {_q5: _FULL_TURN, _q6: _FULL_TURN})
    return branch.check().verdict is Verdict.HOLDS


def half_turn_off(numerator: sp.Expr, denominator: sp.Expr) -> bool:
    """Whether atan2 of two expressions is θ7 + 180° for every |θ6| < 90°.

    Args:
        numerator: First argument of atan2.
        denominator: Second argument.

    Returns:
        True if they are exactly sine and cosine of θ7 + 180°, each times cos θ6.

    Source:
        None (exact proof).
    """
    turned = _q7 + pi
    return is_exactly_zero(numerator - cos(_q6) * sin(turned)) and is_exactly_zero(
        denominator - cos(_q6) * cos(turned)
    )


_ENTRY_R23 = sp.Matrix([_NAMES[1, 2]])
_ENTRIES_Q5 = sp.Matrix([_NAMES[0, 2], _NAMES[2, 2]])
_ENTRIES_Q7 = sp.Matrix([_NAMES[1, 0], _NAMES[1, 1]])
_TANGENT_Q5 = sp.Matrix([-_NAMES[2, 2] / _NAMES[0, 2]])

CLAIMS = (
    Claim(
        PAPER,
        "39",
        "sine of θ6",
        Verdict.HOLDS,
        "Exact, with θ6 = q6 (without the -π/2 of Table 1). The text says it compares (38) with (39); it "
        "compares (37) with (38).",
        IdentityWithFacts(
            sp.Matrix([sin(_q6)]),
            of_the_wrist(_ENTRY_R23),
            names=_ENTRY_R23,
            names_first=False,
            letters=in_angles,
        ),
        derivation="Entry (2, 3) of the product of rows 5 to 7.",
    ),
    Claim(
        PAPER,
        "40",
        "θ6",
        Verdict.HOLDS,
        "Holds because no wrist bends by more than 90°: of the two solutions the arc sine returns the one "
        "with "
        "|θ6| ≤ 90°; the other, 180° - θ6 with θ5 and θ7 half a turn on, is outside the range of motion. "
        "Near "
        "±90° an arc sine loses half the digits, and an r23 that rounding leaves just above 1 has none: "
        "atan2(r23, σ·√(r13² + r33²)) is safer, and finds the other solution with σ = -1.",
        BranchWithFacts(
            r"\theta_6",
            PRINTED[_q6],
            _q6,
            {_q5: _FULL_TURN, _q6: _HALF_TURN},
            printed_text=_SHOWN[_q6],
            inputs={"r23": _r23},
            facts=(
                Fact(
                    "(θ5 + 180°, 180° - θ6, θ7 + 180°) turns the hand the same way (exact), outside the "
                    "range of "
                    "motion of θ6",
                    lambda: (
                        is_second_solution(_q5 + pi, pi - _q6, _q7 + pi) and _second_solution_out_of_range()
                    ),
                ),
                Fact(
                    "atan2(r23, σ·√(r13² + r33²)), σ the sign of cos θ6, is θ6 for all angles (50 digits)",
                    lambda: theta6_for_all_angles(CORRECTED[_q6]),
                ),
            ),
        ),
        derivation="(39) solved for θ6. From (41)-(42), r13² + r33² = cos²θ6.",
    ),
    Claim(
        PAPER,
        "41-42",
        "entries that hold θ5",
        Verdict.HOLDS,
        "Exact.",
        IdentityWithFacts(
            sp.Matrix([cos(_q5) * cos(_q6), -cos(_q6) * sin(_q5)]),
            of_the_wrist(_ENTRIES_Q5),
            names=_ENTRIES_Q5,
        ),
        derivation="Entries (1, 3) and (3, 3) of the product of rows 5 to 7.",
    ),
    Claim(
        PAPER,
        "43",
        "tangent of θ5",
        Verdict.HOLDS,
        "Exact wherever r13 ≠ 0. The division loses the signs of both entries, which tell the quadrant.",
        IdentityWithFacts(
            sp.Matrix([sp.tan(_q5)]),
            of_the_wrist(_TANGENT_Q5),
            names=_TANGENT_Q5,
            names_first=False,
            letters=in_angles,
        ),
        derivation="(42) divided by (41); cos θ6 cancels.",
    ),
    Claim(
        PAPER,
        "44",
        "θ5",
        Verdict.CORRECTED,
        "Right for |θ5| < 90° only. Beyond that the plain arc tangent is half a turn off, and for r13 = 0 "
        "the printed π/2 misses -π/2, the one failure inside a range of motion of ±90°. At cos θ6 = 0 it is "
        "0/0: θ5 is then free.",
        BranchWithFacts(
            r"\theta_5",
            PRINTED[_q5],
            _q5,
            {_q5: _FULL_TURN, _q6: _FULL_TURN},
            printed_domain={_q5: _HALF_TURN},
            corrected=CORRECTED[_q5],
            printed_text=_SHOWN[_q5],
            corrected_text=_SHOWN_CORRECTED[_q5],
            inputs={"r13": _r13, "r33": _r33, "θ6": _q6},
            borders=_zero_denominators(_q5),
            example={_q5: pi, _q6: 0},
        ),
        derivation="(41)-(42) give sine and cosine of θ5, each times cos θ6; σ is the sign of cos θ6.",
        correction="atan2(-σ·r33, σ·r13), with σ = +1 for θ6 of (40), -1 for 180° - θ6; no case for r13 = 0 "
        "is "
        "needed",
        fault=Fault.BRANCH,
    ),
    Claim(
        PAPER,
        "45-46",
        "entries that hold θ7",
        Verdict.HOLDS,
        "Exact. The step is called step 6, as the one before.",
        IdentityWithFacts(
            sp.Matrix([-cos(_q6) * cos(_q7), cos(_q6) * sin(_q7)]),
            of_the_wrist(_ENTRIES_Q7),
            names=_ENTRIES_Q7,
            names_first=False,
        ),
        derivation="Entries (2, 1) and (2, 2) of the product of rows 5 to 7.",
    ),
    Claim(
        PAPER,
        "47",
        "θ7",
        Verdict.CORRECTED,
        "Right for |θ7| < 90° only; for r21 = 0 the printed π/2 misses -π/2. Putting "
        "atan2(-r22, r21) for the arc tangent makes it worse: for |θ6| < 90° always half a turn off, as the "
        "minus sign belongs to r21. The losses in (44) and (47) do not make up for each other: (40), (44) "
        "and (47) together return the wanted hand orientation for one orientation in four.",
        BranchWithFacts(
            r"\theta_7",
            PRINTED[_q7],
            _q7,
            {_q6: _FULL_TURN, _q7: _FULL_TURN},
            printed_domain={_q7: _HALF_TURN},
            corrected=CORRECTED[_q7],
            printed_text=_SHOWN[_q7],
            corrected_text=_SHOWN_CORRECTED[_q7],
            inputs={"r22": _r22, "r21": _r21, "θ6": _q6},
            borders=_zero_denominators(_q7),
            example={_q7: pi, _q6: 0},
            facts=(
                Fact(
                    "-r22 and r21 are sine and cosine of θ7 + 180°, each times cos θ6 (exact)",
                    lambda: half_turn_off(-_r22, _r21),
                ),
                Fact(
                    "half a turn too many in θ5, in θ7 or in both always changes the rotation; half a turn "
                    "in both and 180° - θ6 never does (exact)",
                    half_turns_never_cancel,
                ),
                Fact(
                    "(40), (44), (47) reproduce the rotation if and only if |θ5| and |θ7| are below 90° in "
                    "the solution with |θ6| < 90°: a quarter of all orientations; the corrected forms "
                    "reproduce all (4,000 random orientations in CasADi)",
                    lambda: a_quarter_is_reproduced(PRINTED) and bool(reproduced(CORRECTED)[1].all()),
                ),
                Fact(
                    "at θ6 = ±90° r13, r33, r21, r22 are all zero and only θ5 ± θ7 is determined (exact)",
                    lambda: singular_at_right_angle(sp.Matrix([_r13, _r33, _r21, _r22])),
                ),
            ),
        ),
        derivation="(45)-(46) give cosine and sine of θ7, each times cos θ6; σ is the sign of cos θ6.",
        correction="atan2(σ·r22, -σ·r21), with σ = +1 for θ6 of (40), -1 for 180° - θ6; no case for r21 = 0 "
        "is "
        "needed",
        fault=Fault.BRANCH,
    ),
)
