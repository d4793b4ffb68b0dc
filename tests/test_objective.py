"""What a trajectory costs, recomputed: against sums in the plainest way."""

from __future__ import annotations

import numpy as np
import pytest
from compiled_helpers import needs_cc
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_arms import ARMS
from smooth_motions import objective as plain_objective
from smooth_motions import path_of, smooth_angles, uneven_time

import armik_sym as ak
from armik_sym.trajectory.objective import objective
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.posture_cost import posture_cost

EHMCS = ARMS["ehmcs"]
WEIGHTS = ("speed_weight", "acceleration_weight", "posture_weight")


def by_trapezes(time, values):
    return sum((time[k + 1] - time[k]) * (values[k] + values[k + 1]) / 2 for k in range(len(time) - 1))


@given(
    n=st.integers(2, 12),
    seed=st.integers(0, 99),
    weights=st.tuples(*[st.sampled_from([0.0, 1e-3, 0.5, 2.0])] * 3),
)
def test_speed_acceleration_and_distance_summed_sample_by_sample(n, seed, weights):
    time, q = uneven_time(n, seed), smooth_angles(EHMCS, n, seed)
    options = TrajectoryOptions(**dict(zip(WEIGHTS, weights, strict=True)))
    expected = plain_objective(time, q, EHMCS.rom.middle, weights)
    assert objective(EHMCS, time, q, options) == pytest.approx(expected, rel=1e-11, abs=1e-14)


def test_a_preferred_posture_takes_the_place_of_mid_range():
    q, time = smooth_angles(EHMCS, 9, 3), uneven_time(9, 3)
    wish = EHMCS.rom.clip(np.full(7, 0.3))
    options = TrajectoryOptions(prefer=wish, posture_weight=0.7)
    assert objective(EHMCS, time, q, options) == pytest.approx(
        plain_objective(time, q, wish, (1.0, 0.01, 0.7)), rel=1e-12
    )


@settings(max_examples=20)
@given(
    seed=st.integers(0, 99),
    weight=st.sampled_from([0.0, 3.0]),
    prefer=st.sampled_from([None, "elbow_low", "elbow_out"]),
)
def test_clearance_and_elbow_direction_are_integrated_by_trapezes(seed, weight, prefer):
    time = uneven_time(7, seed)
    q = EHMCS.rom.random_postures(np.random.default_rng(seed), 7)
    options = TrajectoryOptions(clearance_weight=weight, clearance=0.5, prefer=prefer)
    extra = posture_cost(EHMCS, options, "vm")
    expected = plain_objective(time, q, EHMCS.rom.middle, (1.0, 0.01, 1e-3))
    if extra is None:
        assert weight == 0
        assert prefer is None
    else:
        expected += by_trapezes(time, [float(extra.evaluate(row[None])[0]) for row in q])
    assert objective(EHMCS, time, q, options, "vm") == pytest.approx(expected, rel=1e-11)


def test_rest_at_the_preferred_posture_costs_nothing():
    q = np.tile(EHMCS.rom.middle, (6, 1))
    assert objective(EHMCS, np.arange(6.0), q, TrajectoryOptions()) == 0.0


@needs_cc
def test_backends_agree():
    q, time = smooth_angles(EHMCS, 30, 1), uneven_time(30, 1)
    options = TrajectoryOptions(clearance_weight=5.0, clearance=0.5, prefer="elbow_low")
    c, vm = (objective(EHMCS, time, q, options, backend) for backend in ("c", "vm"))
    assert c == pytest.approx(vm, rel=1e-12)


@pytest.mark.parametrize(
    "options",
    [
        {"search": "full-space"},
        {"search": "swivel"},
        {"tracking": "soft"},
        {"orientation": "none"},
        {"clearance_weight": 5.0},
    ],
    ids=str,
)
def test_every_solution_of_the_method_carries_its_cost(options):
    path = path_of(EHMCS, smooth_angles(EHMCS, 8, 1))
    solution = ak.solve(EHMCS, path, **options)
    chosen = TrajectoryOptions(**options)
    assert solution.cost == objective(EHMCS, path.time, solution.q, chosen)
    if "clearance_weight" not in options:
        by_hand = plain_objective(path.time, solution.q, EHMCS.rom.middle, (1.0, 0.01, 1e-3))
        assert solution.cost == pytest.approx(by_hand, rel=1e-10)


def test_pointwise_methods_have_no_cost():
    path = path_of(EHMCS, smooth_angles(EHMCS, 4, 1))
    assert ak.solve(EHMCS, path, "lm").cost is None
