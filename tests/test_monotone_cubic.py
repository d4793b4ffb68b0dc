"""Cubics that never overshoot, against SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from armik_sym.trajectory.global_path.monotone_cubic import monotone_cubic


@given(st.integers(0, 10_000), st.integers(2, 30), st.sampled_from([0.0, 0.3, 1.0]))
def test_it_is_scipys(seed, m, flat):
    rng = np.random.default_rng(seed)
    x = np.cumsum(rng.uniform(0.01, 2.0, m))
    y = np.cumsum(rng.normal(size=m) * (rng.random(m) >= flat))
    at = np.sort(np.concatenate([x, rng.uniform(x[0], x[-1], 50)]))
    expected = PchipInterpolator(x, y)(at)
    assert monotone_cubic(x, y, at) == pytest.approx(expected, abs=1e-11 * max(1.0, np.abs(y).max()))


@given(st.integers(0, 10_000))
def test_it_stays_between_neighbours_and_meets_the_known_values(seed):
    rng = np.random.default_rng(seed)
    x, y = np.cumsum(rng.uniform(0.1, 1.0, 8)), rng.normal(size=8)
    assert monotone_cubic(x, y, x) == pytest.approx(y, abs=1e-13)
    for k in range(7):
        values = monotone_cubic(x, y, np.linspace(x[k], x[k + 1], 20))
        assert values.min() >= min(y[k], y[k + 1]) - 1e-12
        assert values.max() <= max(y[k], y[k + 1]) + 1e-12
