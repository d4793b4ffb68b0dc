"""Al-Faiz, eq. (4) to (6): the elbow angle from the distance between shoulder and wrist."""

from __future__ import annotations

import sympy as sp
from sympy import acos, cos, pi

from armik_sym.arm.catalog import alfaiz
from derivations.alfaiz.chain import L3, L4, Q, frame
from derivations.alfaiz.letters import in_angles
from derivations.branch import Branch
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.identity import Identity

PAPER = "alfaiz"
_q4 = Q[3]
_tg = sp.Symbol("tg", positive=True)
_WHOLE_TURN = {_q4: (-pi, pi)}
_FLEXION = {_q4: (sp.Integer(0), pi)}


def squared_distance() -> sp.Expr:
    """dx² + dy² + dz² of the chain.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 4, through `armik_sym.symbolic`.
    """
    p = frame(5)[:3, 3]
    return p.dot(p)


def printed_distance() -> sp.Expr:
    """The right side of eq. (5) as printed.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 5.
    """
    return L4**2 + L3**2 - 2 * L4 * L3 * cos(_q4)


def corrected_squared_distance() -> sp.Expr:
    """The law of cosines for an elbow angle counted from the straight arm.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 5, corrected.
    """
    return L4**2 + L3**2 + 2 * L4 * L3 * cos(_q4)


def printed_cosine(tg2: sp.Expr) -> sp.Expr:
    """The argument of the arc cosine in eq. (6).

    Args:
        tg2: Squared distance.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 6.
    """
    return (tg2 - L4**2 - L3**2) / (2 * L4 * L3)


def check_distance(printed: sp.Expr, corrected: sp.Expr) -> Evidence:
    """Eq. (5) squared on both sides, against the chain.

    Args:
        printed: What is printed for tg.
        corrected: What tg² is.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 5.
    """
    true = sp.Matrix([squared_distance()])
    found = Identity(sp.Matrix([printed**2]), true, sp.Matrix([corrected])).check()
    if found.verdict is Verdict.CORRECTED:
        only_square = Identity(sp.Matrix([printed]), true).check()
        both_needed = only_square.verdict is not Verdict.HOLDS
        words = "; with the square but the printed sign it still fails" if both_needed else ""
        return Evidence(found.verdict, found.proof + words, _straight_arm(printed))
    return found


def _straight_arm(printed: sp.Expr) -> str:
    """The printed formula in its own inputs, the arm straight and both segments 1 long."""
    inputs = {L3: 1, L4: 1, _q4: 0}
    true = sp.sqrt(squared_distance().subs({**inputs, **dict.fromkeys(Q, 0)}))
    return f"at l4 = l3 = 1, θ4 = 0 (straight arm): printed tg = {printed.subs(inputs)}, true {true}"


def _no_elbow_flexes_backwards() -> bool:
    return bool(alfaiz().rom.lower[3] >= 0)


def check_elbow(cosine: sp.Expr) -> Evidence:
    """Eq. (6): its argument is cos θ4 exactly, its arc cosine θ4 in the range of a human elbow.

    Args:
        cosine: The argument of the arc cosine, in the symbol tg.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 6.
    """
    roots = {_tg: squared_distance()}
    found = Identity(sp.Matrix([cosine]), sp.Matrix([cos(_q4)]), roots=roots).check()
    if found.verdict is not Verdict.HOLDS:
        return found
    reach = (L4 + L3) ** 2 - _tg**2 - 2 * L4 * L3 * (1 - cosine)
    fold = _tg**2 - (L4 - L3) ** 2 - 2 * L4 * L3 * (1 + cosine)
    flexion = Branch(r"\theta_4", acos(cos(_q4)), _q4, _FLEXION).check()
    everywhere = Branch(r"\theta_4", acos(cos(_q4)), _q4, _WHOLE_TURN, _FLEXION).check()
    if not _no_elbow_flexes_backwards():
        return Evidence(Verdict.FALSE, "the range of motion contains -θ4", "θ4 < 0")
    if not (is_exactly_zero(reach) and is_exactly_zero(fold)) or flexion.verdict is not Verdict.HOLDS:
        return Evidence(Verdict.FALSE, "the arc cosine is not the elbow angle", flexion.counterexample)
    return Evidence(
        Verdict.HOLDS,
        f"the argument is cos θ4: {found.proof}; its arc cosine is θ4 for 0 ≤ θ4 ≤ π: {flexion.proof}; it "
        "lies within ±1 exactly if |l4 - l3| ≤ tg ≤ l4 + l3; the range of motion of the arm has θ4 ≥ 0; "
        "outside 0 … π the sign would be lost, " + everywhere.counterexample,
    )


CLAIMS = (
    Claim(
        PAPER,
        "4",
        "distance from shoulder to wrist",
        Verdict.DEFINITION,
        "tg names the distance of the target from the shoulder, not a tangent.",
        definition=(Formula("tg", r"\sqrt{dx^2 + dy^2 + dz^2}"),),
    ),
    Claim(
        PAPER,
        "5",
        "law of cosines",
        Verdict.CORRECTED,
        "Two slips: the square of tg is missing, and θ4 counts from the straight arm, which turns the sign "
        "in front of the cosine. Eq. (6) is solved from the correct form.",
        Check(
            lambda: check_distance(printed_distance(), corrected_squared_distance()),
            printed=(Formula("tg", in_angles(printed_distance())),),
            corrected=(Formula("tg^2", in_angles(corrected_squared_distance())),),
        ),
        derivation="The wrist position of the chain, squared: every angle but θ4 drops out. The angle "
        "inside the triangle is 180° - θ4.",
        correction="tg² for tg, +2·l4·l3·cos θ4 for -2·l4·l3·cos θ4",
        fault=Fault.MISPRINT,
    ),
    Claim(
        PAPER,
        "6",
        "elbow angle",
        Verdict.HOLDS,
        "Holds because no elbow flexes backwards: of the two solutions, θ4 and -θ4, only the printed one is "
        "inside the range of motion. The argument leaves ±1 exactly when the target is out of "
        "reach, so test it before taking the arc cosine.",
        Check(
            lambda: check_elbow(printed_cosine(_tg**2)),
            printed=(Formula(r"\theta_4", acos(printed_cosine(_tg**2))),),
        ),
        derivation="Eq. (5), corrected, solved for cos θ4.",
    ),
)
