"""The objective over one curve: against a plain loop, C against NumPy, derivatives against differences."""

from __future__ import annotations

import numpy as np
import pytest
from curve_problems import BACKENDS, WEIGHTS, curves_of, library, unlimited, with_root
from smooth_motions import objective as plain
from smooth_motions import smooth_angles, uneven_time

from armik_sym.trajectory.one_curve.objective import CurveObjective
from armik_sym.trajectory.one_curve.smoothness import Smoothness, smoothness

SIZES = (1, 2, 3, 4, 40)


def mixed(n: int, seed: int, *, only_psi: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows, charts and coordinates of a smooth motion, every kind of coordinate in turn."""
    curves = curves_of(unlimited("human"), smooth_angles(unlimited("human"), max(n, 3), seed)[:n])
    rng = np.random.default_rng(seed)
    chart = np.zeros(n, dtype=np.int32) if only_psi else (np.arange(n) % 3).astype(np.int32)
    rows = with_root(curves.rows, rng.choice([-1.0, 1.0], n))
    x = np.where(chart == 0, curves.psi, np.where(chart == 1, curves.q[:, 0], curves.q[:, 4]))
    return rows, chart, x


def weights(n: int, seed: int) -> tuple[Smoothness, np.ndarray]:
    """Weights of uneven time stamps, scaled down as at high sampling rates; one sample has no rates."""
    aim = np.random.default_rng(seed).normal(size=7)
    if n == 1:
        return Smoothness(np.zeros(0), np.zeros((0, 3)), np.array([0.7]), aim[None]), np.zeros(1)
    time = uneven_time(n, seed, 0.02 * n)
    return smoothness(time, WEIGHTS, aim), time


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("n", [2, 3, 4, 40])
def test_value_is_the_plain_sum_and_the_angles_are_those_of_the_motion(backend, n):
    rows, chart, x = mixed(n, n, only_psi=True)
    smooth, time = weights(n, n)
    value, q = CurveObjective(library(backend), rows, smooth, chart).value(x)
    assert np.abs(q - smooth_angles(unlimited("human"), max(n, 3), n)[:n]).max() <= 1e-9
    expected = plain(time, q, smooth.aim[0], WEIGHTS)
    assert value / smooth.scale == pytest.approx(expected, rel=1e-10)


def test_high_sampling_rates_are_scaled_and_low_ones_are_not():
    assert weights(40, 1)[0].scale < 1
    assert smoothness(np.arange(5.0), WEIGHTS, np.zeros(7)).scale == 1


@pytest.mark.parametrize("n", SIZES)
def test_c_and_numpy_agree_to_rounding(n):
    rows, chart, x = mixed(n, 10 + n)
    smooth, _ = weights(n, n)
    c, vm = (CurveObjective(library(backend), rows, smooth, chart) for backend in BACKENDS)
    assert c.value(x)[0] == pytest.approx(vm.value(x)[0], rel=1e-11)
    assert np.abs(c.value(x)[1] - vm.value(x)[1]).max() <= 1e-13
    a, b = c.derivatives(x), vm.derivatives(x)
    assert a.value == pytest.approx(c.value(x)[0], rel=1e-14)
    assert b.value == pytest.approx(vm.value(x)[0], rel=1e-14)
    for name in ("q", "slope", "curvature", "gradient", "bands"):
        one, other = getattr(a, name), getattr(b, name)
        assert one.shape == other.shape
        assert np.abs(one - other).max() <= 1e-11 * max(1.0, np.abs(other).max()), name
    for i in (1, 2):
        assert not a.bands[i, max(n - i, 0) :].any()


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("n", SIZES)
def test_gradient_and_hessian_against_differences(backend, n):
    rows, chart, x = mixed(n, 20 + n)
    smooth, _ = weights(n, n)
    objective = CurveObjective(library(backend), rows, smooth, chart)
    at, h = objective.derivatives(x), 1e-6
    H = np.diag(at.bands[0])
    for i in range(1, min(3, n)):
        band = at.bands[i, : n - i]
        H += np.diag(band, i) + np.diag(band, -i)
    gradient, hessian = np.empty(n), np.empty((n, n))
    for k in range(n):
        step = h * (np.arange(n) == k)
        left, right = objective.derivatives(x - step), objective.derivatives(x + step)
        gradient[k] = (right.value - left.value) / (2 * h)
        hessian[k] = (right.gradient - left.gradient) / (2 * h)
    assert at.gradient == pytest.approx(gradient, abs=2e-6 * max(1.0, np.abs(gradient).max()))
    assert pytest.approx(hessian, abs=1e-6 * np.abs(H).max()) == H


@pytest.mark.parametrize("backend", BACKENDS)
def test_arrays_of_the_caller_are_neither_kept_nor_changed(backend):
    rows, chart, x = mixed(9, 3)
    objective = CurveObjective(library(backend), rows, weights(9, 3)[0], chart)
    before, value = x.copy(), objective.value(x)[0]
    at = objective.derivatives(x[::1])
    strided = np.repeat(x, 2)[::2]
    assert objective.value(strided)[0] == value
    objective.derivatives(x + 0.1)
    assert np.array_equal(x, before)
    assert at.value == pytest.approx(value, rel=1e-13)
