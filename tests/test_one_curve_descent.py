"""Newton steps inside bounds: down, never out of them, to a point where nothing leads further down."""

from __future__ import annotations

import numpy as np
import pytest
from curve_problems import BACKENDS, curves_of, library, unlimited
from hypothesis import given, settings
from hypothesis import strategies as st
from smooth_motions import smooth_angles
from test_one_curve_objective import mixed, weights

from armik_sym.trajectory.one_curve.descent import descend
from armik_sym.trajectory.one_curve.objective import CurveObjective


def start(
    n: int, seed: int, width: float, backend: str
) -> tuple[CurveObjective, np.ndarray, np.ndarray, np.ndarray]:
    """An objective over ψ, a rough start and bounds around it; a few coordinates are held."""
    rng = np.random.default_rng(seed)
    curves = curves_of(unlimited("ehmcs"), 0.5 * smooth_angles(unlimited("ehmcs"), max(n, 3), seed)[:n])
    x = curves.psi + 0.1 * rng.normal(size=n)
    lower, upper = x - width * rng.uniform(0, 1, n), x + width * rng.uniform(0, 1, n)
    held = rng.random(n) < 0.1
    lower, upper = np.where(held, x, lower), np.where(held, x, upper)
    return CurveObjective(library(backend), curves.rows, weights(n, seed)[0]), x, lower, upper


def left_over(objective: CurveObjective, x: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> float:
    """Largest entry of the gradient that does not push out of the bounds, relative to the curvature."""
    at = objective.derivatives(x)
    out = ((x <= lower) & (at.gradient > 0)) | ((x >= upper) & (at.gradient < 0))
    return float(np.abs(np.where(out, 0, at.gradient)).max() / np.abs(at.bands[0]).max())


@pytest.mark.parametrize("n", [1, 2, 3, 60])
@pytest.mark.parametrize("width", [0.05, 0.5, np.inf])
def test_c_and_numpy_take_the_same_steps(n, width):
    ends = []
    for backend in BACKENDS:
        objective, x, lower, upper = start(n, n, 1.0, backend)
        lower, upper = (lower, upper) if np.isfinite(width) else (lower - np.inf, upper + np.inf)
        ends.append([descend(objective, x, lower, upper, iterations=k) for k in (1, 2, 5, 50)])
    for one, other in zip(*ends, strict=True):
        assert one.iterations == other.iterations
        assert one.value == pytest.approx(other.value, rel=1e-9, abs=1e-12)
        assert np.abs(one.psi - other.psi).max() <= 1e-6


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("seed", range(6))
def test_ends_where_nothing_leads_further_down(backend, seed):
    objective, x, lower, upper = start(60, seed, 0.2, backend)
    down = descend(objective, x, lower, upper, iterations=200, enough=1e-14)
    assert down.iterations < 200
    assert np.all((down.psi >= lower) & (down.psi <= upper))
    assert left_over(objective, down.psi, lower, upper) <= 1e-6
    assert down.value == pytest.approx(objective.value(down.psi)[0], rel=1e-12)
    held = lower == upper
    assert held.any()
    assert np.array_equal(down.psi[held], x[held])


@settings(max_examples=25)
@given(
    seed=st.integers(0, 10_000),
    width=st.floats(0, 3),
    n=st.integers(1, 25),
    backend=st.sampled_from(BACKENDS),
)
def test_never_leaves_the_bounds_and_never_goes_up(seed, width, n, backend):
    """Rough starts: the Hessian is often indefinite, and steps run into bounds."""
    objective, x, lower, upper = start(n, seed, width, backend)
    x = x + np.random.default_rng(seed).normal(size=n)  # outside of the bounds as well
    value = objective.value(np.clip(x, lower, upper))[0]
    for iterations in (1, 2, 4, 30):
        down = descend(objective, x, lower, upper, iterations=iterations)
        assert np.all((down.psi >= lower) & (down.psi <= upper))
        assert down.value <= value * (1 + 1e-12)
        assert 1 <= down.iterations <= iterations
        value = down.value


@pytest.mark.parametrize("backend", BACKENDS)
def test_goes_down_from_where_the_hessian_is_indefinite(backend):
    found = 0
    for seed in range(20):
        objective, x, lower, upper = start(20, seed, 3.0, backend)
        x = np.clip(x + np.random.default_rng(seed).normal(size=20), lower, upper)
        bands = objective.derivatives(x).bands
        H = np.diag(bands[0])
        for i in (1, 2):
            H += np.diag(bands[i, :-i], i) + np.diag(bands[i, :-i], -i)
        if np.linalg.eigvalsh(H)[0] > 0:
            continue
        found += 1
        down = descend(objective, x, lower, upper, iterations=300, enough=1e-13)
        assert down.value < objective.value(x)[0]
        assert left_over(objective, down.psi, lower, upper) <= 1e-5
    assert found > 5


@pytest.mark.parametrize("backend", BACKENDS)
def test_coordinates_of_all_kinds_at_once(backend):
    rows, chart, x = mixed(30, 4)
    objective = CurveObjective(library(backend), rows, weights(30, 4)[0], chart)
    lower, upper = x - 0.02, x + 0.02
    down = descend(objective, x, lower, upper, iterations=100, enough=1e-13)
    assert down.value < objective.value(x)[0]
    assert np.all((down.psi >= lower) & (down.psi <= upper))


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("what", ["rows", "x"])
def test_what_is_not_a_number_ends_it_at_once(backend, what):
    objective, x, lower, upper = start(12, 1, 0.5, backend)
    if what == "rows":
        rows = objective._parameters.copy()
        rows[5, 3] = np.nan
        objective = CurveObjective(library(backend), rows, objective.smoothness)
    else:
        x[4] = np.nan
    down = descend(objective, x, lower, upper, iterations=10**6)
    assert down.iterations == 1
    assert np.isnan(down.value)


@pytest.mark.parametrize("backend", BACKENDS)
def test_no_steps_leave_everything_as_it_is(backend):
    objective, x, lower, upper = start(12, 2, 0.5, backend)
    down = descend(objective, x, lower, upper, iterations=0)
    assert down.iterations == 0
    assert np.array_equal(down.psi, x)
    assert down.value == pytest.approx(objective.value(x)[0], rel=1e-14)
