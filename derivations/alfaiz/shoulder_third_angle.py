"""Al-Faiz, eq. (22): the third shoulder angle."""

from __future__ import annotations

import numpy as np
import sympy as sp
from sympy import asin, cos, pi

from armik_sym.arm.catalog import alfaiz
from derivations.alfaiz.chain import L3, L4, Q
from derivations.alfaiz.facts import BranchWithFacts, Fact
from derivations.alfaiz.shoulder_position import derived_k
from derivations.claim import Claim, Fault, Verdict

PAPER = "alfaiz"
_q3, _q4 = Q[2], Q[3]
_r, _phi, _theta4 = sp.symbols("r varphi theta_4", real=True)
_HALF = (-pi / 2, pi / 2)


def printed_theta3(sine: sp.Expr) -> sp.Expr:
    """Eq. (22) as printed.

    Args:
        sine: r·cos φ / (l3·cos θ4 + l4).

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 22.
    """
    return asin(sine)


def theta3_branch() -> BranchWithFacts:
    """Eq. (22) for the k1 of the chain; the sign of cos θ3 tells the two branches apart.

    Returns:
        The claim.

    Source:
        Al-Faiz, eq. 22.
    """
    lengths = {L4: sp.Rational(3, 10), L3: sp.Rational(6, 25)}
    reach = (L3 * cos(_q4) + L4).subs(lengths)
    sine = derived_k()[0].subs(lengths) / reach
    side = cos(_q3) / sp.Abs(cos(_q3))
    one = _r * cos(_phi) / (L3 * cos(_theta4) + L4)
    shown = sp.latex(printed_theta3(one), inv_trig_style="full")
    return BranchWithFacts(
        r"\theta_3",
        printed_theta3(sine),
        _q3,
        {_q3: (-pi, pi), _q4: (sp.Integer(0), pi)},
        {_q3: _HALF},
        side * printed_theta3(sine) + (1 - side) * pi / 2,
        printed_text=printed_theta3(one),
        corrected_text=rf"{shown} \;\text{{or}}\; \pi - {shown}",
        inputs={"r·cos φ": sine * reach, "θ4": _q4, "l3": lengths[L3], "l4": lengths[L4]},
        facts=(Fact("θ2 and θ3 of both are inside the range of motion, a full turn each", _both_in_range),),
        example={_q3: 5 * pi / 6, _q4: pi / 2},
    )


def _both_in_range() -> bool:
    """Joints 2 and 3, which differ between the two branches."""
    rom = alfaiz().rom
    return bool((rom.upper[1:3] - rom.lower[1:3] > 2 * np.pi - 1e-9).all())


CLAIMS = (
    Claim(
        PAPER,
        "22",
        "third shoulder angle",
        Verdict.CORRECTED,
        "The arc sine gives one of two angles; π - θ3 reaches the same pose with another elbow, also "
        "inside the range of motion, and is lost. "
        "No solution exists for this φ if |r·cos φ| > |l3·cos θ4 + l4|, and the formula divides by zero if "
        "l3·cos θ4 + l4 = 0 (the forearm at least as long as the upper arm, strongly flexed).",
        theta3_branch(),
        derivation="k1 = (l3·cos θ4 + l4)·sin θ3 of (9) equals r·cos φ of (13).",
        correction="two branches: asin(…) and π - asin(…)",
        fault=Fault.BRANCH,
    ),
)
