"""Al-Faiz, eq. (24) to (35): the second shoulder angle from a linear system."""

from __future__ import annotations

import sympy as sp
from sympy import atan, atan2, cos, pi, sin

from derivations.alfaiz.chain import L3, L4, Q, frame
from derivations.alfaiz.elbow_angle import printed_cosine
from derivations.alfaiz.facts import BranchWithFacts, IdentityWithFacts
from derivations.alfaiz.letters import in_angles, in_letters
from derivations.alfaiz.shoulder_position import DY, K2, of_the_arm
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.identity import Identity

PAPER = "alfaiz"
_q2, _q3, _q4 = Q[1:4]
_k3, _k4, _k5, _k6 = sp.symbols("k_3:7", real=True)
_K2_AND_DY = sp.Matrix([K2, DY])
_HALF = (-pi / 2, pi / 2)


def printed_k3() -> sp.Expr:
    """The first coefficient.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 26.
    """
    return L3 * cos(_q4) * cos(_q3) + L4 * cos(_q3)


def printed_k4() -> sp.Expr:
    """The second coefficient.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 27.
    """
    return L3 * sin(_q4)


def printed_system(k3: sp.Expr, k4: sp.Expr) -> sp.Matrix:
    """The matrix of eq. (30).

    Args:
        k3: First coefficient.
        k4: Second coefficient.

    Returns:
        SymPy matrix of shape (2, 2).

    Source:
        Al-Faiz, eq. 30.
    """
    return sp.Matrix([[k3, k4], [k4, -k3]])


def k2_and_dy() -> sp.Matrix:
    """What the system must give: k2 and dy of the chain.

    Returns:
        SymPy matrix of shape (2, 1).

    Source:
        Al-Faiz, eq. 10 and 23, through `armik_sym.symbolic`.
    """
    return of_the_arm(_K2_AND_DY)


def printed_rearrangement() -> sp.Matrix:
    """Eq. (24) and (25), written out.

    Returns:
        SymPy matrix of shape (2, 1).

    Source:
        Al-Faiz, eq. 24-25.
    """
    s, c = sin(_q2), cos(_q2)
    along = L3 * cos(_q4) * cos(_q3) + L4 * cos(_q3)
    return sp.Matrix([s * along + c * L3 * sin(_q4), -c * along + s * L3 * sin(_q4)])


def k5_and_k6() -> sp.Matrix:
    """Eq. (32): the inverse of the printed matrix times k2, dy of the chain.

    Returns:
        SymPy matrix of shape (2, 1).

    Source:
        Al-Faiz, eq. 32.
    """
    return sp.Matrix(printed_system(printed_k3(), printed_k4()).inv() * k2_and_dy())


def singular_distance() -> sp.Expr:
    """Squared distance of the wrist from the axis of joint 2.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 3, through `armik_sym.symbolic`.
    """
    p, axis = frame(5)[:3, 3], frame(2)[:3, 2]
    return p.dot(p) - p.dot(axis) ** 2


def norm_for_any_target() -> sp.Expr:
    """k2² + dy² - (k3² + k4²) for a target, with (6) and (22) in it: zero if k5² + k6² = 1.

    Returns:
        SymPy expression in r, φ, dy and the lengths.

    Source:
        Al-Faiz, eq. 6, 14, 22, 26 and 27.
    """
    r, phi, dy = sp.symbols("r phi dy", real=True)
    elbow = printed_cosine(r**2 + dy**2)
    reach = L3 * elbow + L4
    k3_squared = reach**2 * (1 - (r * cos(phi) / reach) ** 2)
    k4_squared = L3**2 * (1 - elbow**2)
    return (r * sin(phi)) ** 2 + dy**2 - k3_squared - k4_squared


def check_system(matrix: sp.Matrix) -> Evidence:
    """Eq. (30) to (32): the system, when it can be inverted, and the length of its solution.

    Args:
        matrix: The matrix in k3, k4 of the arm.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 30-32.
    """
    found = Identity(sp.Matrix(matrix * sp.Matrix([sin(_q2), cos(_q2)])), k2_and_dy()).check()
    if found.verdict is not Verdict.HOLDS:
        return found
    if not is_exactly_zero(matrix.det() + singular_distance()):
        return Evidence(Verdict.FALSE, "the determinant is not minus the squared distance from axis 2")
    if not is_exactly_zero(norm_for_any_target()):
        return Evidence(Verdict.FALSE, "k5² + k6² is not 1")
    return Evidence(
        Verdict.HOLDS,
        f"{found.proof}; det = -(k3² + k4²) = -(distance of the wrist from axis 2)², exactly; "
        "k5² + k6² = 1 for every target and every φ with (6) and (22), exactly",
    )


