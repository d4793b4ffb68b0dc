"""The searches of ISADE in NumPy, the readable reference of `compiled/c/isade.h`."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.pointwise.differential_evolution.generation import (
    Population,
    factors_by_rank,
    first_population,
    scale_factors,
    trials,
)
from armik_sym.pointwise.differential_evolution.hand_cost import HandCost
from armik_sym.pointwise.differential_evolution.options import IsadeOptions, Measure
from armik_sym.pointwise.random_stream import random_bits, random_branch, random_unit

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SampleResult:
    """Answer for one sample.

    Attributes:
        q: Posture, shape (dof,), in [rad].
        error: Weighted hand error b·‖error‖, in [m].
        generations: Generations of all its searches.
        evaluations: Evaluations of the cost.
    """

    q: Array
    error: float
    generations: int
    evaluations: int


class NumpySearch:
    """ISADE for the samples of one arm, one after another.

    Args:
        arm: The arm.
        options: The options; their `half_window` makes the difference between ISADE and Pro-ISADE.
        measure: What of the hand error counts.

    Source:
        Nguyen 2021, §3.
    """

    def __init__(self, arm: Arm, options: IsadeOptions, measure: Measure) -> None:
        self._rom = arm.rom
        self._options = options
        self._population = options.population_for(measure)
        self._hand_cost = HandCost(arm, options, measure)
        self._by_rank = factors_by_rank(self._population, options.alpha)

    def sample(self, k: int, target: Array, previous: Array, seed: int) -> SampleResult:
        """Search for sample k of a path.

        The first one: full range of motion, a ≥ 0, no stall; then, if the hand is not there yet, and for
        all others: a = 0 in the window around the previous posture. After a stall another search follows in
        the same window, or, if the window moves, in one around the best posture so far.

        Args:
            k: Index of the sample.
            target: Position and rotation row by row, shape (12,).
            previous: Posture of the sample before, or q_0 of eq. (16), shape (dof,), in [rad].
            seed: Seed of everything random.

        Returns:
            The best posture found.

        Source:
            Nguyen 2021, §3.3.
        """
        with np.errstate(all="ignore"):  # targets that are no numbers, or too far away to square
            return self._sample(k, target, previous, random_branch(seed, k))

    def _sample(self, k: int, target: Array, previous: Array, key: int) -> SampleResult:
        options = self._options
        q, error, generations, evaluations = previous, math.inf, 0, 0
        if k == 0:
            found, generations = self._run(
                random_branch(key, 0),
                target,
                q,
                math.inf,
                True,
                options.iter_max,
                travel_weight=options.travel_weight,
            )
            evaluations = self._population * (generations + 1)
            q = found.q[found.best]
            error = float(self._hand_cost(q[None], target)[0])
            if error < options.stop:
                return SampleResult(q, error, generations, evaluations)
        spent, attempt, error = 0, 1, math.inf
        previous, moves = q, options.window_moves or k == 0
        while spent < options.iter_max and not error < options.stop:
            seeded = k == 0 if attempt == 1 else math.isfinite(options.half_window)
            left = options.iter_max - spent
            found, took = self._run(
                random_branch(key, attempt),
                target,
                q,
                options.half_window,
                seeded,
                left,
                around=q if moves else previous,
                may_stall=True,
            )
            spent, attempt = spent + took, attempt + 1
            evaluations += self._population * (took + 1)
            if found.cost[found.best] < error:
                error, q = float(found.cost[found.best]), found.q[found.best]
        return SampleResult(q, error, generations + spent, evaluations)

    def _run(
        self,
        key: int,
        target: Array,
        centre: Array,
        window: float,
        seeded: bool,
        iter_max: int,
        *,
        around: Array | None = None,
        travel_weight: float = 0.0,
        may_stall: bool = False,
    ) -> tuple[Population, int]:
        """One search: the last population, and how many generations it took."""
        options, n, dof = self._options, self._population, len(centre)
        choices, repairs = random_branch(key, 1), random_branch(key, 2)
        middle = centre if around is None else around
        lower = np.maximum(_window_end(middle, -window), self._rom.lower)
        upper = np.minimum(_window_end(middle, window), self._rom.upper)
        q, rate = first_population(random_branch(key, 0), n, lower, upper)
        if seeded:
            q[0] = centre
        now = Population(q, self._cost(q, target, centre, travel_weight), rate)
        for iteration in range(1, iter_max + 1):
            if now.cost[now.best] < options.stop:
                return now, iteration - 1
            first = (iteration - 1) * n
            words = random_bits(choices, first * (5 + dof) + np.arange(n * (5 + dof))).reshape(n, 5 + dof)
            # Eq. (15); printed with ≤, but rand may be 0, and τ = 0 has to mean never.
            fresh = random_unit(words[:, 3]) < options.tau
            now.rate = np.where(fresh, random_unit(words[:, 4]), now.rate)
            factors = scale_factors(options, now.cost, self._by_rank, iteration)
            spare = None
            if options.repair == "random":
                spare = random_bits(repairs, first * dof + np.arange(n * dof)).reshape(n, dof)
            tried = trials(options, now, factors, words, (lower, upper), spare)
            cost = self._cost(tried, target, centre, travel_weight)
            better = cost <= now.cost
            now.q = np.where(better[:, None], tried, now.q)
            now.cost = np.where(better, cost, now.cost)
            best = now.cost[now.best]
            if may_stall and now.cost.max() - best < options.stall * best:
                return now, iteration
        return now, iter_max

    def _cost(self, q: Array, target: Array, centre: Array, travel_weight: float) -> Array:
        cost = self._hand_cost(q, target)
        if travel_weight > 0:
            cost = cost + travel_weight * np.sqrt(np.square(q - centre).sum(axis=1))
        return cost


def _window_end(around: Array, window: float) -> Array:
    """`around + window`; where that rounds to more than the window, one or two numbers nearer."""
    end = around + window
    nearer = end - np.sign(window) * np.abs(end) * np.finfo(np.float64).eps
    return np.where(np.abs(end - around) > abs(window), nearer, end)
