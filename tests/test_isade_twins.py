"""ISADE in C and in NumPy: the same generations, and the same distribution."""

from __future__ import annotations

import numpy as np
import pytest
from isade_helpers import (
    ARM,
    NAME,
    NUMPY,
    gentle,
    library,
    targets_of,
)
from sample_arms import ARMS

from armik_sym.pointwise.differential_evolution import (
    IsadeOptions,
    PathJob,
    ProIsadeOptions,
    run_isade,
    run_many,
)
from armik_sym.symbolic import Orientation

CASES = [
    ({}, Orientation.NONE),
    ({"repair": "reflect"}, Orientation.NONE),
    ({"repair": "random", "sign": "original"}, Orientation.FULL),
    ({"repair": "midpoint", "population": 5}, Orientation.NONE),
    ({"rotation_measure": "cosines", "n_iter": 2.0, "tau": 0.5}, Orientation.FULL),
    ({"travel_weight": 0.0, "stall": 50.0}, Orientation.NONE),
]


@pytest.mark.parametrize(("choice", "orientation"), CASES)
@pytest.mark.parametrize("family", [ProIsadeOptions, IsadeOptions])
@pytest.mark.parametrize("with_start", [True, False])
def test_c_and_numpy_agree_generation_by_generation(choice, orientation, family, with_start):
    for name in (NAME, "ehmcs"):
        arm = ARMS[name]
        q = gentle(arm, 2, seed=8)
        targets, start = targets_of(arm, q, orientation), q[0] if with_start else None
        for iter_max in (1, 2, 3, 5):
            options = family(iter_max=iter_max, **choice)
            c, numpy = (
                run_isade(arm, targets, options, start=start, seed=21, library=found)
                for found in (library("compiled", name), NUMPY)
            )
            np.testing.assert_allclose(c.q, numpy.q, rtol=0, atol=1e-12)
            assert np.array_equal(c.iterations, numpy.iterations)
            assert c.evaluations == numpy.evaluations


RUNS = 1_000


def test_c_and_numpy_agree_in_distribution():
    q = gentle(ARM, 2, seed=8)
    q[0] = q[1]
    options = ProIsadeOptions(population=20, stop=3e-3)
    start = q[1] - 0.01  # a thousand different runs of one sample that is a few generations away
    counts = np.array(
        [
            [
                out.iterations[0]
                for out in run_many(
                    ARM,
                    [PathJob(targets_of(ARM, q[:1]), start, seed) for seed in range(offset, offset + RUNS)],
                    options,
                    library=found,
                )
            ]
            for offset, found in ((0, library("compiled", NAME)), (RUNS, NUMPY))
        ]
    )
    spread = counts.std(axis=1).mean()
    assert spread > 0
    assert abs(np.diff(counts.mean(axis=1))[0]) < 4 * spread * np.sqrt(2 / RUNS)
