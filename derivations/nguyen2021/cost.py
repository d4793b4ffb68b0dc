"""Nguyen 2021, §3.3: the cost of the search."""

from __future__ import annotations

import functools
import itertools

import numpy as np
import sympy as sp

from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.nguyen2021.chain import Q, frame
from derivations.nguyen2021.direction_cosines import determining, half_turn_unseen, two_whole_lines_suffice
from derivations.random_points import evaluate

PAPER = "nguyen2021"
A, B = sp.symbols("a b", positive=True)
K, M, N = sp.symbols("k m n", integer=True, positive=True)
JOINT = sp.IndexedBase("q", real=True)  # JOINT[0, k], JOINT[1, k]: q_0^k, q_1^k
FOUND, WANTED = sp.IndexedBase("R_i", real=True), sp.IndexedBase("R_ei", real=True)
POSITION = tuple((sp.Symbol(f"{x}_i", real=True), sp.Symbol(f"{x}_ei", real=True)) for x in "xyz")
# The wanted cosines lack the index i in print.
COSINES = tuple((sp.Symbol(f"R{x}_i", real=True), sp.Symbol(f"R{x}_e", real=True)) for x in "xyz")

_STEP = sp.Symbol("w", positive=True)
_MOVE = sp.Rational(1, 10)
_HANGING = dict.fromkeys(Q[1:], sp.Integer(0))
_MOTION = sp.Sum((JOINT[1, K] - JOINT[0, K]) ** 2, (K, 1, 5))
_OFF = sum((found - wanted) ** 2 for found, wanted in POSITION)

PRINTED_COST = A * sp.sqrt(_MOTION) + B * sp.sqrt(
    _OFF + sum((found - wanted) ** 2 for found, wanted in COSINES)
)
CORRECTED_COST = A * sp.sqrt(_MOTION) + B * sp.sqrt(
    _OFF + sp.Sum((FOUND[M, N] - WANTED[M, N]) ** 2, (M, 1, 3), (N, 1, 3))
)


def smallest_ratio(cost: sp.Expr) -> sp.Expr:
    """The ratio b/a from which on the cost of one joint that is its own hand is lowest at the wanted angle.

    The cost a |q| + b |q - w| is convex and straight between 0 and w, so one of these two is lowest.

    Args:
        cost: `PRINTED_COST`, or another.

    Returns:
        The ratio b/a, NaN if the cost is not of this kind.

    Source:
        Nguyen 2021, eq. 16, for one joint; exact penalties: Nocedal & Wright, Numerical Optimization, §17.2.
    """
    q = sp.Symbol("q", real=True)
    values = {JOINT[1, 1]: q, POSITION[0][0]: q, POSITION[0][1]: _STEP}
    everything = cost.doit()
    others = everything.atoms(sp.Indexed) | {symbol for pair in POSITION + COSINES for symbol in pair}
    one = everything.subs(dict.fromkeys(others - set(values), 0)).subs(values)
    if sp.simplify(one - A * sp.Abs(q) - B * sp.Abs(q - _STEP)) != 0:
        return sp.nan
    (found,) = sp.solve(sp.Eq(sp.simplify(one.subs(q, 0) - one.subs(q, _STEP)), 0), B)
    return found / A


def best_turn(unit_per_mm: sp.Expr, a: int = 2, b: int = 1, cost: sp.Expr = CORRECTED_COST) -> float:
    """How far the cost lets one shoulder joint turn towards a pose 0.1 rad away, arm hanging.

    Args:
        unit_per_mm: Size of the unit of the position: 1 for mm, 1/1000 for m.
        a: Weight of the joint motion.
        b: Weight of the hand error.
        cost: The cost, with all nine cosines.

    Returns:
        The angle of lowest cost, in [rad].

    Source:
        Nguyen 2021, eq. 16, with the chain of Table 4.
    """
    T = frame(5).subs(_HANGING)
    there = T.subs(Q[0], _MOVE)
    values = {A: a, B: b, **{JOINT[0, k + 1]: 0 for k in range(5)}}
    values |= {JOINT[1, k + 1]: Q[k] if k == 0 else 0 for k in range(5)}
    for i, (found, wanted) in enumerate(POSITION):
        values |= {found: unit_per_mm * T[i, 3], wanted: unit_per_mm * there[i, 3]}
    for i, j in itertools.product(range(3), repeat=2):
        values |= {FOUND[i + 1, j + 1]: T[i, j], WANTED[i + 1, j + 1]: there[i, j]}
    angles = np.linspace(-0.05, 0.15, 201)
    costs = evaluate(cost.doit().subs(values, simultaneous=True), [Q[0]], angles[:, None])
    return float(round(angles[np.argmin(costs)], 3))


