"""Nguyen 2021, §3.2: the two parts of the scale factor, one by rank and one by generation."""

from __future__ import annotations

import functools

import numpy as np
import sympy as sp

from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.random_points import evaluate

PAPER = "nguyen2021"
RANK, NP, ALPHA = sp.symbols("i NP alpha", positive=True)
ITER, ITER_MAX, N_ITER = sp.symbols("iter iter_max n_iter", positive=True)
F_MIN, F_MAX = sp.symbols("F_min F_max", positive=True)
F_RANK, F_MEAN = sp.symbols("F_i F_iter^mean", positive=True)
_LEFT, _SPAN, _E = sp.symbols("u w E", positive=True)
_POINTS = 1_000

PRINTED_BY_RANK = 1 / (1 + sp.exp(ALPHA * (RANK - NP / 2) / NP))
PRINTED_MEAN = F_MIN + (F_MAX - F_MIN) * ((ITER_MAX - ITER) / ITER_MAX) ** N_ITER

# The text below eq. (13): lower and upper bound of F, in this order.
PRINTED_BOUNDS = (F_MAX, F_MIN)
CORRECTED_BOUNDS = (F_MIN, F_MAX)

# For examples only: the paper prints iter_max (Table 5), but neither NP, α, n_iter nor the bounds of F.
EXAMPLE = {
    NP: 50,
    ALPHA: 4,
    ITER_MAX: 150,
    N_ITER: 1,
    F_MIN: sp.Rational(1, 10),
    F_MAX: sp.Rational(9, 10),
}


def sign_over_ranks(by_rank: sp.Expr) -> int:
    """Sign of the derivative of F_i with respect to the rank i, for a positive gain.

    Args:
        by_rank: F_i as an expression in the rank.

    Returns:
        -1 or +1 if it is the same everywhere, else 0.

    Source:
        None (differentiation).
    """
    exponentials = dict.fromkeys(by_rank.atoms(sp.exp), _E)
    return sign_of(sp.diff(by_rank, RANK).subs(exponentials))


def sign_over_generations(factor: sp.Expr, mean: sp.Expr = PRINTED_MEAN) -> int:
    """Sign of the derivative of a scale factor with respect to the generation, before the last one.

    Args:
        factor: The scale factor as an expression in `F_MEAN`, or in the quantities of eq. (13).
        mean: F^mean of eq. (13), with F_max > F_min.

    Returns:
        -1 or +1 if it is the same everywhere, else 0.

    Source:
        None (differentiation).
    """
    rate = sp.diff(factor.subs(F_MEAN, mean), ITER)
    rate = rate.subs(F_MAX, F_MIN + _SPAN).subs(ITER, ITER_MAX * (1 - _LEFT))
    return sign_of(rate)


def sign_of(expression: sp.Expr) -> int:
    """Sign of an expression in positive symbols.

    Args:
        expression: SymPy expression.

    Returns:
        -1 or +1 if it is the same everywhere, else 0.

    Source:
        None (the assumptions of SymPy).
    """
    value = sp.factor(sp.simplify(expression))
    return 1 if value.is_positive else -1 if value.is_negative else 0


def check_by_rank(by_rank: sp.Expr) -> Evidence:
    """Is F_i a falling sigmoid with values between 0 and 1, and 1/2 in the middle of the ranking?

    Args:
        by_rank: F_i as an expression in the rank.

    Returns:
        `Verdict.DEFINITION` if it is.

    Source:
        Nguyen 2021, eq. 12.
    """
    middle, last = by_rank.subs(RANK, NP / 2), by_rank.subs(RANK, NP)
    mirrored = sp.simplify(by_rank + by_rank.subs(RANK, NP - RANK))
    numbers = [_on_ranks(by_rank, shift) for shift in (0, 1)]
    falls = sign_over_ranks(by_rank) == -1 and bool((numbers[1] < numbers[0]).all())
    at_ends = middle == sp.Rational(1, 2) and sp.simplify(last - 1 / (1 + sp.exp(ALPHA / 2))) == 0
    if not falls or not at_ends or mirrored != 1:
        return Evidence(
            Verdict.FALSE, "not a falling sigmoid around the middle rank", f"F = {middle} at i = NP/2"
        )
    return Evidence(
        Verdict.DEFINITION,
        "∂F_i/∂i < 0 for every α > 0, F_i + F_(NP-i) = 1 and F_(NP/2) = 1/2, exactly; falling at 1,000 "
        "random points in CasADi; the range is from 1/(1 + exp(α/2)) at i = NP to below 1/(1 + exp(-α/2)) "
        "at i = 1",
    )


def _on_ranks(by_rank: sp.Expr, shift: int) -> np.ndarray:
    points = np.random.default_rng(0).uniform((1.0, 100.0, 1.0), (99.0, 200.0, 9.0), (_POINTS, 3))
    return evaluate(by_rank.subs(RANK, RANK + shift), [RANK, NP, ALPHA], points)


