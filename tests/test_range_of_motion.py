"""The range of motion: margins, clipping, and limits that contradict each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.errors import ArmModelError

ANGLE = st.floats(-7, 7)
JOINT = st.tuples(ANGLE, ANGLE, ANGLE)  # two limits and an angle


def case(joints):
    lower, upper = np.sort(np.array(joints)[:, :2], axis=1).T
    return RangeOfMotion(lower, upper), np.array(joints)[:, 2]


@given(st.lists(JOINT, min_size=1, max_size=8))
def test_the_margin_is_negative_exactly_outside(joints):
    rom, q = case(joints)
    inside = (q >= rom.lower) & (q <= rom.upper)
    np.testing.assert_array_equal(rom.margin(q) >= 0, inside)


@given(st.lists(JOINT, min_size=1, max_size=8))
def test_the_margin_is_the_distance_to_the_nearer_limit(joints):
    rom, q = case(joints)
    inside = rom.margin(q) >= 0
    nearer = np.minimum(abs(q - rom.lower), abs(q - rom.upper))
    np.testing.assert_array_equal(abs(rom.margin(q))[inside], nearer[inside])
    np.testing.assert_array_equal(-rom.margin(q)[~inside], nearer[~inside])


@given(st.lists(JOINT, min_size=1, max_size=8))
def test_clipping_moves_to_the_nearest_posture_inside_and_only_if_outside(joints):
    rom, q = case(joints)
    clipped = rom.clip(q)
    assert np.all(rom.margin(clipped) >= 0)
    np.testing.assert_array_equal(rom.clip(clipped), clipped)
    np.testing.assert_allclose(abs(clipped - q), np.maximum(0, -rom.margin(q)), atol=1e-14)


@given(st.lists(JOINT, min_size=1, max_size=8))
def test_the_middle_is_as_far_from_both_limits_as_can_be(joints):
    rom, _ = case(joints)
    np.testing.assert_allclose(rom.margin(rom.middle), rom.width / 2, atol=1e-14)
    assert rom.dof == len(joints)


def test_many_samples_are_judged_row_by_row():
    rom = RangeOfMotion([0.0, -1.0], [2.0, 1.0])
    q = np.array([[0.5, 0.0], [2.5, -3.0], [0.0, 1.0]])
    np.testing.assert_allclose(rom.margin(q), [[0.5, 1.0], [-0.5, -2.0], [0.0, 0.0]])
    np.testing.assert_allclose(rom.clip(q), [[0.5, 0.0], [2.0, -1.0], [0.0, 1.0]])


def test_degrees_are_converted():
    rom = RangeOfMotion.from_degrees([-180, 0], [90, 145])
    np.testing.assert_allclose(rom.lower, [-math.pi, 0])
    np.testing.assert_allclose(rom.upper, [math.pi / 2, math.radians(145)])


def test_a_joint_may_be_locked():
    rom = RangeOfMotion([0.5], [0.5])
    assert rom.width[0] == 0
    assert rom.clip([3.0])[0] == 0.5


def test_limits_are_read_only_copies():
    lower = np.zeros(2)
    rom = RangeOfMotion(lower, np.ones(2))
    lower[0] = -5.0
    assert rom.lower[0] == 0.0
    for values in (rom.lower, rom.upper):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1.0


def test_crossed_limits_are_refused_with_joint_and_values():
    with pytest.raises(ArmModelError, match=r"joint 2 has lower limit 0.5 above upper limit 0.25 rad"):
        RangeOfMotion([0, 0.5, 0], [1, 0.25, 1])


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("key", ["lower", "upper"])
def test_limits_that_are_not_finite_are_refused_with_joint_and_value(key, value):
    limits = {"lower": [0.0, 0.0, 0.0], "upper": [1.0, 1.0, 1.0]}
    limits[key][2] = value
    with pytest.raises(ArmModelError) as caught:
        RangeOfMotion(**limits)
    assert f"{key} limit of joint 3 is {value}, expected a finite angle" in str(caught.value)


def test_as_many_lower_as_upper_limits_are_needed():
    with pytest.raises(ArmModelError, match="2 lower limits but 3 upper ones"):
        RangeOfMotion([0, 0], [1, 1, 1])


@pytest.mark.parametrize("lower", [0.0, [], [[0.0, 0.0]]])
def test_limits_are_one_row_of_numbers(lower):
    with pytest.raises(ArmModelError, match=r"lower has shape .*expected \(dof,\)"):
        RangeOfMotion(lower, [1.0, 1.0])


@pytest.mark.parametrize("upper", ["straight", ["one"], [[1], [1, 2]]])
def test_limits_that_are_no_numbers_are_refused(upper):
    with pytest.raises(ArmModelError) as caught:
        RangeOfMotion([0.0], upper)
    assert f"upper is {upper!r}, expected numbers" in str(caught.value)


def test_random_postures_fill_the_range_and_nothing_else():
    rom = RangeOfMotion.from_degrees([-10, 0, 5], [20, 90, 5])
    postures = rom.random_postures(np.random.default_rng(0), 2000)
    assert postures.shape == (2000, 3)
    assert (rom.margin(postures) >= 0).all()
    assert (np.ptp(postures, axis=0) >= 0.95 * rom.width).all()