def cosines_compared(cost: sp.Expr) -> int:
    """How many direction cosines a cost compares.

    Args:
        cost: `PRINTED_COST`, `CORRECTED_COST`, or another.

    Returns:
        The number; -1 if the cost is not a·|joint motion| + b·|position and cosines off|.

    Source:
        Nguyen 2021, eq. 16.
    """
    all_nine = [(FOUND[i, j], WANTED[i, j]) for i, j in itertools.product((1, 2, 3), repeat=2)]
    everything = cost.doit()
    pairs = [pair for pair in [*COSINES, *all_nine] if everything.has(pair[0])]
    off = [(found - wanted) ** 2 for found, wanted in [*POSITION, *pairs]]
    expected = A * sp.sqrt(_MOTION.doit()) + B * sp.sqrt(sum(off))
    return len(pairs) if everything - expected == 0 else -1


def check_cost(printed: sp.Expr, corrected: sp.Expr) -> Evidence:
    """Do the cosines of the cost determine an orientation, and does the cost lead to the wanted pose?

    Args:
        printed: The cost as printed.
        corrected: The cost with the smallest correction.

    Returns:
        The verdict.

    Source:
        Nguyen 2021, eq. 16.
    """
    counts = [cosines_compared(cost) for cost in (printed, corrected)]
    if counts[1] != 9:
        return Evidence(Verdict.FALSE, f"the corrected cost compares {counts[1]} direction cosines, not nine")
    turns = [best_turn(unit, cost=corrected) for unit in (sp.Integer(1), sp.Rational(1, 1000))]
    if smallest_ratio(printed) != 1 or turns != [0.1, 0.0]:
        return Evidence(Verdict.FALSE, "the cost does not trade joint motion against hand error as said")
    if counts[0] == 9:
        return Evidence(Verdict.HOLDS, "nine direction cosines determine an orientation")
    if counts[0] != len(COSINES) or any(map(determining, range(1, 6))) or not two_whole_lines_suffice():
        return Evidence(Verdict.FALSE, f"{counts[0]} direction cosines, not the printed {len(COSINES)}")
    choices = sp.binomial(9, counts[0])
    proof = (
        f"{counts[0]} cosines: for each of the {choices} choices there are two different rotations that "
        "agree in them, and so for every choice of fewer, of four and of five. Six suffice exactly if they "
        "are two whole columns, or two whole rows: the third is their cross product, reduced to zero over "
        f"the rationals; for all nine there is no such pair. {_blind_axis()}. For one joint the wanted "
        "angle is the lowest point if b > a, exactly; on the chain, with nine cosines, a = 2, b = 1 and a "
        "pose 0.1 rad away, the best turn is 0.1 rad with positions in mm and 0 with positions in m (CasADi)"
    )
    return Evidence(Verdict.CORRECTED, proof, half_turn_unseen())


def _blind_axis() -> str:
    """Whether position and forearm axis see q5."""
    T = frame(5)
    blind = sp.diff(T[:3, 1].col_join(T[:3, 3]), Q[4]) == sp.zeros(6, 1)
    turned = T[:3, 0].subs({Q[4]: 0}) - T[:3, 0].subs({Q[4]: 1})
    if not blind or turned == sp.zeros(3, 1):
        return "Position and forearm axis (second column of R_0^5) see q5"
    return "Position and forearm axis (second column of R_0^5) do not depend on q5 at all"


CLAIMS = (
    Claim(
        PAPER,
        "16",
        "cost of the search",
        Verdict.CORRECTED,
        "Three direction cosines do not determine an orientation, whichever are meant (the paper does not "
        "say). Two whole columns, six numbers, do; use them, all nine, or a rotation angle. Both terms are "
        "lengths, not squares: an exact penalty, whose lowest point has no hand error at all if b exceeds a "
        "by enough (squares would compromise); if not, the hand stays short. How much is enough depends on "
        "the unit of the position.",
        Check(
            functools.partial(check_cost, PRINTED_COST, CORRECTED_COST),
            (Formula(r"\mathrm{Func.1}", PRINTED_COST),),
            (
                Formula(r"\mathrm{Func.1}", CORRECTED_COST),
                Formula(r"b\,\sigma_{min}(J)", A, ">"),
            ),
        ),
        derivation="q_{1,k} and q_{0,k} stand for the printed q_1^k and q_0^k. Near the wanted pose a joint "
        "step d lowers the first term by at most a|d| and raises the second by b|Jd| ≥ b σ_min(J)|d|, with "
        "σ_min the smallest singular value of the Jacobian of position and cosines that is not zero (steps "
        "that leave the hand alone only lower the first term). Lengths, angles and cosines are added, so a "
        "and b, which are not printed, mean nothing without the unit. At the solution the cost has a kink: "
        "no derivative there. The wanted cosines lack the index i. The text calls q_1 the starting posture "
        "and q_0 that of the first point, against their indices, which does no harm. For later points a = "
        "0. In the paper's own use the starting posture is the measured first one, for which both terms "
        "vanish: the answer for the first point is put in beforehand.",
        correction="nine direction cosines (two whole columns suffice) with the index i on the wanted ones, "
        "and b large enough for a",
        fault=Fault.MODEL,
    ),
)