def printed_theta2(k5: sp.Expr, k6: sp.Expr) -> sp.Expr:
    """Eq. (35) as printed.

    Args:
        k5: sin θ2.
        k6: cos θ2.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 35.
    """
    return sp.Piecewise((atan(k5 / k6), sp.Ne(k6, 0)), (pi / 2, True))


def theta2_branch() -> BranchWithFacts:
    """Eq. (35) with k5, k6 as (33), (34) have them.

    Returns:
        The claim.

    Source:
        Al-Faiz, eq. 33-35.
    """
    return BranchWithFacts(
        r"\theta_2",
        printed_theta2(sin(_q2), cos(_q2)),
        _q2,
        {_q2: (-pi, pi)},
        {_q2: _HALF},
        atan2(sin(_q2), cos(_q2)),
        printed_text=printed_theta2(_k5, _k6),
        corrected_text=atan2(_k5, _k6),
        inputs={"k5": sin(_q2), "k6": cos(_q2)},
        borders=({_q2: pi / 2}, {_q2: -pi / 2}),
        example={_q2: pi},
    )


_SIDES = sp.latex(printed_system(_k3, _k4), mat_delim="[")
_RIGHT = sp.latex(_K2_AND_DY, mat_delim="[")

CLAIMS = (
    Claim(
        PAPER,
        "24-25",
        "k2 and height, sorted by θ2",
        Verdict.HOLDS,
        "Two equations, linear in s2 and c2, with θ2 = q2 (no offset).",
        IdentityWithFacts(
            printed_rearrangement(),
            k2_and_dy(),
            names=_K2_AND_DY,
            names_first=False,
        ),
        derivation="Eq. (10) and (23), sorted.",
    ),
    Claim(
        PAPER,
        "26-27",
        "the coefficients k3 and k4",
        Verdict.DEFINITION,
        "Two abbreviations, known once θ3 and θ4 are. k3 takes the sign of cos θ3: the two branches of θ3 "
        "lead to different θ2.",
        definition=(Formula("k_3", in_letters(printed_k3())), Formula("k_4", in_letters(printed_k4()))),
    ),
    Claim(
        PAPER,
        "28-29",
        "the same with k3 and k4",
        Verdict.HOLDS,
        "The text says that (26), (27) go into (25), (26); it means (24), (25).",
        IdentityWithFacts(
            printed_system(printed_k3(), printed_k4()) * sp.Matrix([sin(_q2), cos(_q2)]),
            k2_and_dy(),
            names=_K2_AND_DY,
            names_first=False,
            letters=lambda form: in_letters(form, {printed_k3(): _k3, printed_k4(): _k4}),
        ),
        derivation="Eq. (26), (27) in (24), (25).",
    ),
    Claim(
        PAPER,
        "30-32",
        "solving for s2 and c2",
        Verdict.HOLDS,
        "The matrix can be inverted unless the wrist lies on the axis of joint 2 (arm straight, or folded, "
        "along that axis), where θ2 is free. No inversion is needed: the matrix is its own inverse but "
        "for the factor k3² + k4². k5² + k6² = 1 holds by itself.",
        Check(
            lambda: check_system(printed_system(printed_k3(), printed_k4())),
            printed=(
                Formula(_SIDES + r"\begin{bmatrix} s_2 \\ c_2 \end{bmatrix}", _RIGHT),
                Formula(r"\begin{bmatrix} k_5 \\ k_6 \end{bmatrix}", _SIDES + "^{-1}" + _RIGHT),
            ),
        ),
        derivation="Eq. (28), (29) as a matrix equation. For the length of (k5, k6), cos θ4 of (6) and "
        "sin θ3 of (22) are put into k3² + k4² for arbitrary r, φ, dy.",
    ),
    Claim(
        PAPER,
        "33-34",
        "sine and cosine of θ2",
        Verdict.HOLDS,
        "Hold wherever the matrix of (30) can be inverted.",
        IdentityWithFacts(
            sp.Matrix([sin(_q2), cos(_q2)]),
            k5_and_k6(),
            names=sp.Matrix([_k5, _k6]),
            names_first=False,
            letters=in_angles,
        ),
        derivation="Eq. (32) with k2 and dy of the chain.",
    ),
    Claim(
        PAPER,
        "35",
        "second shoulder angle",
        Verdict.CORRECTED,
        "Sine and cosine are both known and their signs are thrown away: for cos θ2 < 0 the result is half a "
        "turn off, and for k6 = 0 it is right only if k5 = +1. The wrist joints cannot "
        "make up for it; only another φ, one with cos θ2 > 0, can.",
        theta2_branch(),
        derivation="Eq. (33), (34): θ2 is the angle of the vector (k6, k5).",
        correction="θ2 = atan2(k5, k6)",
        fault=Fault.BRANCH,
    ),
)
