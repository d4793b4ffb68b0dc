"""Running IPOPT: the right optimum, bounds held exactly, every ending reported as what it is."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from compiled_helpers import needs_cc
from sample_arms import ARMS
from smooth_motions import smooth_path

from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.full_space import FullSpaceProblem
from armik_sym.trajectory.ipopt import Bounds, run_ipopt
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.task import Task


def problem(f, g):
    """A small problem in two variables, in the form the trajectory problems have."""
    x, p = ca.MX.sym("x", 2), ca.MX.sym("p", 0)
    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g(x).shape[0])
    fx, gx = f(x), g(x)
    H, _ = ca.hessian(lam_f * fx + ca.dot(lam_g, gx), x)
    return FullSpaceProblem(
        x=x,
        f=fx,
        g=gx,
        gradient=ca.Function("grad_f", [x, p], [fx, ca.densify(ca.gradient(fx, x))]),
        jacobian=ca.Function("jac_g", [x, p], [gx, ca.jacobian(gx, x)]),
        hessian=ca.Function("hess_lag", [x, p, lam_f, lam_g], [ca.triu(H)]),
    )


def circle(radius=1.0, pull=1.0):
    """Farthest right and up on a circle; `pull` is how strongly it is drawn to the right."""
    return problem(lambda x: -pull * x[0] - x[1], lambda x: x[0] ** 2 + x[1] ** 2 - radius**2)


def box(lower, upper):
    return Bounds(np.array(lower), np.array(upper), np.zeros(1), np.zeros(1))


def test_optimum_of_a_known_problem():
    result = run_ipopt(circle(), box([-5.0, -5.0], [5.0, 5.0]), np.array([1.0, 0.2]), max_iterations=100)
    assert result.converged
    assert result.status == "Solve_Succeeded"
    assert result.x == pytest.approx([np.sqrt(0.5)] * 2, abs=1e-7)
    assert result.objective == pytest.approx(-np.sqrt(2), abs=1e-7)
    assert abs(result.x @ result.x - 1) <= 1e-10
    assert result.iterations > 0


def test_a_bound_that_binds_is_not_overstepped_by_a_single_bit():
    limit = 0.3
    bounds = box([-5.0, -5.0], [limit, 5.0])
    result = run_ipopt(circle(pull=1e4), bounds, np.array([0.1, 0.2]), max_iterations=100)
    assert result.converged
    assert limit - 1e-9 < result.x[0] <= limit
    # Were the bound relaxed in the solve and honoured afterwards, the equation would pay for it.
    assert abs(result.x @ result.x - 1) <= 1e-10


def test_a_variable_without_room_stays_where_it_is():
    result = run_ipopt(circle(), box([0.6, -5.0], [0.6, 5.0]), np.array([0.6, 0.2]), max_iterations=100)
    assert result.converged
    assert result.x[0] == 0.6
    assert result.x[1] == pytest.approx(0.8)


def test_an_impossible_problem_is_reported_not_raised():
    result = run_ipopt(circle(3.0), box([-1.0, -1.0], [1.0, 1.0]), np.array([0.5, 0.2]), max_iterations=200)
    assert not result.converged
    assert result.status == "Infeasible_Problem_Detected"


def test_the_iteration_limit_is_kept_and_reported():
    result = run_ipopt(circle(), box([-5.0, -5.0], [5.0, 5.0]), np.array([1.0, 0.2]), max_iterations=2)
    assert not result.converged
    assert result.status == "Maximum_Iterations_Exceeded"
    assert result.iterations == 2


def test_every_iteration_is_reported_with_its_violation():
    seen = []
    start = np.array([2.0, 0.0])
    result = run_ipopt(
        circle(),
        box([-5.0, -5.0], [5.0, 5.0]),
        start,
        max_iterations=100,
        report=lambda *report: seen.append(report),
    )
    assert [iteration for iteration, _ in seen] == list(range(result.iterations + 1))
    assert seen[0][1] == pytest.approx(3.0)
    assert seen[-1][1] <= 1e-10


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit])
def test_an_exception_while_reporting_comes_out(error):
    def stop(iteration, violation):
        if iteration == 3:
            raise error("stop here")

    bounds = box([-5.0, -5.0], [5.0, 5.0])
    with pytest.raises(error, match="stop here"):
        run_ipopt(circle(), bounds, np.array([1.0, 0.2]), max_iterations=100, report=stop)


@pytest.mark.parametrize("output", [False, True])
def test_it_prints_only_on_demand(capfd, output):
    bounds = box([-5.0, -5.0], [5.0, 5.0])
    run_ipopt(circle(), bounds, np.array([1.0, 0.2]), max_iterations=100, output=output)
    out, err = capfd.readouterr()
    assert err == ""
    assert ("EXIT: Optimal Solution Found." in out) == output
    assert bool(out) == output


@needs_cc
def test_exact_derivatives_bring_quadratic_convergence():
    arm = ARMS["human"]
    path, q = smooth_path(arm, 8, seed=1)
    none = np.full(arm.dof, np.inf)
    stage = compile_stage(arm, Orientation.FULL, "c")
    task = Task(arm, path, Orientation.FULL, TrajectoryOptions(), none, none, None, stage)
    kinds = {"soft": False, "rates": False}
    start = task.start_vector(arm.rom.clip(q + 0.01), soft=False)
    result = run_ipopt(task.problem(**kinds), task.bounds(**kinds), start, max_iterations=30)
    assert result.converged
    assert result.iterations < 15
