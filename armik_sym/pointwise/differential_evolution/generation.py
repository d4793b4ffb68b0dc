"""One generation of ISADE in NumPy, all individuals at once; `compiled/c/isade_generation.h` line by line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.pointwise.differential_evolution.options import IsadeOptions
from armik_sym.pointwise.random_stream import (
    Words,
    high_half,
    low_half,
    random_below,
    random_bits,
    random_unit,
)

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Mutant = base + F ((A - B) + (C - D)), by indices into r1, r2, r3, r4, best: eq. (9), (10), (11).
_TERMS = np.array([(4, 0, 1, 2, 2), (4, 0, 1, 2, 3), (0, 4, 0, 1, 2)])


@dataclass
class Population:
    """Individuals and what is known of them.

    Attributes:
        q: Postures, shape (NP, dof), in [rad].
        cost: Eq. (16), shape (NP,).
        rate: Crossover rates CR, shape (NP,).
    """

    q: Array
    cost: Array
    rate: Array

    @property
    def best(self) -> int:
        """Row of the first of the best."""
        return int(np.argmin(self.cost))


def first_population(key: int, n: int, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Postures uniform inside the bounds, crossover rates uniform in [0, 1).

    Args:
        key: Random stream.
        n: Number of individuals.
        lower: Lower bounds, shape (dof,).
        upper: Upper bounds, shape (dof,).

    Returns:
        Postures, shape (n, dof), and rates, shape (n,).

    Source:
        None (not in the paper).
    """
    dof = len(lower)
    unit = random_unit(random_bits(key, np.arange(n * (dof + 1))).reshape(n, dof + 1))
    return np.minimum(lower + unit[:, :dof] * (upper - lower), upper), unit[:, dof]


def factors_by_rank(population: int, alpha: float) -> Array:
    """F_i = 1/(1 + exp(α (i - NP/2)/NP)) for the ranks i = 1 … NP.

    Args:
        population: Number of individuals NP.
        alpha: Gain of the sigmoid.

    Returns:
        Shape (NP,).

    Source:
        Nguyen 2021, eq. 12.
    """
    place = (np.arange(1, population + 1) - population / 2) / population
    return np.asarray(1 / (1 + np.exp(alpha * place)))


def mean_factor(options: IsadeOptions, iteration: int) -> float:
    """F_mean = F_min + (F_max - F_min)·((iter_max - iter)/iter_max)^n_iter.

    Args:
        options: The options.
        iteration: Generation, 1 … iter_max.

    Returns:
        F_mean.

    Source:
        Nguyen 2021, eq. 13.
    """
    left = (options.iter_max - iteration) / options.iter_max
    return float(options.f_min + (options.f_max - options.f_min) * left**options.n_iter)


def scale_factors(options: IsadeOptions, cost: Array, by_rank: Array, iteration: int) -> Array:
    """F of every individual in a generation: (F_i ∓ F_mean)/2; equal costs share a rank.

    Args:
        options: The options.
        cost: Costs, shape (NP,).
        by_rank: Eq. (12), shape (NP,).
        iteration: Generation, 1 … iter_max.

    Returns:
        Shape (NP,).

    Source:
        Nguyen 2021, eq. 14.
    """
    rank = np.searchsorted(np.sort(cost), cost, side="left")
    sign = -1.0 if options.sign == "printed" else 1.0
    return np.asarray((by_rank[rank] + sign * mean_factor(options, iteration)) / 2)


def partners(words: Words, population: int) -> Indices:
    """Four individuals r1 … r4 for each, different from each other and from itself.

    Each is a number below what is left, counted past those that are taken, from the lowest.

    Args:
        words: Two random words for each individual, shape (NP, 2).
        population: Number of individuals NP ≥ 5.

    Returns:
        Shape (NP, 4).

    Source:
        Nguyen 2021, eq. 9-11 (that they differ is convention: Storn & Price 1997).
    """
    draws = (high_half(words[:, 0]), low_half(words[:, 0]), high_half(words[:, 1]), low_half(words[:, 1]))
    taken = np.arange(population)[:, None]
    for k, bits in enumerate(draws):
        r = random_below(bits, population - 1 - k)
        for row in np.sort(taken, axis=1).T:
            r = r + (r >= row)
        taken = np.column_stack([taken, r])
    return taken[:, 1:]


def trials(
    options: IsadeOptions,
    individuals: Population,
    factors: Array,
    words: Words,
    bounds: tuple[Array, Array],
    repairs: Words | None,
) -> Array:
    """Mutation, repair and binomial crossover.

    Args:
        options: The options.
        individuals: The population, with the crossover rates of this generation.
        factors: Scale factors F, shape (NP,).
        words: Random words, shape (NP, 5 + dof).
        bounds: Lower and upper bounds, shape (dof,) each.
        repairs: Random words for `repair="random"`, shape (NP, dof); None for the other repairs.

    Returns:
        Trials, shape (NP, dof), inside the bounds.

    Source:
        Nguyen 2021, eq. 9-11 and §3.1.
    """
    q = individuals.q
    population, dof = q.shape
    lower, upper = bounds
    strategy = random_below(high_half(words[:, 0]), 3)
    joint = random_below(low_half(words[:, 0]), dof)
    rows = np.column_stack([partners(words[:, 1:3], population), np.full(population, individuals.best)])
    base, A, B, C, D = q[np.take_along_axis(rows, _TERMS[strategy], axis=1).T]
    mutant = base + factors[:, None] * ((A - B) + (C - D))
    if options.repair != "clip":
        mutant = _repaired(options.repair, mutant, base, lower, upper, repairs)
    crossed = random_unit(words[:, 5:]) < individuals.rate[:, None]
    crossed[np.arange(population), joint] = True
    return np.where(crossed, np.minimum(np.maximum(mutant, lower), upper), q)


def _repaired(
    repair: str, mutant: Array, base: Array, lower: Array, upper: Array, repairs: Words | None
) -> Array:
    outside = (mutant < lower) | (mutant > upper)
    bound = np.where(mutant < lower, lower, upper)
    if repair == "reflect":
        inside = 2 * bound - mutant
    elif repair == "midpoint":
        inside = (bound + base) / 2
    else:
        inside = lower + random_unit(0 if repairs is None else repairs) * (upper - lower)
    return np.where(outside, inside, mutant)
