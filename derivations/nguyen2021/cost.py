"""Nguyen 2021, §3.3: the cost of the search."""

from __future__ import annotations

import functools
import itertools

import numpy as np
import sympy as sp

from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.nguyen2021.chain import Q, frame
from derivations.random_points import evaluate

PAPER = "nguyen2021"
_A, _B, _STEP = sp.symbols("a b w", positive=True)
_MOVE = sp.Rational(1, 10)
_HANGING = dict.fromkeys(Q[1:], sp.Integer(0))


def collision(entries: tuple[int, ...]) -> tuple[sp.Matrix, sp.Matrix] | None:
    """Two different rotations that agree in some of their nine direction cosines.

    Args:
        entries: The entries compared, 0 to 8, row by row.

    Returns:
        The first such pair among the 24 rotations of a cube, or None.

    Source:
        None (search).
    """
    seen: dict[tuple[sp.Expr, ...], sp.Matrix] = {}
    for R in _cube_rotations():
        key = tuple(R[k] for k in entries)
        if key in seen:
            return seen[key], R
        seen[key] = R
    return None


@functools.cache
def _cube_rotations() -> tuple[sp.Matrix, ...]:
    found = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            R = sp.zeros(3, 3)
            for row, column in enumerate(order):
                R[row, column] = signs[row]
            if R.det() == 1:
                found.append(R)
    return tuple(found)


def smallest_ratio() -> sp.Expr:
    """The ratio b/a from which on the cost of one joint is lowest at the wanted angle.

    The cost a |q| + b |q - w| is convex and straight between 0 and w, so one of these two is lowest.

    Returns:
        The ratio b/a.

    Source:
        Nguyen 2021, eq. 16, for one joint; exact penalties: Nocedal & Wright, Numerical Optimization, §17.2.
    """
    q = sp.Symbol("q", real=True)
    cost = _A * sp.sqrt(q**2) + _B * sp.sqrt((q - _STEP) ** 2)
    gain = sp.simplify(cost.subs(q, 0) - cost.subs(q, _STEP))
    (ratio,) = sp.solve(sp.Eq(gain, 0), _B)
    return ratio / _A


def best_turn(unit_per_mm: sp.Expr, a: int = 2, b: int = 1) -> float:
    """How far the cost lets one shoulder joint turn towards a pose 0.1 rad away, arm hanging.

    Args:
        unit_per_mm: Size of the unit of the position: 1 for mm, 1/1000 for m.
        a: Weight of the joint motion.
        b: Weight of the hand error (position and all nine cosines).

    Returns:
        The angle of lowest cost, in [rad].

    Source:
        Nguyen 2021, eq. 16, with the chain of Table 4.
    """
    T = frame(5).subs(_HANGING)
    off = T - T.subs(Q[0], _MOVE)
    squares = (unit_per_mm * off[:3, 3]).dot(unit_per_mm * off[:3, 3]) + sum(x**2 for x in off[:3, :3])
    cost = a * sp.sqrt(Q[0] ** 2) + b * sp.sqrt(squares)
    angles = np.linspace(-0.05, 0.15, 201)
    return float(round(angles[np.argmin(evaluate(cost, [Q[0]], angles[:, None]))], 3))


