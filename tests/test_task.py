"""One task: bounds, rate rows and start vectors that belong together."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles, uneven_time

from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.errors import OptionError
from armik_sym.solution.motion_rates import joint_acceleration, joint_speed
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.task import Task

ARM = ARMS["ehmcs"]
DOF = ARM.dof
INF = np.full(DOF, np.inf)


def task_for(n=5, first=None, speed=INF, acceleration=INF, orientation=Orientation.FULL, **options):
    q = smooth_angles(ARM, n, 1)
    path = path_of(ARM, q, uneven_time(n, 1))
    stage = compile_stage(ARM, orientation, "vm")
    return Task(ARM, path, orientation, TrajectoryOptions(**options), speed, acceleration, first, stage), q


LIMITS = (INF, np.full(DOF, 2.0), np.array([1, np.inf, 1, 1, np.inf, 1, 1.0]))


@pytest.mark.parametrize("n", [2, 3, 5])
@pytest.mark.parametrize(("speed", "acceleration"), list(itertools.product(range(3), repeat=2)))
@pytest.mark.parametrize(("soft", "rates"), list(itertools.product((False, True), repeat=2)))
def test_problem_bounds_and_start_have_the_same_sizes(n, speed, acceleration, soft, rates):
    task, q = task_for(n, speed=LIMITS[speed], acceleration=LIMITS[acceleration])
    problem, bounds = task.problem(soft=soft, rates=rates), task.bounds(soft=soft, rates=rates)
    size = problem.x.shape[0]
    assert bounds.lbx.shape == bounds.ubx.shape == task.start_vector(q, soft=soft).shape == (size,)
    assert bounds.lbg.shape == bounds.ubg.shape == (problem.g.shape[0],)
    assert np.all(bounds.lbx <= bounds.ubx)
    assert np.all(bounds.lbg <= bounds.ubg)


def test_angles_are_bounded_by_the_range_of_motion_exactly_and_tracking_is_an_equation():
    task, _ = task_for()
    bounds = task.bounds(soft=False, rates=False)
    assert np.array_equal(bounds.lbx.reshape(5, DOF), np.tile(ARM.rom.lower, (5, 1)))
    assert np.array_equal(bounds.ubx.reshape(5, DOF), np.tile(ARM.rom.upper, (5, 1)))
    assert not bounds.lbg.any()
    assert not bounds.ubg.any()
    soft = task.bounds(soft=True, rates=False)
    assert np.all(np.isinf(soft.ubx[5 * DOF :]))
    assert not soft.lbg.any()


@pytest.mark.parametrize("soft", [False, True])
def test_a_known_first_posture_is_fixed_and_its_equations_dropped(soft):
    first = ARM.rom.middle + 0.01
    task, q = task_for(first=first)
    bounds = task.bounds(soft=soft, rates=False)
    assert np.array_equal(bounds.lbx[:DOF], first)
    assert np.array_equal(bounds.ubx[:DOF], first)
    assert np.array_equal(bounds.lbx[DOF : 2 * DOF], ARM.rom.lower)
    assert np.all(np.isinf(bounds.ubg[:6])) != soft
    assert not bounds.ubg[6:].any()
    start = task.start_vector(q, soft=soft)[: 5 * DOF].reshape(5, DOF)
    assert np.array_equal(start[0], first)
    assert np.array_equal(start[1:], q[1:])


def test_a_soft_start_fulfils_the_tracking_equations():
    task, q = task_for()
    x = task.start_vector(q + 0.05, soft=True)
    g = np.asarray(task.problem(soft=True, rates=False).jacobian(x, [])[0]).ravel()
    assert np.abs(g).max() < 1e-14
    assert np.abs(x[5 * DOF :]).max() > 1e-3


@given(factor=st.floats(0.5, 1.5))
def test_rates_are_exceeded_exactly_where_the_motion_exceeds_them(factor):
    task, q = task_for(8)
    speed = np.abs(joint_speed(task.path.time, q)).max(axis=0)
    acceleration = np.abs(joint_acceleration(task.path.time, q)).max(axis=0)
    expected = factor < 1
    if abs(factor - 1) > 1e-9:
        assert task_for(8, speed=factor * speed)[0].exceeds_rates(q) == expected
        assert task_for(8, acceleration=factor * acceleration)[0].exceeds_rates(q) == expected
    assert not task.exceeds_rates(q)


@pytest.mark.parametrize("limit", [1e-9, 1e-6, 1e-3, 1.0, 1e3])
def test_rate_bounds_lie_inside_the_limits_by_more_than_the_solver_may_miss(limit):
    task, _ = task_for(speed=np.full(DOF, limit), acceleration=np.full(DOF, 2 * limit))
    bounds = task.bounds(soft=False, rates=True)
    rates = bounds.ubg[5 * 6 :]
    assert np.array_equal(bounds.lbg[5 * 6 :], -rates)
    wanted = np.concatenate([np.full(4 * DOF, limit), np.full(3 * DOF, 2 * limit)])
    assert np.all(rates > 0)
    assert np.all(rates + np.minimum(1e-10, limit / 4) < wanted)
    assert np.all(rates >= 0.5 * wanted)


def test_joints_without_a_limit_have_unbounded_rows():
    task, _ = task_for(speed=LIMITS[2])
    rows = task.bounds(soft=False, rates=True).ubg[5 * 6 :].reshape(4, DOF)
    assert np.all(np.isinf(rows[:, [1, 4]]))
    assert np.all(np.isfinite(rows[:, [0, 2, 3, 5, 6]]))


def test_postures_cost_nothing_unless_asked_for_and_the_problem_is_the_same():
    plain, q = task_for()
    zero, _ = task_for(clearance_weight=0, clearance=0.3, prefer="elbow_low", prefer_weight=0)
    asked, _ = task_for(prefer="elbow_low")
    assert plain.posture_cost is None
    assert zero.posture_cost is None
    assert asked.posture_cost is not None
    assert asked.posture_cost.backend == asked.stage.backend
    for soft in (False, True):
        x = plain.start_vector(q, soft=soft)
        problems = [task.problem(soft=soft, rates=False) for task in (plain, zero, asked)]
        multipliers = np.random.default_rng(0).normal(size=problems[0].g.shape[0])
        hessians = [np.asarray(problem.hessian(x, [], 1.0, multipliers)) for problem in problems]
        gradients = [np.asarray(problem.gradient(x, [])[1]) for problem in problems]
        assert np.array_equal(hessians[0], hessians[1])
        assert np.array_equal(gradients[0], gradients[1])
        assert np.abs(hessians[2] - hessians[0]).max() > 1e-3
        assert np.abs(gradients[2] - gradients[0]).max() > 1e-3
        operations = [problem.hessian.n_instructions() for problem in problems]
        assert operations[0] == operations[1] < operations[2]


def test_a_stiff_posture_cost_is_scaled_like_stiff_smoothness():
    gentle, _ = task_for(clearance_weight=1.0)
    stiff, q = task_for(clearance_weight=1e6, clearance=0.02)
    assert (
        gentle.problem(soft=False, rates=False).scale == task_for()[0].problem(soft=False, rates=False).scale
    )
    problem = stiff.problem(soft=False, rates=False)
    x = np.tile(ARM.rom.lower, len(q))
    hessian = np.asarray(problem.hessian(x, [], 1.0, np.zeros(problem.g.shape[0])))
    assert problem.scale < 1e-2
    assert 1e3 < np.abs(hessian).max() < 2e4


def test_the_posture_preferred_is_mid_range_unless_given():
    wish = ARM.rom.lower + 0.4 * ARM.rom.width
    assert np.array_equal(task_for()[0].preferred_posture, ARM.rom.middle)
    assert np.array_equal(task_for(prefer="elbow_in")[0].preferred_posture, ARM.rom.middle)
    assert np.array_equal(task_for(prefer=[0, 1, 0])[0].preferred_posture, ARM.rom.middle)
    assert np.array_equal(task_for(prefer=list(wish))[0].preferred_posture, wish)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"prefer": [0.1] * 6}, "prefer has 6 numbers, but arm 'ehmcs' has 7 joints: expected 7 angles"),
        (
            {"prefer": [0, 0, 0, 3, 0, 0, 0]},
            r"elbow_flexion is 3 rad \(171.9°\), outside .* 0 to 2.53073 rad$",
        ),
        ({"prefer": [0, 0, 0, 90, 0, 0, 0]}, "elbow_flexion is 90 rad .*; angles are in radians"),
        ({"prefer": [0, 0]}, "expected 7 angles in .*or 3 numbers, a direction"),
        ({"clearance": [0.1, 0.2]}, "clearance has 2 numbers, but arm 'ehmcs' has 7 joints"),
    ],
)
def test_preferences_that_do_not_fit_the_arm_are_refused_at_once(options, message):
    with pytest.raises(OptionError, match=message):
        task_for(**options)
