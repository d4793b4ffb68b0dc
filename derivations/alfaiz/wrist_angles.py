"""Al-Faiz, §3.1, eq. (39)-(47): the three angles of the wrist.

θ5, θ6, θ7 are the joint angles q5, q6, q7; θ6 is taken without the offset of Table 1, as in eq. (38).
"""

from __future__ import annotations

import sympy as sp
from sympy import atan, atan2, cos, pi, sin

from derivations.alfaiz.chain import Q
from derivations.alfaiz.facts import BranchWithFacts, Fact, IdentityWithFacts
from derivations.alfaiz.wrist_rotation import PAPER, wrist
from derivations.alfaiz.wrist_together import (
    a_quarter_is_reproduced,
    half_turns_never_cancel,
    reproduced,
    singular_at_right_angle,
)
from derivations.branch import Branch
from derivations.claim import Claim, Formula, Verdict
from derivations.exact_zero import is_exactly_zero

_q5, _q6, _q7 = Q[4:]
_R = sp.Matrix(wrist()[:3, :3])
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


PRINTED = {
    _q5: by_plain_arc_tangent(-_r33, _r13),
    _q6: sp.asin(_r23),
    _q7: by_plain_arc_tangent(-_r22, _r21),
}
CORRECTED = {
    _q5: atan2(-_branch * _r33, _branch * _r13),
    _q6: atan2(_r23, _branch * sp.sqrt(_r13**2 + _r33**2)),
    _q7: atan2(_branch * _r22, -_branch * _r21),
}


def wrong_at_minus_90(angle: sp.Symbol, printed: sp.Expr) -> bool:
    """Whether a printed angle is off by half a turn where the true one is exactly -90°.

    Args:
        angle: The angle.
        printed: The printed formula, in the true angles.

    Returns:
        True if it returns exactly +90° there.

    Source:
        None (exact substitution).
    """
    return bool(sp.simplify(printed.subs(angle, -pi / 2) - pi / 2) == 0)


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


_MINUS_90_TEXT = "at {0} = -90° exactly, where {1} = 0, the second case returns +90° (SymPy, exact)"

CLAIMS = (
    Claim(
        PAPER,
        "39",
        "sine of θ6",
        Verdict.HOLDS,
        "Exact, with θ6 = q6 (without the -π/2 of Table 1). The text says it compares (38) with (39); it "
        "compares (37) with (38).",
        IdentityWithFacts(
            sp.Matrix([sin(_q6)]), sp.Matrix([_r23]), shown=(Formula(r"\sin\theta_6", "r_{23}"),)
        ),
        derivation="Entry (2, 3) of the product of rows 5 to 7.",
    ),
    Claim(
        PAPER,
        "40",
        "θ6",
        Verdict.CORRECTED,
        "The arc sine returns one of two solutions, the one with |θ6| ≤ 90°; the other, 180° - θ6 with θ5 "
        "and θ7 half a turn on, is never found, although a joint limit may demand it. Near ±90° an arc "
        "sine also loses half the digits, and an r23 that rounding leaves just above 1 has no arc sine.",
        Branch(
            r"\theta_6",
            PRINTED[_q6],
            _q6,
            {_q5: _FULL_TURN, _q6: _FULL_TURN},
            printed_domain={_q6: _HALF_TURN},
            corrected=CORRECTED[_q6],
            printed_text=r"\sin^{-1} r_{23}",
            corrected_text=r"\operatorname{atan2}\left(r_{23},\ \sigma\sqrt{r_{13}^2 + r_{33}^2}\right),"
            r"\quad \sigma = \pm 1",
        ),
        derivation="From (41)-(42), r13² + r33² = cos²θ6; its root with either sign gives one solution each.",
        correction="atan2(r23, σ·√(r13² + r33²)); σ = +1 is the printed solution, σ = -1 the other",
    ),
    Claim(
        PAPER,
        "41-42",
        "entries that hold θ5",
        Verdict.HOLDS,
        "Exact.",
        IdentityWithFacts(
            sp.Matrix([cos(_q5) * cos(_q6), -cos(_q6) * sin(_q5)]),
            sp.Matrix([_r13, _r33]),
            shown=(Formula("r_{13}", r"c_5 c_6"), Formula("r_{33}", r"-c_6 s_5")),
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
            sp.Matrix([-_r33 / _r13]),
            shown=(Formula(r"\tan\theta_5", r"-\frac{r_{33}}{r_{13}}"),),
        ),
        derivation="(42) divided by (41); cos θ6 cancels.",
    ),
    Claim(
        PAPER,
        "44",
        "θ5",
        Verdict.CORRECTED,
        "Right for |θ5| < 90° only. Beyond that the plain arc tangent is half a turn off, and for r13 = 0 "
        "the printed π/2 misses -π/2. At cos θ6 = 0 it is 0/0: θ5 is then free.",
        BranchWithFacts(
            r"\theta_5",
            PRINTED[_q5],
            _q5,
            {_q5: _FULL_TURN, _q6: _FULL_TURN},
            printed_domain={_q5: _HALF_TURN},
            corrected=CORRECTED[_q5],
            printed_text=r"\begin{cases} \tan^{-1}\left(-\frac{r_{33}}{r_{13}}\right) & r_{13} \neq 0 \\ "
            r"\frac{\pi}{2} & r_{13} = 0 \end{cases}",
            corrected_text=r"\operatorname{atan2}\left(-\sigma r_{33},\ \sigma r_{13}\right)",
            facts=(Fact(_MINUS_90_TEXT.format("θ5", "r13"), lambda: wrong_at_minus_90(_q5, PRINTED[_q5])),),
        ),
        derivation="(41)-(42) give sine and cosine of θ5, each times cos θ6; σ is the sign of cos θ6 chosen "
        "in (40).",
        correction="atan2(-σ·r33, σ·r13), with σ = ±1 as in (40); no case for r13 = 0 is needed",
    ),
    Claim(
        PAPER,
        "45-46",
        "entries that hold θ7",
        Verdict.HOLDS,
        "Exact. The step is called step 6, as the one before.",
        IdentityWithFacts(
            sp.Matrix([-cos(_q6) * cos(_q7), cos(_q6) * sin(_q7)]),
            sp.Matrix([_r21, _r22]),
            shown=(Formula("r_{21}", r"-c_6 c_7"), Formula("r_{22}", r"c_6 s_7")),
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
            printed_text=r"\begin{cases} \tan^{-1}\left(-\frac{r_{22}}{r_{21}}\right) & r_{21} \neq 0 \\ "
            r"\frac{\pi}{2} & r_{21} = 0 \end{cases}",
            corrected_text=r"\operatorname{atan2}\left(\sigma r_{22},\ -\sigma r_{21}\right)",
            facts=(
                Fact(_MINUS_90_TEXT.format("θ7", "r21"), lambda: wrong_at_minus_90(_q7, PRINTED[_q7])),
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
        derivation="(45)-(46) give cosine and sine of θ7, each times cos θ6; σ is the sign of cos θ6 chosen "
        "in (40).",
        correction="atan2(σ·r22, -σ·r21), with σ = ±1 as in (40); no case for r21 = 0 is needed",
    ),
)
