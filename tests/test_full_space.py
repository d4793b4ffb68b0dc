"""The whole-trajectory problem: its derivatives against finite differences, its values against NumPy."""

from __future__ import annotations

import itertools

import casadi as ca
import numpy as np
import pytest
import scipy.sparse as sp
from compiled_helpers import needs_cc
from sample_arms import ARMS
from smooth_motions import objective, smooth_angles, smooth_path, uneven_time

from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.motion.hand_path import HandPath
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.full_space import to_casadi
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.task import Task

ARM = ARMS["human"]
N = 4
CASES = list(itertools.product(Orientation, (False, True), (False, True)))


# Wide, so that random postures are inside it; joints 3, 5 and 7 have less room than that.
POSTURE = {
    "clearance_weight": 3.0,
    "clearance": 1.2,
    "prefer": [0.6, -0.48, 0.64],
    "prefer_weight": 5.0,
}


def task_for(arm=ARM, orientation=Orientation.FULL, n=N, backend="vm", seed=0, **further):
    path, _ = smooth_path(arm, n, seed)
    path = HandPath(uneven_time(n, seed), path.position, path.rotation)
    options = TrajectoryOptions(acceleration_weight=0.05, posture_weight=0.02, **further)
    limits = np.full(arm.dof, 3.0), np.full(arm.dof, 20.0)
    return Task(arm, path, orientation, options, *limits, None, compile_stage(arm, orientation, backend))


def random_point(task, soft, seed=1):
    rng = np.random.default_rng(seed)
    q = smooth_angles(task.arm, len(task.path), seed) + rng.normal(0, 0.05, (len(task.path), task.arm.dof))
    errors = rng.normal(0, 0.1, len(task.path) * task.orientation.equations) if soft else []
    return np.concatenate([q.ravel(), errors])


def central(f, x, h=1e-6):
    """Columns df/dx_i by central differences."""
    return np.array([(f(x + h * e) - f(x - h * e)) / (2 * h) for e in np.eye(len(x))]).T


def evaluators(problem):
    f = ca.Function("f", [problem.x], [problem.f])
    g = ca.Function("g", [problem.x], [problem.g])
    return lambda x: float(f(x)), lambda x: np.asarray(g(x)).ravel()


@pytest.mark.parametrize(("orientation", "soft", "rates"), CASES)
def test_derivatives_equal_finite_differences(orientation, soft, rates):
    check_derivatives(task_for(orientation=orientation), soft, rates, quadratic=True)


@pytest.mark.parametrize(("soft", "rates"), list(itertools.product((False, True), repeat=2)))
def test_derivatives_equal_finite_differences_with_clearance_and_elbow(soft, rates):
    task = task_for(**POSTURE)
    assert np.count_nonzero(ARM.rom.margin(random_point(task, False).reshape(N, -1)) < 0.5) > N
    check_derivatives(task, soft, rates, quadratic=False)


def check_derivatives(task, soft, rates, *, quadratic):
    problem = task.problem(soft=soft, rates=rates)
    f, g = evaluators(problem)
    x = random_point(task, soft)

    value, gradient = problem.gradient(x, [])
    assert float(value) == pytest.approx(f(x), rel=1e-14)
    by_values = central(f, x, h=1e-2 if quadratic else 1e-5)
    np.testing.assert_allclose(np.asarray(gradient).ravel(), by_values, rtol=1e-6, atol=1e-5)

    value, jacobian = problem.jacobian(x, [])
    np.testing.assert_allclose(np.asarray(value).ravel(), g(x), rtol=1e-14)
    np.testing.assert_allclose(np.asarray(jacobian), central(g, x), rtol=1e-6, atol=2e-6)

    rng = np.random.default_rng(3)
    factor, multipliers = 0.7, rng.normal(size=problem.g.shape[0])

    def slope(at):
        first = factor * np.asarray(problem.gradient(at, [])[1]).ravel()
        return first + np.asarray(problem.jacobian(at, [])[1]).T @ multipliers

    hessian = np.asarray(problem.hessian(x, [], factor, multipliers))
    assert np.array_equal(hessian, np.triu(hessian))
    np.testing.assert_allclose(hessian, np.triu(central(slope, x)), rtol=1e-5, atol=2e-5)


@pytest.mark.parametrize("soft", [False, True])
def test_the_objective_is_the_stated_integral(soft):
    task = task_for()
    x = random_point(task, soft)
    o, size = task.options, N * task.arm.dof
    q, middle = x[:size].reshape(N, -1), task.arm.rom.middle
    expected = objective(task.path.time, q, middle, (o.speed_weight, o.acceleration_weight, o.posture_weight))
    # The constant ½ w_p |middle|² T does not depend on x and is left out of the problem.
    expected -= 0.5 * o.posture_weight * task.path.duration * middle @ middle
    if soft:
        e = x[size:].reshape(N, -1)
        cost = (e[:, :3] ** 2).sum(1) / o.position_sigma**2 + (e[:, 3:] ** 2).sum(1) / o.rotation_sigma**2
        expected += 0.5 * np.sum(np.diff(task.path.time) * (cost[1:] + cost[:-1]) / 2)
    problem = task.problem(soft=soft, rates=False)
    f, _ = evaluators(problem)
    assert f(x) == pytest.approx(problem.scale * expected, rel=1e-12)


