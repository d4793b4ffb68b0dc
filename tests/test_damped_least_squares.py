"""Bounded damped least squares: the right step, never outside the range of motion, and arriving."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_arms import ARMS, postures
from scipy.optimize import lsq_linear
from smooth_motions import path_of, smooth_angles

from armik_sym.arm import RangeOfMotion
from armik_sym.compiled.kinematics import compile
from armik_sym.motion.hand_path import HandPath
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.damped_least_squares import PoseSolver, bounded_step
from armik_sym.trajectory.pose_error import SampleError

ARM = ARMS["ehmcs"]
SEEDS = st.integers(0, 10**6)


def solver_for(arm, path, orientation=Orientation.FULL):
    return PoseSolver(compile(arm), SampleError(arm, path, orientation))


def step_case(seed, rows, joints, room):
    rng = np.random.default_rng(seed)
    q = rng.normal(size=joints)
    below, above = rng.uniform(0, room, (2, joints))
    return rng.normal(size=(rows, joints)), rng.normal(size=rows), q, RangeOfMotion(q - below, q + above)


def best_step(J, e, damping, q, rom):
    A = np.vstack([J, np.sqrt(damping) * np.eye(len(q))])
    b = np.concatenate([e, np.zeros(len(q))])
    low, high = rom.lower - q - 1e-12, rom.upper - q + 1e-12
    return lsq_linear(A, b, (low, high), method="bvls", tol=1e-14).x


@given(seed=SEEDS, rows=st.sampled_from([3, 6]), joints=st.integers(2, 8), room=st.sampled_from([0.5, 2, 50]))
def test_step_stays_inside_and_is_the_best_while_at_most_one_bound_stops_it(seed, rows, joints, room):
    J, e, q, rom = step_case(seed, rows, joints, room)
    step = bounded_step(J, e, 0.1, q, rom)
    low, high = rom.lower - q, rom.upper - q
    assert np.all(step >= low)
    assert np.all(step <= high)
    at_bound = np.count_nonzero((step == low) | (step == high))
    expected = best_step(J, e, 0.1, q, rom)
    if at_bound <= 1:
        np.testing.assert_allclose(step, expected, atol=1e-7)
    cost, best = (np.sum((J @ d - e) ** 2) + 0.1 * d @ d for d in (step, expected))
    assert cost >= best - 1e-9


@given(
    seed=SEEDS, rows=st.sampled_from([3, 6]), joints=st.integers(2, 8), room=st.sampled_from([0.0, 0.5, 2])
)
def test_with_enough_damping_a_step_never_makes_it_worse(seed, rows, joints, room):
    # Several joints stopping at once may cost more than it gains; then `reach` raises the damping.
    J, e, q, rom = step_case(seed, rows, joints, room)
    step = bounded_step(J, e, 1e6, q, rom)
    assert np.sum((J @ step - e) ** 2) <= e @ e * (1 + 1e-12)
    if room == 0.0:
        assert not step.any()


def test_both_kinds_of_case_occur():
    counts = set()
    for seed in range(40):
        J, e, q, rom = step_case(seed, 6, 7, 2)
        step = bounded_step(J, e, 0.1, q, rom)
        counts.add(min(np.count_nonzero((step == rom.lower - q) | (step == rom.upper - q)), 2))
    assert counts == {0, 1, 2}


def test_a_joint_at_its_limit_is_replaced_by_the_others():
    J, e = np.array([[1.0, 1.0]]), np.array([1.0])
    rom = RangeOfMotion([-1.0, -1.0], [0.0, 2.0])
    step = bounded_step(J, e, 1e-9, np.zeros(2), rom)
    assert step[0] == 0
    assert step[1] == pytest.approx(1.0)


@settings(max_examples=40)
@given(seed=SEEDS, orientation=st.sampled_from(Orientation))
def test_poses_near_the_start_are_reached_inside_the_range_of_motion(seed, orientation):
    q = postures(ARM, 1, seed, stretch=0.8)[0]
    offset = np.random.default_rng(seed).uniform(-0.1, 0.1, ARM.dof)
    solver = solver_for(ARM, path_of(ARM, np.vstack([q, q])), orientation)
    reached = solver.reach(0, q + offset, iterations=200)
    assert reached.error < 1e-7
    assert np.all(reached.q >= ARM.rom.lower)
    assert np.all(reached.q <= ARM.rom.upper)


@settings(max_examples=40)
@given(seed=SEEDS)
def test_never_outside_the_range_of_motion_never_worse_than_the_start(seed):
    far = np.random.default_rng(seed).uniform(-1, 1, (2, 3))
    path = HandPath([0.0, 1.0], far)
    solver = solver_for(ARM, path, Orientation.NONE)
    start = postures(ARM, 1, seed, stretch=1.5)[0]
    reached = solver.reach(0, start)
    assert np.all(reached.q >= ARM.rom.lower)
    assert np.all(reached.q <= ARM.rom.upper)
    position = compile(ARM).position(np.vstack([reached.q, ARM.rom.clip(start)]))
    left, before = np.linalg.norm(position - far[0], axis=1)
    assert reached.error == pytest.approx(left, rel=1e-9, abs=1e-12)
    assert left <= before + 1e-12


def test_following_visits_the_samples_in_the_order_given():
    q = smooth_angles(ARM, 30, 1)
    solver = solver_for(ARM, path_of(ARM, q))
    order = np.array([4, 5, 6, 7, 6, 5])
    followed, errors = solver.follow(order, q[4])
    assert followed.shape == (6, 7)
    assert errors.max() < 1e-7
    wanted = compile(ARM).position(q[order])
    assert np.abs(compile(ARM).position(followed) - wanted).max() < 1e-7
    assert np.abs(followed - q[order]).max() < 0.5


@pytest.mark.parametrize(
    ("orientation", "idle"),
    [(Orientation.NONE, [4, 5, 6]), (Orientation.POINTING, []), (Orientation.FULL, [])],
)
def test_idle_joints_of_the_exoskeleton(orientation, idle):
    solver = solver_for(ARM, path_of(ARM, smooth_angles(ARM, 3, 0)), orientation)
    assert solver.idle_joints(postures(ARM, 1, 3)[0]).tolist() == idle
