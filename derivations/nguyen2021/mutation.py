"""Nguyen 2021, §3.1: the three mutation strategies of the differential evolution."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import sympy as sp

from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.random_points import first_difference, largest_difference

PAPER = "nguyen2021"
F = sp.Symbol("F", real=True)
# Named in LaTeX as printed, so that what is shown is what is checked.
BEST, X1, X2, X3, X4 = (
    sp.Symbol(f"X_{{{name},j}}^G", real=True) for name in ("best", "r1", "r2", "r3", "r4")
)
_SHIFT = sp.Symbol("c", real=True)
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Strategy:
    """What the name of a strategy, DE/base/differences, says.

    Attributes:
        base: The individual the mutant starts from.
        differences: Pairs of random individuals whose difference is added.
        to_best: Whether the mutant also moves from the base towards the best individual.
    """

    base: sp.Symbol
    differences: tuple[tuple[sp.Symbol, sp.Symbol], ...]
    to_best: bool = False

    def mutant(self) -> sp.Expr:
        """The mutant the name stands for.

        Returns:
            SymPy expression, one coordinate.

        Source:
            Storn & Price, Differential Evolution, J. Global Optimization 11 (1997), notation DE/x/y/z.
        """
        steps = [a - b for a, b in self.differences]
        if self.to_best:
            steps.append(BEST - self.base)
        return self.base + F * sum(steps)

    def smallest_population(self) -> int:
        """Individuals needed if the random ones differ from each other and from the current one.

        Returns:
            Smallest NP.

        Source:
            Storn & Price 1997.
        """
        random = {x for pair in self.differences for x in pair} | {self.base}
        return len(random - {BEST}) + 1


BEST_1 = Strategy(BEST, ((X1, X2),))
BEST_2 = Strategy(BEST, ((X1, X2), (X3, X4)))
RAND_TO_BEST_1 = Strategy(X1, ((X2, X3),), to_best=True)

PRINTED_BEST_1 = BEST + F * (X1 - X2)
PRINTED_BEST_2 = BEST + F * (X1 - X2) + F * (X3 - X4)
PRINTED_RAND_TO_BEST_1 = X1 + F * (BEST - X1) + F * (X2 - X3)


def check_mutant(printed: sp.Expr, strategy: Strategy) -> Evidence:
    """Hold a printed mutant against its name, and look at what F = 0, F < 0 and a shift of all do to it.

    Args:
        printed: The printed mutant, one coordinate.
        strategy: What its name stands for.

    Returns:
        `Verdict.DEFINITION` if it is what its name says and moves along with a shift of the population.

    Source:
        Nguyen 2021, eq. 9-11.
    """
    named = strategy.mutant()
    individuals = sorted(printed.free_symbols - {F}, key=str)
    shifted = printed.subs({x: x + _SHIFT for x in individuals}, simultaneous=True)
    exact = (
        sp.expand(printed - named) == 0
        and sp.expand(shifted - printed - _SHIFT) == 0
        and printed.subs(F, 0) == strategy.base
    )
    if not exact or not _agree(printed, named) or not _agree(shifted, printed + _SHIFT):
        found = (
            first_difference(sp.Matrix([printed]), sp.Matrix([named])) or "the population does not move along"
        )
        return Evidence(Verdict.FALSE, "not what the name of the strategy stands for", str(found))
    return Evidence(
        Verdict.DEFINITION,
        "Equal to what its name stands for, coefficients sum to 1 and F = 0 gives back the base vector, "
        f"exactly and at 1,000 random points in CasADi; {_sign_of_F(printed, strategy)}; distinct random "
        f"individuals need NP ≥ {strategy.smallest_population()}",
    )


def ignores_the_sign_of_F(printed: sp.Expr, strategy: Strategy) -> bool:
    """Whether -F gives the same mutants, only with the random individuals in another order.

    Args:
        printed: A mutant, one coordinate.
        strategy: Its random pairs.

    Returns:
        True if swapping the members of every pair undoes the change of sign.

    Source:
        None (symmetry).
    """
    swap = {x: y for a, b in strategy.differences for x, y in ((a, b), (b, a))}
    return bool(sp.expand(printed.subs(F, -F) - printed.subs(swap, simultaneous=True)) == 0)


def _sign_of_F(printed: sp.Expr, strategy: Strategy) -> str:
    if ignores_the_sign_of_F(printed, strategy):
        return "a negative F only swaps the members of the random pairs"
    return "a negative F moves the mutant away from the best individual"


def _agree(left: sp.Expr, right: sp.Expr) -> bool:
    return largest_difference(sp.Matrix([left]), sp.Matrix([right])) < _ROUNDING


def _body(printed: sp.Expr, strategy: Strategy) -> Check:
    return Check(functools.partial(check_mutant, printed, strategy), (Formula("V_{i,j}^G", printed),))


CLAIMS = (
    Claim(
        PAPER,
        "9",
        "mutation DE/best/1",
        Verdict.DEFINITION,
        "The usual DE/best/1. Not printed: r1 ≠ r2 (else the mutant is the best individual itself) and, by "
        "convention, both different from i. Only |F| matters here, not the sign of F.",
        _body(PRINTED_BEST_1, BEST_1),
        derivation="Built from its name: start at the best individual, add F times one random difference. "
        "The coefficients of the individuals sum to 1, so shifting the whole population shifts the mutant.",
    ),
    Claim(
        PAPER,
        "10",
        "mutation DE/best/2",
        Verdict.DEFINITION,
        "The usual DE/best/2. Not printed: r1 … r4 distinct (with r1 = r4 and r2 = r3 the differences "
        "cancel). Only |F| matters here, not the sign of F.",
        _body(PRINTED_BEST_2, BEST_2),
        derivation="As eq. (9), with two random differences.",
    ),
    Claim(
        PAPER,
        "11",
        "mutation DE/rand to best/1",
        Verdict.DEFINITION,
        "Starts from a random individual, as SciPy's `randtobest1bin` does; Storn and Price's first scheme "
        "of this kind starts from X_i itself, today called current-to-best. The sign of F matters: with "
        "F < 0, which eq. (14) as printed produces, the mutant moves away from the best individual.",
        _body(PRINTED_RAND_TO_BEST_1, RAND_TO_BEST_1),
        derivation="As eq. (9), with one random difference and one step from the base towards the best. How "
        "the three strategies are chosen between is not printed.",
    ),
)
