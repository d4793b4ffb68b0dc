"""ISADE in its plainest form, to see what the sign in eq. (14) does to a search."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

DIMENSIONS = 5
GENERATIONS = 150  # iter_max, Table 5
GAIN, F_MIN, F_MAX = 4.0, 0.1, 0.9  # not printed: examples
TAU = 0.10
CLOSE = 1e-5


def generations_needed(sign: int, population: int, seed: int) -> int:
    """Generations until the best individual is within `CLOSE` of the lowest point of a sphere function.

    Mutation by eq. (9)-(11), chosen at random with equal odds; F by eq. (12)-(14); CR by eq. (15);
    binomial crossover; a trial replaces its parent if it is not worse.

    Args:
        sign: Sign before F^mean in eq. (14): -1 as printed, +1 for the average.
        population: Number of individuals NP.
        seed: Seed of the random numbers.

    Returns:
        Number of generations, `GENERATIONS` if that many are not enough.

    Source:
        Nguyen 2021, eq. 9-15.
    """
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1, 1, (population, DIMENSIONS))
    target = rng.uniform(-0.5, 0.5, DIMENSIONS)
    rates = rng.uniform(0, 1, population)
    for generation in range(GENERATIONS):
        distance = np.linalg.norm(x - target, axis=1)
        order = np.argsort(distance, kind="stable")
        x, rates, distance = x[order], rates[order], distance[order]
        if distance[0] < CLOSE:
            return generation
        redrawn = rng.uniform(size=population) <= TAU
        rates = np.where(redrawn, rng.uniform(size=population), rates)
        mutants = _mutants(x, _factors(sign, population, generation), rng)
        crossed = rng.uniform(size=x.shape) <= rates[:, None]
        crossed[np.arange(population), rng.integers(DIMENSIONS, size=population)] = True
        trials = np.where(crossed, mutants, x)
        not_worse = np.linalg.norm(trials - target, axis=1) <= distance
        x = np.where(not_worse[:, None], trials, x)
    return GENERATIONS


def _factors(sign: int, population: int, generation: int) -> NDArray[np.float64]:
    """Eq. (12)-(14), for all ranks, n_iter = 1."""
    rank = np.arange(1, population + 1)
    by_rank = 1 / (1 + np.exp(GAIN * (rank - population / 2) / population))
    mean = F_MIN + (F_MAX - F_MIN) * (GENERATIONS - generation) / GENERATIONS
    return ((by_rank + sign * mean) / 2)[:, None]


def _mutants(x: NDArray[np.float64], F: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Eq. (9)-(11); x is sorted, so the best individual comes first."""
    n = len(x)
    a, b, c, d = x[np.argsort(rng.uniform(size=(n, n)), axis=1)[:, :4]].swapaxes(0, 1)
    strategies = np.stack([x[0] + F * (a - b), x[0] + F * (a - b + c - d), a + F * (x[0] - a + b - c)])
    return strategies[rng.integers(3, size=n), np.arange(n)]
