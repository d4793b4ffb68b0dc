"""Re-timing: limits hold everywhere, nothing is slower than it need be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from servo_helpers import swing, two_links

import armik_sym as ak
from armik_sym.errors import HandPathError, LimitError, RetimingError, ShapeError, UnknownNameError
from armik_sym.servo import retime
from armik_sym.servo.motion import ArmMotion

ARM = two_links()
SLACK = 1 + 1e-9


@st.composite
def motions(draw):
    """Wild motions: uneven times, jumps, standstills."""
    n = draw(st.integers(2, 12))
    steps = draw(st.lists(st.floats(0.01, 0.5), min_size=n - 1, max_size=n - 1))
    angles = st.floats(-2.0, 2.0, allow_subnormal=False).map(lambda x: round(x, 3))
    q = draw(st.lists(st.tuples(angles, angles), min_size=n, max_size=n))
    return ArmMotion(ARM, np.concatenate([[0.0], np.cumsum(steps)]), np.array(q, dtype=float))


@settings(max_examples=60)
@given(
    motion=motions(), speed=st.floats(0.05, 20.0), acceleration=st.floats(0.1, 200.0), faster=st.booleans(),
    only=st.sampled_from(["both", "speed", "acceleration"]), ends=st.sampled_from(["uniform", "rest"]),
)  # fmt: skip
def test_limits_hold_everywhere_and_slowing_all_is_never_faster(
    motion, speed, acceleration, faster, only, ends
):
    v = None if only == "acceleration" else speed
    a = None if only == "speed" and ends == "uniform" else acceleration
    if not np.any(np.diff(motion.q, axis=0)):
        with pytest.raises(RetimingError, match="do not move"):
            retime(motion, v, a)
        return
    result = retime(motion, v, a, ends=ends, faster=faster)
    if ends == "uniform":
        assert result.duration <= result.uniform_duration * (1 + 1e-12)
    if not faster:
        assert result.duration >= motion.time[-1] * (1 - 1e-12)
    dense = np.concatenate([result.time, np.linspace(0, result.duration, 3001), result.law])
    _, rate, change = result.at(np.sort(dense))
    if v is not None:
        assert np.abs(rate).max() <= v * SLACK
    if a is not None:
        assert np.abs(change).max() <= a * SLACK + 1e-12
    np.testing.assert_array_equal(result.q, motion.q)
    np.testing.assert_allclose(result.at(result.time)[0], motion.q, atol=1e-9)
    assert (np.diff(result.time) > 0).all()


@settings(max_examples=25)
@given(motion=motions(), speed=st.floats(0.2, 5.0), acceleration=st.floats(1.0, 50.0))
def test_angles_are_the_integrals_of_speeds_and_speeds_those_of_accelerations(motion, speed, acceleration):
    if not np.any(np.diff(motion.q, axis=0)):
        return
    result = retime(motion, speed, acceleration)
    # In a cell q(s(t)) is a polynomial of degree six in t, which five Gauss points integrate exactly.
    nodes, weights = np.polynomial.legendre.leggauss(5)
    step = np.diff(result.law)
    at = (result.law[:-1, None] + 0.5 * step[:, None] * (1 + nodes)).ravel()
    _, rate, change = result.at(at)
    q, ends, _ = result.at(result.law)
    for values, differences in ((rate, np.diff(q, axis=0)), (change, np.diff(ends, axis=0))):
        inside = values.reshape(len(step), len(nodes), -1)
        total = 0.5 * step[:, None] * np.einsum("k,ikj->ij", weights, inside)
        np.testing.assert_allclose(total, differences, atol=1e-9)


@pytest.mark.parametrize(("speed", "acceleration"), [(0.5, 2.0), (10.0, 2.0)])
def test_a_straight_way_from_rest_to_rest_is_the_textbook_trapezoid_or_triangle(speed, acceleration):
    motion = ArmMotion(ARM, np.array([0.0, 3.0]), np.array([[0.0, 0.0], [1.0, 0.25]]))
    result = retime(motion, speed, acceleration, ends="rest", faster=True)
    if speed**2 / acceleration < 1.0:
        expected = 1.0 / speed + speed / acceleration
    else:
        expected = 2 * math.sqrt(1.0 / acceleration)
    assert result.duration == pytest.approx(expected, rel=2e-3)
    assert result.duration >= expected * (1 - 1e-9)
    _, ends, _ = result.at(np.array([0.0, result.duration]))
    np.testing.assert_allclose(ends, 0.0, atol=1e-9)


def test_a_finer_path_does_not_change_the_time_much():
    """The cells are fine enough: four times as many samples of the same curve change the time by little."""
    coarse, fine = swing(ARM, 1.0, 1.0, 51), swing(ARM, 1.0, 1.0, 201)
    first, second = (retime(m, 1.0, 3.0, ends="rest", faster=True).duration for m in (coarse, fine))
    assert first == pytest.approx(second, rel=0.02)


def test_only_what_is_too_fast_becomes_slower():
    """A fast stretch between two slow ones: slowing all takes much longer."""
    time = np.linspace(0.0, 3.0, 301)
    q = np.column_stack([0.1 * time + 0.5 * np.tanh(20 * (time - 1.5)), 0.05 * time])
    result = retime(ArmMotion(ARM, time, q), speed=1.0)
    assert result.uniform_duration == pytest.approx(3.0 * 10.1, rel=0.01)
    assert result.duration < 4.5
    stretched = np.diff(result.time) / np.diff(time)
    np.testing.assert_allclose(stretched[1:100], 1.0, rtol=1e-9)
    assert stretched.max() > 5.0


def test_a_solution_comes_back_as_a_solution_with_the_same_errors():
    task = ak.load_task("drinking_lift")
    solution = ak.solve(ak.catalog.ehmcs(), task.path, start=task.measured.q[0])
    result = retime(solution, speed=0.4, acceleration=2.0)
    again = result.solution
    np.testing.assert_array_equal(again.q, solution.q)
    np.testing.assert_array_equal(again.time, result.time)
    np.testing.assert_allclose(again.position_error, solution.position_error)
    assert again.max_speed.max() <= 0.4 * SLACK
    assert again.max_acceleration.max() <= 2.0 * SLACK
    assert again.path.duration < result.uniform_duration
    assert solution.cost is not None
    assert again.cost is None  # it was that of the old times
    time, q = result.sampled(1000.0)
    assert np.abs(np.diff(q, axis=0)).max() <= 0.4e-3 * SLACK
    assert time[-1] >= result.duration > time[-2]


def test_what_cannot_be_retimed_is_refused():
    motion = swing(ARM)
    with pytest.raises(RetimingError, match="no limit"):
        retime(motion)
    with pytest.raises(RetimingError, match="needs an acceleration limit"):
        retime(motion, 1.0, ends="rest")
    with pytest.raises(UnknownNameError, match="rest, uniform"):
        retime(motion, 1.0, ends="fast")
    with pytest.raises(LimitError, match="first"):
        retime(motion, [0.0, 1.0])
    with pytest.raises(ShapeError, match="two samples"):
        retime(ArmMotion(ARM, np.zeros(1), np.zeros((1, 2))), 1.0)
    with pytest.raises(HandPathError, match=r"'second'.*sample 1"):
        retime(ArmMotion(ARM, np.arange(2.0), np.array([[0, 0], [1, np.nan]])), 1.0)
