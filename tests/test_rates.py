"""Speed and acceleration as matrices: exact where the motion is known, the integral they state."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from smooth_motions import objective, uneven_time

from armik_sym.trajectory.rates import (
    acceleration_matrix,
    sample_durations,
    smoothness_matrix,
    speed_matrix,
)

COUNTS = st.integers(2, 25)
SEEDS = st.integers(0, 10**6)
NUMBERS = st.floats(-3, 3)
WEIGHTS = st.floats(0, 10)


@given(n=COUNTS, seed=SEEDS, a=NUMBERS, b=NUMBERS)
def test_linear_motion_has_its_speed_and_no_acceleration(n, seed, a, b):
    t = uneven_time(n, seed)
    np.testing.assert_allclose(speed_matrix(t) @ (a + b * t), np.full(n - 1, b), atol=1e-10)
    np.testing.assert_allclose(acceleration_matrix(t) @ (a + b * t), np.zeros(max(n - 2, 0)), atol=1e-8)


@given(n=COUNTS, seed=SEEDS, c=NUMBERS)
def test_quadratic_motion_has_its_acceleration(n, seed, c):
    t = uneven_time(n, seed)
    np.testing.assert_allclose(speed_matrix(t) @ (c * t**2), c * (t[1:] + t[:-1]), atol=1e-9)
    np.testing.assert_allclose(acceleration_matrix(t) @ (c * t**2), np.full(max(n - 2, 0), 2 * c), atol=1e-8)


@pytest.mark.parametrize("n", [2, 3])
def test_shortest_motions(n):
    t = np.array([0.0, 0.5, 2.0])[:n]
    assert speed_matrix(t).shape == (n - 1, n)
    assert acceleration_matrix(t).shape == (n - 2, n)
    assert smoothness_matrix(t, 1.0, 1.0, 1.0).shape == (n, n)
    if n == 3:
        # v = 2 and 4/3 rad/s, 1 s apart.
        assert acceleration_matrix(t) @ np.array([0.0, 1.0, 3.0]) == pytest.approx([4 / 3 - 2])


@given(n=COUNTS, seed=SEEDS)
def test_durations_are_positive_and_add_up_to_the_whole(n, seed):
    t = 3.0 + uneven_time(n, seed)
    durations = sample_durations(t)
    assert np.all(durations > 0)
    assert durations.sum() == pytest.approx(t[-1] - t[0], rel=1e-12)
    # The trapezoidal rule: exact for linear functions.
    assert durations @ t == pytest.approx(0.5 * (t[-1] ** 2 - t[0] ** 2), rel=1e-12)


@given(n=COUNTS, seed=SEEDS, speed=WEIGHTS, acceleration=WEIGHTS, posture=WEIGHTS)
def test_smoothness_is_the_integral_it_states(n, seed, speed, acceleration, posture):
    t, q = uneven_time(n, seed), np.random.default_rng(seed).normal(size=n)
    K = smoothness_matrix(t, speed, acceleration, posture).toarray()
    expected = objective(t, q[:, None], np.zeros(1), (speed, acceleration, posture))
    assert 0.5 * q @ K @ q == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert np.array_equal(K, K.T) or np.abs(K - K.T).max() <= 1e-14 * np.abs(K).max()
    assert np.linalg.eigvalsh(K).min() >= -1e-12 * max(np.abs(K).max(), 1.0)
    assert np.all(K[np.abs(np.subtract.outer(np.arange(n), np.arange(n))) > 2] == 0)


def test_standing_still_costs_nothing_but_posture():
    t = uneven_time(8, 0)
    still = np.full(8, 0.3)
    assert still @ smoothness_matrix(t, 1.0, 1.0, 0.0) @ still == pytest.approx(0, abs=1e-12)
    assert still @ smoothness_matrix(t, 1.0, 1.0, 2.0) @ still == pytest.approx(2 * 0.09 * t[-1])


def test_the_integral_converges_to_that_of_a_sine():
    t = np.linspace(0, 2 * np.pi, 2000)
    q = np.sin(t)
    for weights in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
        assert q @ smoothness_matrix(t, *weights) @ q == pytest.approx(np.pi, rel=1e-3)