@pytest.mark.parametrize("soft", [False, True])
def test_clearance_and_elbow_add_their_trapezoidal_integral_and_nothing_else(soft):
    with_cost, without = task_for(**POSTURE), task_for(prefer=None)
    x = random_point(without, soft)
    q, time = x[: N * ARM.dof].reshape(N, -1), without.path.time
    each = with_cost.posture_cost.evaluate(q)
    expected = np.sum(np.diff(time) * (each[1:] + each[:-1]) / 2)
    assert expected > 1
    values = []
    for task in (with_cost, without):
        problem = task.problem(soft=soft, rates=False)
        values.append(evaluators(problem)[0](x) / problem.scale)
    assert values[0] - values[1] == pytest.approx(expected, rel=1e-9)


def test_a_preferred_posture_takes_the_place_of_mid_range():
    wish = ARM.rom.lower + 0.3 * ARM.rom.width
    task = task_for(prefer=wish)
    x, o = random_point(task, False), task.options
    weights = (o.speed_weight, o.acceleration_weight, o.posture_weight)
    expected = objective(task.path.time, x.reshape(N, -1), wish, weights)
    expected -= 0.5 * o.posture_weight * task.path.duration * wish @ wish
    problem = task.problem(soft=False, rates=False)
    assert evaluators(problem)[0](x) == pytest.approx(problem.scale * expected, rel=1e-12)


@pytest.mark.parametrize("orientation", Orientation)
def test_tracking_equations_vanish_where_the_hand_is_on_the_path_and_only_there(orientation):
    task = task_for(orientation=orientation)
    _, q = smooth_path(ARM, N, 0)
    _, g = evaluators(task.problem(soft=False, rates=False))
    assert np.abs(g(q.ravel())).max() < 1e-14
    turned = q.copy()
    turned[2, 0] += 0.01
    residual = np.abs(g(turned.ravel())).reshape(N, -1).max(axis=1)
    assert residual[2] > 1e-4
    assert residual[[0, 1, 3]].max() < 1e-14


def test_position_equations_are_the_distance_to_the_path():
    task = task_for(orientation=Orientation.NONE)
    x = random_point(task, False)
    _, g = evaluators(task.problem(soft=False, rates=False))
    position, _ = hand_pose(ARM.chain, x.reshape(N, -1), ARM.lengths)
    np.testing.assert_allclose(g(x), (position - task.path.position).ravel(), atol=1e-14)


def test_rate_rows_follow_the_tracking_equations_and_are_speed_then_acceleration():
    task = task_for()
    x = random_point(task, False)
    q, t = x.reshape(N, -1), task.path.time
    _, g = evaluators(task.problem(soft=False, rates=True))
    speed = np.diff(q, axis=0) / np.diff(t)[:, None]
    acceleration = np.diff(speed, axis=0) / (0.5 * (t[2:] - t[:-2]))[:, None]
    rates = g(x)[N * task.orientation.equations :]
    np.testing.assert_allclose(rates, np.concatenate([speed.ravel(), acceleration.ravel()]), rtol=1e-10)


@needs_cc
@pytest.mark.parametrize(("name", "further"), [("human", {}), ("human", POSTURE), ("custom_modified", {})])
def test_compiled_problem_equals_the_virtual_machine(name, further):
    arm = ARMS[name]
    orientation = Orientation.FULL if arm.dof >= 6 else Orientation.POINTING
    c, vm = (task_for(arm, orientation, backend=backend, **further) for backend in ("c", "vm"))
    x = random_point(vm, True)
    for soft, rates in itertools.product((False, True), repeat=2):
        first, second = (task.problem(soft=soft, rates=rates) for task in (c, vm))
        point = x if soft else x[: N * arm.dof]
        multipliers = np.random.default_rng(0).normal(size=first.g.shape[0])
        for mine, other in (
            (first.gradient(point, [])[1], second.gradient(point, [])[1]),
            (first.jacobian(point, [])[0], second.jacobian(point, [])[0]),
            (first.jacobian(point, [])[1], second.jacobian(point, [])[1]),
            (first.hessian(point, [], 1.0, multipliers), second.hessian(point, [], 1.0, multipliers)),
        ):
            np.testing.assert_allclose(np.asarray(mine), np.asarray(other), rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("further", [{}, POSTURE])
def test_curvature_is_block_diagonal_but_for_the_smoothness(further):
    task = task_for(n=12, **further)
    problem = task.problem(soft=False, rates=True)
    rows, columns = problem.hessian.sparsity_out(0).get_triplet()
    apart = np.abs(np.array(rows) // ARM.dof - np.array(columns) // ARM.dof)
    assert apart.max() == 2
    across = np.array(rows)[apart > 0] % ARM.dof == np.array(columns)[apart > 0] % ARM.dof
    assert across.all()


def test_sparse_matrices_arrive_whole_and_without_explicit_zeros():
    dense = np.array([[0.0, 2.0, 0.0], [-1.0, 0.0, 0.5]])
    stored = sp.csr_array((np.array([3.0, 2.0, 0.0]), ([0, 0, 1], [2, 1, 0])), shape=(2, 3))
    assert np.array_equal(np.asarray(to_casadi(sp.csr_array(dense))), dense)
    matrix = to_casadi(stored)
    assert matrix.nnz() == 2
    assert np.array_equal(np.asarray(matrix), [[0, 2, 3], [0, 0, 0]])
    assert to_casadi(sp.csr_array((0, 4))).shape == (0, 4)
