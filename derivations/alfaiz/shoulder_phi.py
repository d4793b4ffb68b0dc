"""Al-Faiz, eq. (13) to (20): φ, and the first shoulder angle from it."""

from __future__ import annotations

import sympy as sp
from sympy import atan, atan2, cos, pi, sin, tan

from derivations.alfaiz.chain import L3, L4, Q, frame
from derivations.alfaiz.facts import BranchWithFacts, IdentityWithFacts
from derivations.alfaiz.letters import in_angles
from derivations.alfaiz.shoulder_position import DX, DZ, derived_k, of_the_arm
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.identity import Identity

PAPER = "alfaiz"
_q1 = Q[0]
_sum, _phi = sp.symbols("sigma varphi", real=True)
_r = sp.Symbol("r", positive=True)
_HALF = (-pi / 2, pi / 2)


def printed_theta1(dx: sp.Expr, dz: sp.Expr) -> sp.Expr:
    """Eq. (20) as printed.

    Args:
        dx: x of the wrist.
        dz: z of the wrist.

    Returns:
        SymPy expression in φ.

    Source:
        Al-Faiz, eq. 20.
    """
    return sp.Piecewise((atan(-dx / dz), sp.Ne(dz, 0)), (-pi / 2, True)) - _phi


def corrected_theta1(dx: sp.Expr, dz: sp.Expr) -> sp.Expr:
    """Eq. (20) with the four-quadrant arc tangent.

    Args:
        dx: x of the wrist.
        dz: z of the wrist.

    Returns:
        SymPy expression in φ.

    Source:
        Al-Faiz, eq. 20, corrected.
    """
    return atan2(-dx, dz) - _phi


def theta1_branch() -> BranchWithFacts:
    """Eq. (20) for the wrist at (17), (18), r being a distance; σ = θ1 + φ.

    Returns:
        The claim.

    Source:
        Al-Faiz, eq. 17-20.
    """
    dx, dz = -_r * sin(_sum), _r * cos(_sum)
    return BranchWithFacts(
        r"\theta_1",
        printed_theta1(dx, dz),
        _sum - _phi,
        {_sum: (-pi, pi), _phi: (-pi, pi), _r: (sp.Rational(1, 10), sp.Integer(1))},
        {_sum: _HALF},
        corrected_theta1(dx, dz),
        printed_text=printed_theta1(DX, DZ),
        corrected_text=corrected_theta1(DX, DZ),
        inputs={"dx": dx, "dz": dz, "φ": _phi},
        borders=({_sum: pi / 2, _phi: 0, _r: 1}, {_sum: -pi / 2, _phi: 0, _r: 1}),
        example={_sum: pi, _phi: 0, _r: 1},
    )


def _definitions() -> Evidence:
    p = frame(5)[:3, 3]
    k = derived_k()
    same = Identity(sp.Matrix([k.dot(k)]), sp.Matrix([p[0] ** 2 + p[2] ** 2])).check()
    if same.verdict is not Verdict.HOLDS:
        return same
    return Evidence(Verdict.DEFINITION, f"r² = k1² + k2² = dx² + dz²: {same.proof}")


def _printed_sums() -> sp.Matrix:
    s1, c1, s, c = sin(_q1), cos(_q1), sin(_phi), cos(_phi)
    return sp.Matrix(
        [
            _r * s1 * c + _r * c1 * s,
            _r * c1 * c - _r * s1 * s,
            _r * sin(_q1 + _phi),
            _r * cos(_q1 + _phi),
        ]
    )


def in_polar(names: sp.Matrix) -> sp.Matrix:
    """What stands behind dx and dz when k1 = r·cos φ and k2 = r·sin φ, for any r and φ.

    Args:
        names: SymPy matrix in dx and dz.

    Returns:
        The same for the chain with the lengths that give such k1 and k2; both are linear in the lengths.

    Source:
        Al-Faiz, eq. 11-14, through `armik_sym.symbolic`.
    """
    polar = derived_k() - sp.Matrix([_r * cos(_phi), _r * sin(_phi)])
    (lengths,) = sp.linsolve(list(polar), [L3, L4])
    return of_the_arm(names).subs(dict(zip((L3, L4), lengths, strict=True)), simultaneous=True)


_SUMS = sp.Matrix([-DX, DZ, -DX, DZ])
_TANGENT = sp.Matrix([-DX / DZ])

CLAIMS = (
    Claim(
        PAPER,
        "13-14",
        "r and φ",
        Verdict.DEFINITION,
        "r is the distance of the wrist from the vertical axis through the shoulder (axis 1), φ the angle "
        "of (k1, k2). The paper does not say whether r may be negative; see (20) and (21). On the axis "
        "itself (dx = dz = 0) φ means nothing.",
        Check(
            _definitions,
            printed=(Formula(r"r\cos\varphi", "k_1"), Formula(r"r\sin\varphi", "k_2")),
        ),
        derivation="Polar coordinates of (k1, k2). What φ is on the arm: see the entry on the swivel angle.",
    ),
    Claim(
        PAPER,
        "15-18",
        "x and z through r and φ",
        Verdict.HOLDS,
        "Polar coordinates turn joint 1 into an addition of angles: the wrist's azimuth is θ1 + φ.",
        IdentityWithFacts(
            _printed_sums(),
            in_polar(_SUMS),
            names=_SUMS,
            names_first=False,
            letters=in_angles,
        ),
        derivation="dx and dz of the chain, in which l3 and l4 are chosen so that k1 = r·cos φ and "
        "k2 = r·sin φ; r, φ and all joint angles stay arbitrary.",
    ),
    Claim(
        PAPER,
        "19",
        "tangent of θ1 + φ",
        Verdict.HOLDS,
        "Holds where dz ≠ 0. It says less than (17) and (18) together: turning the wrist by half a turn "
        "about the vertical does not change it.",
        IdentityWithFacts(
            sp.Matrix([tan(_q1 + _phi)]),
            in_polar(_TANGENT),
            names=_TANGENT,
            names_first=False,
            letters=in_angles,
        ),
        derivation="Eq. (17) over (18); checked with dx and dz of the chain as there.",
    ),
    Claim(
        PAPER,
        "20",
        "first shoulder angle",
        Verdict.CORRECTED,
        "With r as a distance, right only for dz > 0: for dz < 0 it is half a turn off, and for dz = 0 it is "
        "right on one side (dx > 0). With the signed r of (21), (17) and (18) hold all the "
        "same, but the φ that belongs to a posture then jumps by half a turn wherever a path crosses dz = 0.",
        theta1_branch(),
        derivation="Eq. (17), (18) solved for θ1 + φ with both signs kept. σ stands for θ1 + φ.",
        correction="θ1 = atan2(-dx, dz) - φ, with r = sqrt(dx² + dz²)",
        fault=Fault.BRANCH,
    ),
)
