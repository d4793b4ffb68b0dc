"""What φ of Al-Faiz means on the arm, and how it is tied to the swivel angle ψ of the elbow."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp
from sympy import cos, sin, tan

from derivations.alfaiz.chain import L3, L4, Q, frame
from derivations.alfaiz.letters import in_angles
from derivations.alfaiz.shoulder_position import derived_k
from derivations.alfaiz.swivel_numbers import BETA, GAMMA, POINTS, PSI, first_miss, first_miss_of_gamma
from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.identity import Identity

PAPER = "alfaiz"
_q3, _q4 = Q[2], Q[3]

# Numerator and denominator of tan φ, in sin ψ, cos ψ, sin β, cos β and tan γ.
Ratio = Callable[[sp.Expr, sp.Expr, sp.Expr, sp.Expr, sp.Expr], tuple[sp.Expr, sp.Expr]]


def tangent_of_phi(
    sin_psi: sp.Expr, cos_psi: sp.Expr, sin_beta: sp.Expr, cos_beta: sp.Expr, tan_gamma: sp.Expr
) -> tuple[sp.Expr, sp.Expr]:
    """Give tan φ = (tan γ·cos β - sin β·cos ψ) / sin ψ.

    Args:
        sin_psi: Of the swivel angle, counted from the lowest point of the circle.
        cos_psi: The same.
        sin_beta: Of the elevation of the wrist.
        cos_beta: The same.
        tan_gamma: Of the angle at the shoulder between upper arm and wrist.

    Returns:
        Numerator and denominator.

    Source:
        None (derived here).
    """
    return tan_gamma * cos_beta - sin_beta * cos_psi, sin_psi


def tangent_of_gamma(theta4: sp.Expr) -> sp.Expr:
    """Give tan γ = l3·|sin θ4| / (l4 + l3·cos θ4); negative for γ above 90°.

    Args:
        theta4: Elbow angle, of either sign.

    Returns:
        SymPy expression.

    Source:
        None (derived here).
    """
    return L3 * sp.Abs(sin(theta4)) / (L4 + L3 * cos(theta4))


def check_swivel(ratio: Ratio, gamma: Callable[[sp.Expr], sp.Expr] = tangent_of_gamma) -> Evidence:
    """The geometry and tan φ exactly in the joint angles; range, fold and both directions in numbers.

    Args:
        ratio: The statement: numerator and denominator of tan φ.
        gamma: The statement: tan γ from θ4.

    Returns:
        The evidence.

    Source:
        None (derived here).
    """
    if not all(is_exactly_zero(entry) for entry in _geometry()):
        return Evidence(Verdict.FALSE, "the geometry of the plane through the elbow fails")
    printed, derived = _exact_ratio(ratio)
    found = Identity(sp.Matrix([printed]), sp.Matrix([derived])).check()
    if found.verdict is not Verdict.HOLDS:
        return found
    if not all(is_exactly_zero(entry) for entry in _fold(ratio)):
        return Evidence(Verdict.FALSE, "dφ/dψ does not vanish at the end of the range of φ")
    stated = ratio(sin(PSI), cos(PSI), sin(BETA), cos(BETA), tan(GAMMA))
    miss = first_miss_of_gamma(gamma(_q4), _q4, (L4, L3)) or first_miss(*stated)
    if miss:
        return Evidence(Verdict.FALSE, "fails in numbers", miss)
    return Evidence(
        Verdict.ADDED,
        f"tan φ in the joint angles of the chain: {found.proof}; n·w = (l3·c4 + l4)·s3, e - λw at right "
        "angles to n and to e, and where dφ/dψ = 0: exactly; with the joint angles of the chain in CasADi at "
        f"{POINTS} random postures, θ4 of both signs: tan γ is that of the triangle, φ from ψ is φ of the "
        "posture or its opposite, every ψ is reached with "
        "both, every φ in range has two elbows, mirror images in the plane of w and n, and every φ out of "
        "range has none",
    )


def _vectors() -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
    """Elbow e, wrist w and n, the axis of joint 2 (turned round: along +z at q = 0)."""
    return frame(4)[:3, 3], frame(5)[:3, 3], -frame(2)[:3, 2]


def _geometry() -> list[sp.Expr]:
    e, w, n = _vectors()
    reach = L4 + L3 * cos(_q4)
    m = e - w * L4 / reach
    return [
        n[1],
        n.dot(n) - 1,
        n.dot(w) - derived_k()[0],
        n.dot(w) - reach * sin(_q3),
        n.dot(e) - L4 * sin(_q3),
        e.dot(w) - L4 * reach,
        m.dot(n),
        m.dot(e),
    ]


def _exact_ratio(ratio: Ratio) -> tuple[sp.Expr, sp.Expr]:
    """Tangent of φ as stated, and k2/k1; both in joint angles with every square root cancelled.

    With the circle's radius ρ = l3·l4·|s4|/tg and h = (dx, 0, dz)/r: ρ·sin ψ = e·(up × h), ρ·cos ψ =
    e·(h·sin β - up·cos β). The ratio is homogeneous in (sin ψ, cos ψ, tan γ), so all three come multiplied
    by ρ; numerator and denominator are then multiplied by r, and only r² and tg² remain.
    """
    e, w, _ = _vectors()
    r2, tg2 = w[0] ** 2 + w[2] ** 2, L4**2 + L3**2 + 2 * L3 * L4 * cos(_q4)
    r, tg = sp.symbols("r_ tg_", positive=True)
    sin_psi = (e[0] * w[2] - e[2] * w[0]) / r
    cos_psi = (w[1] / tg) * (e[0] * w[0] + e[2] * w[2]) / r - (r / tg) * e[1]
    rho = L3 * L4 * sp.Abs(sin(_q4)) / tg
    tan_gamma = rho * tangent_of_gamma(_q4)
    above, below = ratio(sin_psi, cos_psi, w[1] / tg, r / tg, tan_gamma)
    even = sp.expand(above * r).subs({r**2: r2, tg**-2: 1 / tg2}) / sp.expand(below * r)
    return even, derived_k()[1] / derived_k()[0]


def _fold(ratio: Ratio) -> list[sp.Expr]:
    """dφ/dψ vanishes for cos ψ = tan β/tan γ only, and there |cos φ| = cos γ/cos β, the end of the range."""
    above, below = ratio(sin(PSI), cos(PSI), sin(BETA), cos(BETA), tan(GAMMA))
    slope = sp.diff(above, PSI) * below - above * sp.diff(below, PSI)
    stated = sin(BETA) - tan(GAMMA) * cos(BETA) * cos(PSI)
    turn = tan(BETA) / tan(GAMMA)
    at = {cos(PSI): turn, sin(PSI) ** 2: 1 - turn**2}
    x2, y2 = (sp.expand(part**2).subs(at) for part in (below, above))
    return [slope - stated, stated.subs(at), x2 * cos(BETA) ** 2 - (x2 + y2) * cos(GAMMA) ** 2]


_SHOWN = tangent_of_phi(sin(PSI), cos(PSI), sin(BETA), cos(BETA), tan(GAMMA))

CLAIMS = (
    Claim(
        PAPER,
        "swivel",
        "what φ means, and how the swivel angle of the elbow follows from it",
        Verdict.ADDED,
        "Not in the paper. φ is not the swivel angle ψ: it is the wrist's azimuth minus θ1, that is, it "
        "turns the horizontal axis of joint 2 about the vertical. Each ψ belongs to two φ, half a turn "
        "apart; each φ in range to two elbows, mirror images of each other, which the branch of θ3 in (22) "
        "tells apart.",
        Check(
            lambda: check_swivel(tangent_of_phi),
            printed=(
                Formula(r"\tan\varphi", _SHOWN[0] / _SHOWN[1]),
                Formula(r"\tan\gamma", in_angles(tangent_of_gamma(_q4))),
                Formula(r"|\cos\varphi|", r"\frac{|\cos\gamma|}{\cos\beta}", r"\le"),
            ),
        ),
        derivation="e is the elbow, w the wrist, n the axis of joint 2, which is always horizontal. From "
        "(9) and (13), n·w = (l3·c4 + l4)·s3 = r·cos φ and n·e = l4·s3, so n stands at right angles to e - "
        "λw with λ = l4/(l4 + l3·c4); λw is where the plane through the elbow at right angles to the upper "
        "arm cuts the line of w. Hence n = ± up × (e(ψ) - λw), normalised, which gives tan φ. ψ counts "
        "from the lowest elbow, right-handed about w; β is the elevation of w, γ the angle at the shoulder "
        "between upper arm and w (below 90° if the upper arm is the longer one). dφ/dψ has the sign of sin "
        "β - tan γ·cos β·cos ψ. So if |β| > γ every φ is feasible and φ(ψ) never turns back. If |β| < γ, a "
        "sector about φ = 0 and one about 180° have no solution; at their edges, where cos ψ = tan β/tan γ "
        "and θ3 = ±90°, φ(ψ) turns back: to move the elbow on, a search or a path in φ has to change "
        "branch there, one in ψ does not.",
    ),
)
