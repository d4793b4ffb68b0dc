"""Measured motions with other time stamps than the solution."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from smooth_motions import smooth_angles
from solutions import of_motion

import armik_sym as ak
from armik_sym.comparison.sampling import align
from armik_sym.errors import HandPathError, OptionError
from armik_sym.motion import JointMotion

HUMAN = ak.catalog.human()
STRAIGHT = np.zeros(1, dtype=np.bool_)
ROUND = np.ones(1, dtype=np.bool_)


def column(*values):
    return np.array(values, dtype=np.float64)[:, None]


def test_a_straight_line_is_met_exactly_between_samples_and_the_rates_are_said():
    time, known = np.arange(0.0, 2.0, 0.05), np.arange(-0.1, 2.2, 1 / 59.94)
    at = align(time, known, 3 * known[:, None] - 1, STRAIGHT, None)
    np.testing.assert_allclose(at.q[:, 0], 3 * time - 1, atol=1e-12)
    assert np.array_equal(at.rows, np.arange(len(time)))
    (note,) = at.notes
    assert "59.94 Hz" in note
    assert "20 Hz" in note


def test_nothing_is_said_beyond_the_overlap():
    time, known = np.linspace(0.0, 4.0, 41), np.linspace(1.0, 2.5, 16)
    at = align(time, known, known[:, None], STRAIGHT, None)
    assert time[at.rows[[0, -1]]] == pytest.approx([1.0, 2.5])
    assert any("25 of 41 samples of the solution lie outside" in note for note in at.notes)


def test_rounded_time_stamps_are_the_same_time_stamps():
    time = np.arange(50) / 59.94
    at = align(time, np.round(time, 5), time[:, None], STRAIGHT, None)
    assert at.notes == ()
    assert np.array_equal(at.q[:, 0], time)


def test_missing_values_are_not_bridged_and_do_not_spread():
    known = np.arange(6.0)
    q = column(0, 1, np.nan, 3, 4, 5)
    at = align(np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5]), known, q, STRAIGHT, None)
    np.testing.assert_array_equal(at.q[:, 0], [0.5, 1, np.nan, np.nan, np.nan, 3, 3.5])


def test_holes_stay_holes_unless_asked_for():
    known = np.concatenate([np.arange(0.0, 1.0, 0.1), np.arange(2.0, 3.0, 0.1)])
    time = np.linspace(0.05, 2.85, 29)
    inside = (time > 0.9) & (time < 2.0)
    at = align(time, known, known[:, None], STRAIGHT, None)
    assert np.array_equal(np.isnan(at.q[:, 0]), inside)
    assert any(f"{inside.sum()} samples lie in holes" in note for note in at.notes)
    bridged = align(time, known, known[:, None], STRAIGHT, 2.0)
    np.testing.assert_allclose(bridged.q[:, 0], time, atol=1e-12)


def test_samples_left_out_of_the_same_clock_are_holes_and_nothing_is_interpolated():
    time = np.arange(0.0, 1.0, 0.01)
    kept = np.r_[0:40, 60:100]
    at = align(time, time[kept], time[kept, None], STRAIGHT, None)
    assert np.flatnonzero(np.isnan(at.q[:, 0])).tolist() == list(range(40, 60))
    assert np.array_equal(at.q[kept, 0], time[kept])
    assert not any("interpolated" in note for note in at.notes)


def test_joints_that_turn_round_are_interpolated_the_short_way():
    known, q = np.array([0.0, 1.0]), np.deg2rad(column(170, -170))
    half = np.array([0.5])
    assert np.rad2deg(align(half, known, q, ROUND, 10.0).q[0, 0]) == pytest.approx(180)
    assert np.rad2deg(align(half, known, q, STRAIGHT, 10.0).q[0, 0]) == pytest.approx(0)


def test_no_time_in_common_and_bad_holes_are_refused():
    with pytest.raises(HandPathError, match="no time in common"):
        align(np.array([0.0, 1.0]), np.array([5.0, 6.0]), column(0, 0), STRAIGHT, None)
    for hole in (0.0, -1.0, np.nan):
        with pytest.raises(OptionError, match="longest_hole"):
            align(np.array([0.0, 1.0]), np.array([0.0, 1.0]), column(0, 0), STRAIGHT, hole)


@given(st.integers(2, 40), st.integers(2, 40), st.integers(0, 10**6))
def test_interpolated_angles_lie_between_their_neighbours(n, m, seed):
    rng = np.random.default_rng(seed)
    time, known = np.sort(rng.uniform(0, 1, n)), np.sort(rng.uniform(0.2, 0.8, m))
    if np.diff(time).min() < 1e-6 or np.diff(known).min() < 1e-6:
        return
    q = rng.normal(size=(m, 1))
    try:
        at = align(time, known, q, STRAIGHT, 1.0)
    except HandPathError:
        assert not ((time >= known[0]) & (time <= known[-1])).any()
        return
    inside = time[at.rows]
    np.testing.assert_allclose(at.q[:, 0], np.interp(inside, known, q[:, 0]), atol=5e-3 * np.ptp(q) + 1e-12)
    assert at.q.min() >= q.min() - 1e-12
    assert at.q.max() <= q.max() + 1e-12


def test_a_comparison_at_another_rate_says_so():
    time = np.linspace(0.0, 4.0, 81)
    solved = of_motion(HUMAN, smooth_angles(HUMAN, 81, 3), time=time)
    known = np.linspace(-1.0, 3.0, 161)
    measured = np.column_stack([np.interp(known, time, angle) for angle in solved.q.T]) - np.deg2rad(4.0)
    c = ak.compare(solved, JointMotion(known, measured, HUMAN.joint_names))
    assert c.time[-1] == pytest.approx(3.0)
    assert len(c.time) == 61
    np.testing.assert_allclose(np.rad2deg(c.joint_difference), 4.0, atol=1e-9)
    assert any("outside" in note for note in c.notes)
    assert "note: compared where both are known, 0 s to 3 s" in str(c)
