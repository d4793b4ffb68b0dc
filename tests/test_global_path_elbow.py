"""What the elbow's accelerations cost between knots, against second differences of every possible motion."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from armik_sym.trajectory.global_path.elbow_change import elbow_change_costs

WEIGHT = 0.03


def energy(theta: np.ndarray, time: np.ndarray) -> np.ndarray:
    """½·weight·θ̈² times its share of time at every sample; none at the ends."""
    h = np.diff(time)
    speed = np.diff(theta) / h
    spacing = 0.5 * (h[1:] + h[:-1])
    inner = 0.5 * WEIGHT * (np.diff(speed) / spacing) ** 2 * spacing
    return np.concatenate([[0.0], inner, [0.0]])


@pytest.mark.parametrize("seed", [*range(20), 245])
def test_costs_are_those_of_the_best_sample_to_change_at(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(6, 30))
    time = np.cumsum(rng.uniform(0.01, 0.05, n))
    bend = np.abs(np.cumsum(0.1 * rng.normal(size=n)))
    theta = np.array([bend, -bend]) + rng.normal() * 0.1
    inner = rng.choice(np.arange(1, n - 1), size=int(rng.integers(1, n - 2)), replace=False)
    knots = np.unique(np.concatenate([[0], inner, [n - 1]]))
    costs = elbow_change_costs(theta, time, knots, WEIGHT)
    # Costs are differences of running sums, so that the whole motion's cost rounds, not that of a step; and
    # an acceleration rounds as its terms do, up to √weight·4·|θ|/h^1.5 in the unit whose square is a cost.
    whole, terms = energy(theta[0], time).sum(), 4 * np.abs(theta).max() / np.diff(time).min() ** 1.5
    rounding = np.finfo(float).eps * (n * whole + np.sqrt(2 * n * whole * WEIGHT) * terms)
    for step, (k, end) in enumerate(itertools.pairwise(knots)):
        for a in (0, 1):
            owned = slice(k + 1, end + 1)  # what happens at the first knot belongs to the step before
            assert costs[step, a, a] == pytest.approx(energy(theta[a], time)[owned].sum(), abs=rounding)
            tried = []
            for last_before in range(k, end):
                mixed = np.where(np.arange(n) <= last_before, theta[a], theta[1 - a])
                # A change right after the first knot also bends the motion there.
                tried.append(energy(mixed, time)[k if last_before == k else k + 1 : end + 1].sum())

            assert costs[step, a, 1 - a] == pytest.approx(min(tried), abs=1e-9, rel=1e-9)


def test_going_straight_through_is_free_and_bouncing_is_not() -> None:
    time = 0.02 * np.arange(21)
    through = np.linspace(-0.4, 0.4, 21)
    theta = np.array([np.abs(through), -np.abs(through)])
    costs = elbow_change_costs(theta, time, np.array([0, 20]), WEIGHT)[0]
    assert costs[0, 1] == pytest.approx(0.0, abs=1e-12)
    assert costs[1, 0] == pytest.approx(0.0, abs=1e-12)
    assert costs[0, 0] > 1.0


def test_without_weight_or_with_two_samples_nothing_costs() -> None:
    theta = np.random.default_rng(0).normal(size=(2, 5))
    assert not elbow_change_costs(theta, np.arange(5.0), np.array([0, 2, 4]), 0.0).any()
    assert not elbow_change_costs(theta[:, :2], np.arange(2.0), np.array([0, 1]), 1.0).any()