def check_cost(printed_cosines: int, corrected_cosines: int) -> Evidence:
    """Do that many direction cosines determine an orientation, and does the cost lead to the wanted pose?

    Args:
        printed_cosines: Number of direction cosines in the printed cost.
        corrected_cosines: Number in the corrected one.

    Returns:
        The verdict.

    Source:
        Nguyen 2021, eq. 16.
    """
    determining = [
        [entries for entries in itertools.combinations(range(9), n) if collision(entries) is None]
        for n in (printed_cosines, corrected_cosines)
    ]
    if smallest_ratio() != 1 or (best_turn(sp.Integer(1)), best_turn(sp.Rational(1, 1000))) != (0.1, 0.0):
        return Evidence(Verdict.FALSE, "the cost does not trade joint motion against hand error as said")
    if determining[0]:
        return Evidence(Verdict.HOLDS, f"{printed_cosines} direction cosines can determine an orientation")
    choices = sp.binomial(9, printed_cosines)
    quarter = sp.rot_axis3(sp.pi / 2)
    proof = (
        f"{printed_cosines} cosines: for each of the {choices} choices there are two different rotations "
        f"that agree in them; all nine: none. {_blind_axis()}. For one joint the wanted angle is the lowest "
        "point if b > a, exactly; on the chain, with a = 2, b = 1 and a pose 0.1 rad away, the best turn is "
        "0.1 rad with positions in mm and 0 with positions in m (CasADi)"
    )
    counterexample = (
        f"quarter turns by +90° and -90° about z have the same diagonal {tuple(quarter.diagonal())}; turns "
        "by 0° and 180° about x the same first column (1, 0, 0): cost 0 for an orientation half a turn off"
    )
    return Evidence(Verdict.CORRECTED if determining[1] else Verdict.FALSE, proof, counterexample)


def _blind_axis() -> str:
    """Whether position and forearm axis see q5."""
    T = frame(5)
    blind = sp.diff(T[:3, 1].col_join(T[:3, 3]), Q[4]) == sp.zeros(6, 1)
    turned = T[:3, 0].subs({Q[4]: 0}) - T[:3, 0].subs({Q[4]: 1})
    if not blind or turned == sp.zeros(3, 1):
        return "Position and forearm axis (second column of R_0^5) see q5"
    return "Position and forearm axis (second column of R_0^5) do not depend on q5 at all"


_JOINTS = r"a \sqrt{\textstyle\sum_{k=1}^5 (q_1^k - q_0^k)^2}"
_POSITION = r"(x_i - x_{ei})^2 + (y_i - y_{ei})^2 + (z_i - z_{ei})^2"
_THREE = r"(Rx_i - Rx_e)^2 + (Ry_i - Ry_e)^2 + (Rz_i - Rz_e)^2"

CLAIMS = (
    Claim(
        PAPER,
        "16",
        "cost of the search",
        Verdict.CORRECTED,
        "Three direction cosines do not determine an orientation, whichever are meant (the paper does not "
        "say); use all nine, or a rotation angle. Both terms are lengths, not squares: an exact penalty, "
        "whose lowest point has no hand error at all if b exceeds a by enough (squares would compromise); if "
        "not, the hand stays short. How much is enough depends on the unit of the position.",
        Check(
            functools.partial(check_cost, 3, 9),
            (Formula(r"\mathrm{Func.1}", rf"{_JOINTS} + b \sqrt{{{_POSITION} + {_THREE}}}"),),
            (
                Formula(
                    r"\mathrm{Func.1}",
                    rf"{_JOINTS} + b \sqrt{{{_POSITION} + \lVert R_i - R_{{ei}} \rVert_F^2}}",
                ),
                Formula(r"b\,\sigma_{min}(J)", "a", ">"),
            ),
        ),
        derivation="Near the wanted pose a joint step d lowers the first term by at most a|d| and raises the "
        "second by b|Jd| ≥ b σ_min(J)|d|, with σ_min the smallest singular value of the Jacobian of "
        "position and cosines that is not zero (steps that leave the hand alone only lower the first term). "
        "Lengths, angles and cosines are added, so a and b, which are not printed, mean nothing without the "
        "unit. At the solution the cost has a kink: no derivative there. The wanted cosines lack the index "
        "i. The text calls q_1 the starting posture and q_0 that of the first point, against their indices, "
        "which does no harm. For later points a = 0. In the paper's own use the starting posture is the "
        "measured first one, for which both terms vanish: the answer for the first point is put in "
        "beforehand.",
        correction="nine direction cosines with the index i on the wanted ones, and b large enough for a",
    ),
)
