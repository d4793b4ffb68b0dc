"""Speed, acceleration and way of motions known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from smooth_motions import uneven_time

from armik_sym.solution.motion_rates import arc_length, joint_acceleration, joint_speed
from armik_sym.trajectory.rates import acceleration_matrix, speed_matrix

NUMBERS = st.floats(-5, 5)


@given(n=st.integers(2, 30), seed=st.integers(0, 10**6), a=NUMBERS, b=NUMBERS, c=NUMBERS)
def test_exact_for_quadratic_motions_with_uneven_steps(n, seed, a, b, c):
    t = uneven_time(n, seed)
    q = (a + b * t + c * t**2)[:, None]
    midway = 0.5 * (t[1:] + t[:-1])
    np.testing.assert_allclose(joint_speed(t, q)[:, 0], b + 2 * c * midway, atol=1e-9)
    np.testing.assert_allclose(joint_acceleration(t, q)[:, 0], np.full(max(n - 2, 0), 2 * c), atol=1e-7)


@given(n=st.integers(2, 12), seed=st.integers(0, 10**6))
def test_the_verdict_and_the_solver_measure_the_same_rates(n, seed):
    t, q = uneven_time(n, seed), np.random.default_rng(seed).normal(size=(n, 3))
    np.testing.assert_allclose(joint_speed(t, q), speed_matrix(t) @ q, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(joint_acceleration(t, q), acceleration_matrix(t) @ q, rtol=1e-9, atol=1e-9)


def test_arc_length():
    assert arc_length(np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 3.0]])) == pytest.approx(6.0)
    assert arc_length(np.ones((4, 2))) == 0.0