def check_mean(mean: sp.Expr, bounds: tuple[sp.Symbol, sp.Symbol] = PRINTED_BOUNDS) -> Evidence:
    """Does F^mean fall from F_max to F_min, and what if the words upper and lower are crossed?

    Args:
        mean: F^mean of one generation.
        bounds: What the words call the lower and the upper bound of F.

    Returns:
        `Verdict.CORRECTED` if it falls as the names say and rises as the words say, `Verdict.HOLDS` if it
        falls either way.

    Source:
        Nguyen 2021, eq. 13 and the text around it.
    """
    as_worded = mean.subs(dict(zip(bounds, CORRECTED_BOUNDS, strict=True)), simultaneous=True)
    ends = [sp.simplify(mean.subs(ITER, t)) for t in (0, ITER_MAX)]
    falls = sign_over_generations(F_MEAN, mean) == -1 and falls_in_numbers(mean)
    rises_as_worded = sign_over_generations(F_MEAN, as_worded) == 1
    if not falls or ends != [F_MAX, F_MIN]:
        return Evidence(Verdict.FALSE, "F does not fall", f"it goes from {ends[0]} to {ends[1]}")
    if not rises_as_worded:
        return Evidence(Verdict.HOLDS, "F falls from its upper to its lower bound, as the words say")
    low, high = (as_worded.subs(EXAMPLE).subs(ITER, t) for t in (0, EXAMPLE[ITER_MAX]))
    return Evidence(
        Verdict.CORRECTED,
        "with F_max > F_min: from F_max (iter = 0) to F_min (iter = iter_max), ∂F/∂iter < 0 in between, "
        "exactly; falling at 1,000 random points in CasADi; with the words as printed the derivative is "
        "positive",
        "words as printed, lower bound 0.1 for F_max and upper bound 0.9 for F_min, n_iter = 1: F rises "
        f"from {float(low):g} to {float(high):g}",
    )


def falls_in_numbers(mean: sp.Expr) -> bool:
    """Whether an expression is smaller one generation later, in CasADi.

    Args:
        mean: Expression in the quantities of eq. (13).

    Returns:
        True if it is, at all of 1,000 random points.

    Source:
        None (random testing).
    """
    symbols = [ITER, ITER_MAX, N_ITER, F_MIN, F_MAX]
    low, high = (0.0, 100.0, 0.5, 0.0, 0.5), (98.0, 600.0, 3.0, 0.4, 1.0)
    points = np.random.default_rng(0).uniform(low, high, (_POINTS, 5))
    now, later = (evaluate(mean.subs(ITER, ITER + t), symbols, points) for t in (0, 1))
    return bool((later < now).all())


def _bounds(bounds: tuple[sp.Symbol, sp.Symbol]) -> tuple[Formula, Formula]:
    names = (r"\text{lower boundary condition of } F", r"\text{upper boundary condition of } F")
    lower, upper = (Formula(name, bound) for name, bound in zip(names, bounds, strict=True))
    return lower, upper


CLAIMS = (
    Claim(
        PAPER,
        "12",
        "scale factor by rank",
        Verdict.DEFINITION,
        "For a gain α > 0 a sigmoid that falls over the ranks, from just below 1/(1 + exp(-α/2)) for rank 1 "
        "to 1/(1 + exp(α/2)) for the last, 1/2 in the middle. Neither α nor which end of the ranking is "
        "number 1 is printed; if the best is number 1, the best gets the largest F.",
        Check(functools.partial(check_by_rank, PRINTED_BY_RANK), (Formula("F_i", PRINTED_BY_RANK),)),
        derivation="∂F_i/∂i = -(α/NP) F_i (1 - F_i), negative for every rank.",
    ),
    Claim(
        PAPER,
        "13",
        "scale factor by generation",
        Verdict.CORRECTED,
        "The formula is right: F^mean falls from F_max to F_min. The words below it are crossed: they call "
        "F_max the lower and F_min the upper bound, and with such numbers F would rise. The bounds and "
        "n_iter are not printed, and iter_max is 150 in Table 5 but 600 in the text.",
        Check(
            functools.partial(check_mean, PRINTED_MEAN, PRINTED_BOUNDS),
            (Formula(sp.latex(F_MEAN), PRINTED_MEAN), *_bounds(PRINTED_BOUNDS)),
            _bounds(CORRECTED_BOUNDS),
        ),
        derivation="∂F/∂iter = -n_iter (F_max - F_min) u^(n_iter - 1) / iter_max with "
        "u = (iter_max - iter)/iter_max: negative exactly if F_max > F_min, which is what the text before "
        "the equation asks for (F high in the beginning, small later).",
        correction="F_max is the upper and F_min the lower bound",
        fault=Fault.WORDING,
    ),
)
