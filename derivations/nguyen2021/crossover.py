"""Nguyen 2021, §3.2: how the crossover rate CR adapts itself."""

from __future__ import annotations

import functools

import sympy as sp

from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.random_points import largest_difference

PAPER = "nguyen2021"
TAU = sp.Symbol("tau", positive=True)
P, C = sp.symbols("P c", positive=True)
_P0 = sp.Symbol("P_0", positive=True)
_G = sp.Symbol("G", integer=True, nonnegative=True)
_K = sp.Symbol("k", integer=True, positive=True)
PRINTED_TAU_TEXT = "0.10"
PRINTED_TAU = sp.Rational(PRINTED_TAU_TEXT)
_GENERATIONS = 5
_ROUNDING = 1e-9

RAND_1, RAND_2, CR = sp.symbols("rand_1 rand_2 CR_i^G", real=True)
PRINTED_ADAPTATION = sp.Piecewise((RAND_2, sp.Le(RAND_1, TAU)), (CR, True))


def rule_of(adaptation: sp.Piecewise) -> sp.Expr:
    """What an adaptation of CR does to P(CR ≤ c), with rand_1 and rand_2 uniform on [0, 1].

    Args:
        adaptation: CR of the next generation: one value if rand_1 ≤ τ, or ≥ τ, else another.

    Returns:
        P(CR ≤ c) in the next generation, in `P` (the same in this one), `C` and `TAU`.

    Source:
        Nguyen 2021, eq. 15.
    """
    (value, condition), (other, _) = adaptation.args
    chance = TAU if condition == sp.Le(RAND_1, TAU) else 1 - TAU
    at_most_c = {RAND_2: C, CR: P}
    return chance * at_most_c[value] + (1 - chance) * at_most_c[other]


# Probability that CR ≤ c in the next generation, if it is P in this one.
PRINTED_RULE = rule_of(PRINTED_ADAPTATION)


def check_rule(rule: sp.Expr) -> Evidence:
    """What a rule for P(CR ≤ c), from one generation to the next, leads to.

    Args:
        rule: The rule, an expression in `P`, `C` and `TAU`.

    Returns:
        `Verdict.DEFINITION` if CR is adjusted with probability τ and becomes uniform on [0, 1].

    Source:
        Nguyen 2021, eq. 15.
    """
    adjusted = sp.expand(rule).coeff(C)
    if sp.simplify(adjusted - TAU) != 0:
        return Evidence(
            Verdict.FALSE,
            "CR is not adjusted with probability tau",
            f"for tau = 1/10 it is adjusted with probability {adjusted.subs(TAU, PRINTED_TAU)}",
        )
    closed = C + (1 - TAU) ** _G * (_P0 - C)
    stationary = sp.solve(sp.Eq(rule, P), P)
    follows = sp.simplify(rule.subs(P, closed) - closed.subs(_G, _G + 1)) == 0
    if stationary != [C] or not follows or _miss(rule, closed) > _ROUNDING:
        return Evidence(
            Verdict.FALSE, "CR does not become uniform", f"fixed points of P(CR <= c): {stationary}"
        )
    kept = 1 - PRINTED_TAU
    lifetime = sp.summation(_K * PRINTED_TAU * kept ** (_K - 1), (_K, 1, sp.oo))
    return Evidence(
        Verdict.DEFINITION,
        "P(CR ≤ c) = c is the only fixed point, and after G generations P - c has shrunk by (1 - τ)^G, "
        "exactly and in CasADi: CR becomes uniform on [0, 1]; with τ = 0.10 a value lives for "
        f"{lifetime} generations on average (geometric series)",
    )


def _miss(rule: sp.Expr, closed: sp.Expr) -> float:
    """The rule applied several times against the closed form, in numbers."""
    value: sp.Expr = _P0
    for _ in range(_GENERATIONS):
        value = rule.subs(P, value)
    return largest_difference(sp.Matrix([value]), sp.Matrix([closed.subs(_G, _GENERATIONS)]))


CLAIMS = (
    Claim(
        PAPER,
        "15",
        "adaptation of the crossover rate",
        Verdict.DEFINITION,
        "Redraws each CR with probability τ, so CR is uniform on [0, 1] in the long run and, with τ = 0.10, "
        "lives 10 generations on average: redrawn three or four times per point in the 27 to 41 generations "
        'of Table 6. "Same as (6)" points nowhere (eq. 6 is the matrix C).',
        Check(
            functools.partial(check_rule, PRINTED_RULE),
            (Formula("CR_i^{G+1}", PRINTED_ADAPTATION), Formula(r"\tau", PRINTED_TAU_TEXT)),
        ),
        derivation="For the distribution of CR the rule reads P' = τ c + (1 - τ) P with P = P(CR ≤ c). The "
        "first values of CR are not printed; their influence fades as (1 - τ)^G. τ = 0.1 is also the value "
        "of Brest et al., IEEE Trans. Evol. Comput. 10 (2006), whose rule this is.",
    ),
)
