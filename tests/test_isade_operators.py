"""Partners, scale factors and options of ISADE."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from isade_helpers import (
    ARM,
    NAME,
    gentle,
    library,
    targets_of,
)

from armik_sym.errors import OptionError
from armik_sym.pointwise.differential_evolution import (
    IsadeOptions,
    ProIsadeOptions,
    run_isade,
)
from armik_sym.pointwise.differential_evolution.compiled_search import isade_settings
from armik_sym.pointwise.differential_evolution.generation import (
    factors_by_rank,
    mean_factor,
    partners,
    scale_factors,
)
from armik_sym.pointwise.random_stream import random_bits


@given(population=st.integers(5, 60), key=st.integers(0, 2**64 - 1))
def test_partners_differ_from_each_other_and_from_the_individual(population, key):
    words = random_bits(key, np.arange(2 * population)).reshape(population, 2)
    rows = np.column_stack([np.arange(population), partners(words, population)])
    assert rows.min() >= 0
    assert rows.max() < population
    assert all(len(set(row)) == 5 for row in rows.tolist())


def test_partners_are_drawn_evenly():
    n, repeats = 6, 4000
    count = np.zeros((4, n))
    for k in range(repeats):
        rows = partners(random_bits(k, np.arange(2 * n)).reshape(n, 2), n)
        for j in range(4):
            count[j, rows[2, j]] += 1
    assert (count[:, 2] == 0).all()
    others = np.delete(count, 2, axis=1)
    assert np.abs(others - repeats / 5).max() < 5 * np.sqrt(repeats / 5)


def test_scale_factors_as_printed_and_as_asked_for():
    by_rank = factors_by_rank(50, 4.0)
    assert np.all(np.diff(by_rank) < 0)
    assert by_rank[24] == pytest.approx(0.5)
    cost = np.arange(50.0)[::-1]
    printed, original = ProIsadeOptions(), ProIsadeOptions(sign="original")
    assert mean_factor(printed, 150) == printed.f_min
    assert mean_factor(printed, 75) == pytest.approx(0.45)
    for iteration, grows in ((1, 150), (40, 90)):
        early, late = (scale_factors(printed, cost, by_rank, t) for t in (iteration, grows))
        assert np.all(late > early)
        early, late = (scale_factors(original, cost, by_rank, t) for t in (iteration, grows))
        assert np.all(late < early)
        assert np.all(late > 0)
    best = scale_factors(printed, cost, by_rank, 10)
    assert np.argmax(best) == 49
    equal = scale_factors(printed, np.ones(50), by_rank, 10)
    assert np.ptp(equal) == 0


def test_the_sign_of_eq_14_decides_how_long_it_takes():
    q = gentle(ARM, 12)
    printed, original = (
        run_isade(
            ARM,
            targets_of(ARM, q),
            ProIsadeOptions(sign=sign, iter_max=400),
            start=q[0],
            library=library("compiled", NAME),
        ).iterations[1:]
        for sign in ("printed", "original")
    )
    assert 1.5 * np.mean(printed) < np.mean(original)


@pytest.mark.parametrize(
    ("choice", "words"),
    [
        ({"population": 4}, "population is 4, expected a whole number ≥ 5"),
        ({"population": 50.0}, "population"),
        ({"population": 10**7}, "population"),
        ({"iter_max": 0}, "iter_max"),
        ({"iter_max": 10**9}, "iter_max"),
        ({"iter_max": 10**5}, "iter_max is 100000 with population 150: expected population · iter_max"),
        ({"iter_max": 100, "population": 10**4}, "iter_max is 100 with population 10000"),
        ({"stop": 0.0}, "stop"),
        ({"stop": float("nan")}, "stop"),
        ({"tau": 1.5}, "tau"),
        ({"tau": True}, "tau"),
        ({"f_min": 0.9, "f_max": 0.1}, "f_min"),
        ({"alpha": float("inf")}, "alpha"),
        ({"travel_weight": -1.0}, "travel_weight is -1.0, expected a finite number ≥ 0"),
        ({"window": 0.0}, "window"),
        ({"window": float("inf")}, "window"),
        ({"repair": "wrap"}, "repair is 'wrap': valid are clip, reflect, random, midpoint"),
        ({"sign": "minus"}, "sign"),
        ({"rotation_measure": "quaternion"}, "rotation_measure"),
        ({"position_tolerance": -1.0}, "position_tolerance"),
    ],
)
def test_options_that_make_no_sense_are_refused(choice, words):
    with pytest.raises(OptionError, match=words):
        ProIsadeOptions(**choice)


def test_defaults_are_those_of_table_5():
    options = ProIsadeOptions()
    assert (options.iter_max, options.stop, options.tau) == (150, 1e-8, 0.1)
    assert options.window == pytest.approx(np.pi / 100)
    assert np.isinf(isade_settings(IsadeOptions(), "position").window)
    assert options.position_tolerance >= options.stop
