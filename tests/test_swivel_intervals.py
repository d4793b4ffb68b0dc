"""Feasible swivel intervals: against dense scans, at singularities, and what blocks where there are none."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spherical_arms import ARMS, OF_THE_PAPERS, poses
from swivel_backends import swivel_backend

from armik_sym.arm import Arm
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.swivel.blocking import blocking
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.closed_form import position_curve
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals, intervals_of_curves
from armik_sym.swivel.limit_cuts import wrapped, zeros
from armik_sym.swivel.spherical_arm import recognise

TURN = 2 * np.pi
SCAN = -np.pi + TURN * (np.arange(10_000) + 0.5) / 10_000


@pytest.fixture(autouse=True, scope="module", params=["auto", "vm"])
def backend(request: pytest.FixtureRequest) -> Iterator[None]:
    with swivel_backend(request.param):
        yield


def narrowed(arm: Arm, rng: np.random.Generator) -> Arm:
    centre = rng.uniform(arm.rom.lower, arm.rom.upper)
    half = arm.rom.width * rng.uniform(0.1, 0.45)
    return arm.with_rom(np.maximum(arm.rom.lower, centre - half), np.minimum(arm.rom.upper, centre + half))


def margins(intervals: FeasibleIntervals, sample: int, branch: int, psi: np.ndarray) -> np.ndarray:
    """Smallest margin of all joints, from the postures themselves."""
    e, s, w = intervals.branches[branch]
    curve = intervals.curves[0 if e == 1 else 1].rows(np.full(len(psi), sample))
    return curve.spherical.arm.rom.margin(curve.postures(psi, s, w).q).min(axis=1)


def inside(intervals: FeasibleIntervals, sample: int, branch: int, psi: np.ndarray) -> np.ndarray:
    mine = intervals.of(sample, branch)
    found = np.zeros(len(psi), dtype=bool)
    for start, end in mine:
        found |= ((psi >= start) & (psi <= end)) | ((psi + TURN >= start) & (psi + TURN <= end))
    return found


@pytest.mark.parametrize("name", ARMS)
def test_intervals_are_what_a_dense_scan_finds_and_end_at_limits(name: str) -> None:
    rng = np.random.default_rng(1)
    kinds = np.zeros(3, dtype=int)
    for k in range(3):
        arm = narrowed(ARMS[name], rng)
        beyond = 0.1 if k % 2 else 0.0
        q = rng.uniform(arm.rom.lower - beyond, arm.rom.upper + beyond)[None]
        intervals = feasible_intervals(recognise(arm), *poses(arm, q))
        for branch in range(8):
            found = margins(intervals, 0, branch, SCAN) >= 0
            np.testing.assert_array_equal(inside(intervals, 0, branch, SCAN), found)
            assert intervals.empty[0, branch] == (not len(intervals.of(0, branch)))
            kinds[0] += not found.any()
            for start, end in intervals.of(0, branch):
                assert -np.pi <= start < np.pi
                assert start <= end <= start + TURN
                if end - start > TURN - 1e-9:
                    kinds[1] += 1
                    continue
                kinds[2] += 1
                around = np.array([start - 1e-9, start + 1e-9, end - 1e-9, end + 1e-9])
                np.testing.assert_array_equal(
                    margins(intervals, 0, branch, around) >= 0, [False, True, True, False]
                )
    assert kinds[0]
    assert kinds[2]


@pytest.mark.parametrize("name", OF_THE_PAPERS)
def test_the_posture_that_made_the_pose_is_inside_an_interval(name: str) -> None:
    arm = ARMS[name]
    spherical = recognise(arm)
    q = arm.rom.random_postures(np.random.default_rng(2), 300)
    at = swivel_of_postures(spherical, q)
    intervals = feasible_intervals(spherical, *poses(arm, q))
    for i in np.flatnonzero(np.abs(at.sines).min(axis=1) > 1e-6):
        signs = at.elbow[i], at.shoulder[i], at.wrist[i]
        branch = int(np.flatnonzero((intervals.branches == signs).all(axis=1))[0])
        assert inside(intervals, i, branch, at.psi[[i]]).all()
    order = intervals.sample * 8 + intervals.branch
    assert (np.diff(order) >= 0).all()


def test_joints_that_turn_all_around_leave_the_whole_circle() -> None:
    arm = ehmcs().with_rom(np.full(7, -np.pi), np.full(7, np.pi))
    intervals = feasible_intervals(recognise(arm), *poses(arm, np.full((3, 7), 0.4)))
    assert not intervals.empty.any()
    assert len(intervals.start) == 24
    np.testing.assert_array_equal(intervals.start, -np.pi)
    np.testing.assert_array_equal(intervals.end, np.pi)


def test_turns_of_360_degrees_count_where_the_range_allows_them() -> None:
    arm = ehmcs()
    q = np.array([[0.3, 0.4, 0.2, 1.0, 0.1, 0.2, 0.1]])
    spherical = recognise(arm)
    plain = feasible_intervals(spherical, *poses(arm, q))
    shift = np.zeros(7)
    shift[[0, 4]] = TURN, -TURN
    moved = recognise(arm.with_rom(arm.rom.lower + shift, arm.rom.upper + shift))
    turned = feasible_intervals(moved, *poses(arm, q))
    np.testing.assert_allclose(turned.start, plain.start, atol=1e-12)
    np.testing.assert_allclose(turned.end, plain.end, atol=1e-12)
    at = swivel_of_postures(spherical, q)
    e = 0 if at.elbow[0] == 1 else 1
    back = turned.curves[e].postures(at.psi, at.shoulder, at.wrist).q
    np.testing.assert_allclose(back - q, shift[None], atol=1e-12)


def test_a_locked_joint_leaves_single_swivel_angles() -> None:
    arm = human()
    q = arm.rom.random_postures(np.random.default_rng(3), 40)
    q[:, 2] = 0.2
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    lower[2] = upper[2] = 0.2
    spherical = recognise(arm.with_rom(lower, upper))
    intervals = feasible_intervals(spherical, *poses(arm, q))
    at = swivel_of_postures(spherical, q)
    assert not intervals.empty.all(axis=1).any()
    assert (intervals.end - intervals.start).max() < 1e-7
    nearest = [np.abs(wrapped(intervals.start[intervals.sample == i] - at.psi[i])).min() for i in range(40)]
    assert max(nearest) < 1e-7


@settings(max_examples=25)
@given(
    st.sampled_from(OF_THE_PAPERS),
    st.sampled_from([0.0, 1e-15, 1e-9, 1e-4]),
    st.sampled_from([0.0, 1e-15, 1e-9, 1e-4]),
    st.sampled_from([0.0, 1e-15, 1e-9, 1e-4]),
    st.integers(0, 1000),
)
def test_intervals_near_singularities_hold_only_feasible_postures(
    name: str, straight: float, shoulder: float, wrist: float, seed: int
) -> None:
    arm = ARMS[name]
    lower = arm.rom.lower.copy()
    lower[3] = 0.0
    spherical = recognise(arm.with_rom(lower, arm.rom.upper))
    q = arm.rom.random_postures(np.random.default_rng(seed), 1)
    q[0, 1], q[0, 3], q[0, 5] = shoulder - spherical.shoulder.offset, straight, wrist - spherical.wrist.offset
    intervals = feasible_intervals(spherical, *poses(arm, q))
    assert np.isfinite(intervals.start).all()
    assert np.isfinite(intervals.end).all()
    share = np.linspace(0.001, 0.999, 200)
    for sample, branch, start, end in zip(
        intervals.sample, intervals.branch, intervals.start, intervals.end, strict=True
    ):
        if end - start > 1e-6:
            psi = start + (end - start) * share
            assert margins(intervals, int(sample), int(branch), psi).min() > -1e-7


@pytest.mark.parametrize("aside", [0.0, 1.0])
def test_arm_straight_along_the_first_axis(aside: float) -> None:
    """The outer axes of the shoulder are parallel for every swivel angle: their sum has limits."""
    arm = ehmcs().with_rom(np.deg2rad([-10, -180, -20, 0, -110, -73, -20]), ehmcs().rom.upper)
    arm = arm.with_rom(arm.rom.lower, np.deg2rad([30, 180, 40, 145, 75, 73, 40]))
    spherical = recognise(arm)
    q = np.array([[0.1, -spherical.shoulder.offset + aside, 0.1, 0.0, 0.1, 0.1, 0.1]])
    intervals = feasible_intervals(spherical, *poses(arm, q))
    assert len(intervals.start)
    for branch in range(4):
        found = margins(intervals, 0, branch, SCAN) >= 0
        np.testing.assert_array_equal(inside(intervals, 0, branch, SCAN), found)


@pytest.mark.parametrize("name", OF_THE_PAPERS)
def test_what_is_missing_opens_the_sample_and_no_less(name: str) -> None:
    rng = np.random.default_rng(5)
    tried = 0
    for _ in range(4):
        arm = narrowed(ARMS[name], rng)
        q = rng.uniform(arm.rom.lower - 0.5, arm.rom.upper + 0.5, (4, 7))
        position, rotation = poses(arm, q)
        intervals = feasible_intervals(recognise(arm), position, rotation)
        answer = blocking(intervals)
        np.testing.assert_array_equal(answer.sample, np.flatnonzero(intervals.empty.all(axis=1)))
        for i, missing, joint in zip(answer.sample, answer.missing, answer.joint, strict=True):
            assert missing > 0
            opened = []
            for extra in (missing + 1e-6, missing - 1e-5):
                wider = arm.with_rom(arm.rom.lower - extra, arm.rom.upper + extra)
                again = feasible_intervals(recognise(wider), position[[i]], rotation[[i]])
                opened.append(not again.empty.all())
            assert opened == [True, False]
            assert 0 <= joint < 7
            tried += 1
    assert tried > 3


def test_blocking_names_the_joint_and_the_branch() -> None:
    arm = alfaiz()
    q = np.zeros((1, 7))
    q[0] = 0.3, 0.2, 0.4, np.deg2rad(150), 0.2, 0.3, 0.1
    intervals = feasible_intervals(recognise(arm), *poses(arm, q))
    answer = blocking(intervals)
    assert arm.joint_names[answer.joint[0]] == "elbow_flexion"
    assert np.rad2deg(answer.missing[0]) == pytest.approx(5, abs=1e-9)
    other = blocking(intervals, branch=5)
    assert other.branch[0] == 5
    assert other.missing[0] > answer.missing[0]
    far = feasible_intervals(recognise(arm), np.array([[2.0, 0, 0]]), np.eye(3)[None])
    assert blocking(far).shortfall[0] == pytest.approx(2 - 0.54)
    assert not len(blocking(far, samples=[]).sample)


def test_positions_have_four_branches_and_the_wrist_held() -> None:
    arm = human()
    spherical = recognise(arm)
    q = arm.rom.random_postures(np.random.default_rng(6), 20)
    position, _ = poses(arm, q)
    curves = tuple(position_curve(spherical, position, q[:, 4:], e) for e in (1, -1))
    intervals = intervals_of_curves((curves[0], curves[1]))
    assert intervals.branches.shape == (4, 3)
    assert not intervals.empty.all(axis=1).any()
    for i in range(5):
        for branch in range(4):
            found = margins(intervals, i, branch, SCAN) >= 0
            np.testing.assert_array_equal(inside(intervals, i, branch, SCAN), found)
    assert not len(blocking(intervals).sample)


def test_zeros_of_the_limit_equation() -> None:
    psi = np.array([[-2.0, 1.0], [0.5, 0.5], [-np.pi, 0.2]])
    middle, half = psi.mean(axis=1), np.diff(psi, axis=1)[:, 0] / 2
    coefficients = 3.0 * np.column_stack([-np.cos(half), np.cos(middle), np.sin(middle)])
    np.testing.assert_allclose(np.sort(zeros(coefficients), axis=1)[[0, 2]], psi[[0, 2]], atol=1e-14)
    np.testing.assert_allclose(zeros(coefficients)[1], 0.5, atol=1e-7)
    assert np.isnan(zeros(np.array([[0.0, 0, 0], [2.0, 1, 0]]))).all()
    assert (wrapped(np.array([np.pi, -np.pi, 3.5])) < np.pi).all()
