"""The problem as IPOPT sees it: exact derivatives, also to IPOPT's checker; errors come out as they were."""

from __future__ import annotations

import gc
import weakref

import casadi as ca
import numpy as np
import pytest
import scipy.sparse as sp
from curve_problems import BACKENDS, library
from test_one_curve_objective import mixed, weights

from armik_sym.trajectory.ipopt import Bounds, run_ipopt
from armik_sym.trajectory.one_curve.objective import CurveObjective
from armik_sym.trajectory.one_curve.problem import OneCurveProblem
from armik_sym.trajectory.rates import acceleration_matrix, speed_matrix


def instance(
    n: int, limited: bool, backend: str = "c"
) -> tuple[OneCurveProblem, CurveObjective, sp.csr_array, np.ndarray]:
    """A problem with all kinds of coordinates; rows of speed and acceleration if limited."""
    rows, chart, x = mixed(n, 30 + n)
    smooth, time = weights(n, n)
    objective = CurveObjective(library(backend), rows, smooth, chart)
    A = sp.csr_array((0, n))
    if limited:
        A = sp.csr_array(sp.vstack([speed_matrix(time), acceleration_matrix(time), sp.eye_array(n)]))
    return OneCurveProblem(objective, A), objective, A, x


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("limited", [False, True])
@pytest.mark.parametrize("n", [2, 3, 12])
def test_all_functions_against_the_objective_and_differences(n, limited, backend):
    problem, objective, A, x = instance(n, limited, backend)
    f, g = ca.Function("fg", [problem.x], [problem.f, problem.g])(x)
    value, q = objective.value(x)
    assert float(f) == value
    expected = (A @ q).ravel()
    assert np.abs(np.asarray(g).ravel() - expected).max(initial=0) <= 1e-12 * (
        1 + np.abs(expected).max(initial=0)
    )

    def constraints(at: np.ndarray) -> np.ndarray:
        return (A @ objective.value(at)[1]).ravel()

    lam_g = np.random.default_rng(n).normal(size=len(expected)) * 1e-3
    lam_f = 0.7

    def lagrangian_gradient(at: np.ndarray) -> np.ndarray:
        slope = np.asarray(problem.gradient(at, [])[1]).ravel()
        jacobian = np.asarray(ca.DM(problem.jacobian(at, [])[1]))
        return lam_f * slope + (jacobian.T @ lam_g if limited else 0.0)

    h = 1e-6
    steps = [h * (np.arange(n) == k) for k in range(n)]
    gradient = np.array([(objective.value(x + s)[0] - objective.value(x - s)[0]) / (2 * h) for s in steps])
    jacobian = np.array([(constraints(x + s) - constraints(x - s)) / (2 * h) for s in steps]).T
    hessian = np.array([(lagrangian_gradient(x + s) - lagrangian_gradient(x - s)) / (2 * h) for s in steps])
    found = problem.gradient(x, [])
    assert float(found[0]) == pytest.approx(value, rel=1e-13)
    assert np.asarray(found[1]).ravel() == pytest.approx(gradient, abs=2e-6 * np.abs(gradient).max())
    g_again, J = problem.jacobian(x, [])
    assert J.shape == (len(expected), n)
    assert np.abs(np.asarray(g_again).ravel() - expected).max(initial=0) <= 1e-9
    if limited:
        assert np.asarray(J) == pytest.approx(jacobian, abs=1e-6 * np.abs(jacobian).max())
        assert J.nnz() == 7 * A.nnz
    H = problem.hessian(x, [], lam_f, lam_g)
    assert not ca.DM(H).sparsity().is_dense() or n <= 2
    full = np.asarray(H) + np.triu(np.asarray(H), 1).T
    assert full == pytest.approx(hessian, abs=1e-5 * np.abs(full).max())


@pytest.mark.parametrize("limited", [False, True])
def test_ipopts_derivative_checker_finds_nothing(limited, capfd):
    problem, _, A, x = instance(8, limited)
    m = 7 * A.shape[0]
    run_ipopt(
        problem,
        Bounds(x - 0.05, x + 0.05, np.full(m, -np.inf), np.full(m, np.inf)),
        x,
        max_iterations=1,
        output=True,
        settings={
            "derivative_test": "second-order",
            "point_perturbation_radius": 0.01,
            "derivative_test_perturbation": 1e-7,
            "derivative_test_tol": 1e-3,
        },
    )
    problem.raise_error()
    printed = capfd.readouterr().out
    assert "No errors detected by derivative checker" in printed


def test_nothing_is_printed_and_the_result_is_the_optimum(capfd):
    problem, objective, _, x = instance(12, False)
    bounds = Bounds(x - 0.05, x + 0.05, np.zeros(0), np.zeros(0))
    result = run_ipopt(problem, bounds, x, max_iterations=100)
    assert result.converged
    gradient = objective.derivatives(result.x).gradient
    free = (result.x > bounds.lbx + 1e-7) & (result.x < bounds.ubx - 1e-7)
    assert np.abs(gradient[free]).max(initial=0) <= 1e-5
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, ValueError])
@pytest.mark.parametrize("name", ["_evaluate", "_evaluate_gradient", "_evaluate_hessian"])
@pytest.mark.parametrize("call", [1, 2])
def test_an_error_inside_a_callback_stops_ipopt_and_comes_out_as_it_was(
    error, name, call, monkeypatch, capfd
):
    calls = []
    right = getattr(OneCurveProblem, name)

    def wrong(self, inputs, outputs):
        calls.append(name)
        if len(calls) == call:
            raise error("boom")
        right(self, inputs, outputs)

    monkeypatch.setattr(OneCurveProblem, name, wrong)
    problem, _, _, x = instance(12, False)
    bounds = Bounds(x - 0.3, x + 0.3, np.zeros(0), np.zeros(0))
    run_ipopt(problem, bounds, x, max_iterations=100)
    assert len(calls) == call  # nothing is evaluated any more
    with pytest.raises(error, match="boom"):
        problem.raise_error()
    assert capfd.readouterr() == ("", "")


def test_a_problem_is_given_back_when_nobody_needs_it():
    problem, _, _, x = instance(12, True)
    m = len(np.asarray(problem.jacobian(x, [])[0]).ravel())
    run_ipopt(
        problem, Bounds(x - 0.05, x + 0.05, np.full(m, -np.inf), np.full(m, np.inf)), x, max_iterations=5
    )
    watched = weakref.ref(problem)
    del problem
    gc.collect()
    assert watched() is None
