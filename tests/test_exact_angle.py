"""Right angles are exact, all others are left alone."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm.exact_angle import cos_sin, quarter_turns


@pytest.mark.parametrize("k", range(-12, 13))
def test_multiples_of_a_right_angle_are_exact(k):
    exact = [(1, 0), (0, 1), (-1, 0), (0, -1)][k % 4]
    for angle in (k * math.pi / 2, math.radians(90.0 * k), 90.0 * k * (math.pi / 180)):
        assert quarter_turns(angle) == k % 4
        assert cos_sin(angle) == exact


@pytest.mark.parametrize("angle_deg", [30, 45, 60, 89.999999, 90.000001, -120, 1e-9])
def test_other_angles_are_no_quarter_turns(angle_deg):
    angle = math.radians(angle_deg)
    assert quarter_turns(angle) is None
    assert cos_sin(angle) == (math.cos(angle), math.sin(angle))


@given(st.floats(-100, 100))
def test_the_answer_is_cosine_and_sine_to_rounding(angle):
    c, s = cos_sin(angle)
    assert abs(c - math.cos(angle)) < 1e-12
    assert abs(s - math.sin(angle)) < 1e-12


@given(st.integers(-40, 40), st.floats(1e-12, 1e-3), st.sampled_from([-1, 1]))
def test_a_small_turn_away_from_a_right_angle_is_kept(k, turn, sign):
    angle = k * math.pi / 2 + sign * turn
    assert quarter_turns(angle) is None
    small = cos_sin(angle)[1 - k % 2]
    assert abs(abs(small) - turn) < 1e-13 + 1e-6 * turn
