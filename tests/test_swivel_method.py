"""The whole trajectory over the swivel angle: when it is used, and that it finds what full space finds."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
import spherical_arms
from compiled_helpers import forgotten, needs_cc
from exact_solves import check
from map_solves import DRINKING, EHMCS, MAP_STAGES, over_the_map, same_cost, stages_of, thin
from reference_cost import full_space_from
from sample_arms import ARMS
from smooth_motions import objective as plain_objective
from smooth_motions import path_of, smooth_angles, smooth_path, uneven_time

import armik_sym as ak
from armik_sym.arm import Arm, DHChain
from armik_sym.errors import CompilerWarning, OptionError
from armik_sym.swivel.library import swivel_library
from armik_sym.trajectory.library import trajectory_library

SPHERICAL = spherical_arms.ARMS


# --- when it is used -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sorted(SPHERICAL))
def test_it_is_the_default_for_every_arm_with_spherical_shoulder_and_wrist(name):
    path, _ = smooth_path(SPHERICAL[name], 12, seed=0)
    assert stages_of(SPHERICAL[name], path)[0] == MAP_STAGES


def test_the_chain_decides_and_not_the_name():
    path, _ = smooth_path(EHMCS, 8, seed=1)
    named = replace(EHMCS, name="somebody", description="")
    assert stages_of(named, path)[0] == MAP_STAGES
    fixed = EHMCS.chain
    links = tuple(replace(link, a=0.02) if link.name == "forearm_pronation" else link for link in fixed.links)
    crooked = Arm("ehmcs", DHChain(links, fixed.convention, fixed.base, fixed.tool), EHMCS.rom, EHMCS.lengths)
    path, _ = smooth_path(crooked, 8, seed=1)
    stages, solution = stages_of(crooked, path)
    assert not set(stages) & set(MAP_STAGES)
    check(solution)


@pytest.mark.parametrize(
    ("arm", "options", "reason"),
    [
        (EHMCS, {"orientation": "pointing"}, "needs full poses, but orientation is 'pointing'"),
        (EHMCS, {"orientation": "none"}, "needs full poses, but orientation is 'none'"),
        (EHMCS, {"tracking": "soft"}, 'knows only exact tracking, but tracking is "soft"'),
        (ARMS["ehmcs_5dof"], {"orientation": "none"}, "needs full poses"),
        (ARMS["ehmcs_5dof"], {"tracking": "soft"}, "exact tracking"),
    ],
)
def test_what_does_not_fit_goes_to_full_space_and_insisting_names_the_reason(arm, options, reason):
    path, _ = smooth_path(arm, 8, seed=1)
    stages, _ = stages_of(arm, path, **options)
    assert not set(stages) & set(MAP_STAGES)
    with pytest.raises(OptionError, match=rf'search="swivel" does not fit: .*{reason}.*"full-space"'):
        ak.solve(arm, path, search="swivel", **options)
    with pytest.raises(OptionError, match=rf"n_best=2 needs the swivel map.*{reason}"):
        ak.solve(arm, path, n_best=2, **options)


def test_full_space_on_request_and_no_alternatives_there():
    stages, _ = stages_of(EHMCS, DRINKING, search="full-space")
    assert stages == ["first guess", "exact tracking"]
    with pytest.raises(OptionError, match=r'n_best=3 needs the swivel map.*search is "full-space"'):
        ak.solve(EHMCS, DRINKING, search="full-space", n_best=3)
    assert stages_of(EHMCS, DRINKING, search="swivel")[0] == MAP_STAGES


# --- the same optimum as full space ----------------------------------------------------------------


@pytest.mark.parametrize("name", ak.task_names())
def test_bundled_tasks_cost_what_they_cost_in_full_space(name):
    same_cost(EHMCS, thin(ak.load_task(name).path))


@pytest.mark.parametrize(
    "options",
    [
        {"clearance_weight": 10.0, "clearance": 0.6},
        {"prefer": "elbow_low"},
        {"prefer": "elbow_out", "prefer_weight": 50.0, "clearance_weight": 5.0},
        {"prefer": [0, 0, 0, 1, 0, 0, 0], "posture_weight": 0.5},
        {"speed_weight": 0.0},
        {"acceleration_weight": 0.0},
        {"posture_weight": 0.0},
        {"speed_weight": 0.0, "acceleration_weight": 0.0, "posture_weight": 1.0},
        {"speed_weight": 0.0, "acceleration_weight": 1.0, "posture_weight": 0.0},
    ],
    ids=lambda options: ",".join(f"{name}={value}" for name, value in options.items()),
)
def test_weights_and_wishes_cost_what_they_cost_in_full_space(options):
    mine, _ = same_cost(EHMCS, DRINKING, **options)
    plain = ak.solve(EHMCS, DRINKING)
    assert np.abs(mine.q - plain.q).max() > 1e-3  # the wish is felt


@pytest.mark.parametrize("name", sorted(SPHERICAL))
@pytest.mark.parametrize("seed", [0, 1])
def test_no_arm_costs_more_than_full_space_started_at_the_generating_motion(name, seed):
    arm = SPHERICAL[name]
    path, q = smooth_path(arm, 25, seed)
    mine = over_the_map(arm, path)
    other = full_space_from(arm, path, q)
    assert other.converged
    assert mine.cost <= (1 + 1e-6) * other.cost


def test_uneven_time_stamps():
    q = smooth_angles(EHMCS, 30, seed=1)
    same_cost(EHMCS, path_of(EHMCS, q, uneven_time(30, 0)))


@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_very_short_paths(n):
    same_cost(EHMCS, path_of(EHMCS, smooth_angles(EHMCS, n, seed=3, most=0.2)))


@pytest.mark.parametrize("n", [2, 12])
def test_a_hand_at_rest_leaves_the_arm_at_rest(n):
    q = smooth_angles(EHMCS, 30, seed=1)[:1]
    mine, _ = same_cost(EHMCS, path_of(EHMCS, np.repeat(q, n, axis=0)))
    assert mine.max_step.max() < 1e-6


def test_a_hand_that_pauses():
    q = smooth_angles(EHMCS, 30, seed=1)
    same_cost(EHMCS, path_of(EHMCS, np.concatenate([q[:10], np.repeat(q[10:11], 5, axis=0), q[10:25]])))


@pytest.mark.parametrize("kind", ["max_speed", "max_acceleration"])
@pytest.mark.parametrize(("joint", "share"), [(0, 0.5), (1, 0.8), (2, 0.5), (4, 0.5)])
def test_rate_limits_of_joints_bind_hold_exactly_and_cost_what_they_cost_in_full_space(kind, joint, share):
    free = ak.solve(EHMCS, DRINKING)
    limits = np.full(7, np.inf)
    limits[joint] = share * getattr(free, kind)[joint]
    mine, _ = same_cost(EHMCS, DRINKING, **{kind: limits})
    assert mine.cost > free.cost * (1 + 1e-8)
    assert 0.999 * limits[joint] < getattr(mine, kind)[joint] <= limits[joint]


def test_both_rate_limits_at_once():
    free = ak.solve(EHMCS, DRINKING)
    speed, acceleration = np.full(7, np.inf), np.full(7, np.inf)
    speed[1], acceleration[0] = 0.6 * free.max_speed[1], 0.7 * free.max_acceleration[0]
    mine, _ = same_cost(EHMCS, DRINKING, max_speed=speed, max_acceleration=acceleration)
    assert 0.999 * speed[1] < mine.max_speed[1] <= speed[1]
    assert 0.999 * acceleration[0] < mine.max_acceleration[0] <= acceleration[0]


# --- what the answer says ---------------------------------------------------------------------------


def test_cost_is_the_objective_computed_in_the_plainest_way():
    for options in ({}, {"speed_weight": 2.0, "acceleration_weight": 0.1, "posture_weight": 0.2}):
        solution = ak.solve(EHMCS, DRINKING, **options)
        weights = tuple(solution.settings[f"{name}_weight"] for name in ("speed", "acceleration", "posture"))
        by_hand = plain_objective(solution.time, solution.q, EHMCS.rom.middle, weights)
        assert solution.cost == pytest.approx(by_hand, rel=1e-10)


def test_two_calls_give_the_same_bits():
    first, second = (ak.solve(EHMCS, DRINKING, n_best=3) for _ in range(2))
    assert np.array_equal(first.q, second.q)
    assert first.cost == second.cost
    assert len(first.alternatives) == len(second.alternatives)
    for one, other in zip(first.alternatives, second.alternatives, strict=True):
        assert np.array_equal(one.q, other.q)


def test_the_seed_changes_nothing():
    first, second = (ak.solve(EHMCS, DRINKING, seed=seed) for seed in (0, 7))
    assert np.array_equal(first.q, second.q)


@needs_cc
@pytest.mark.parametrize("options", [{}, {"clearance_weight": 10.0, "prefer": "elbow_out"}, {"n_best": 3}])
@pytest.mark.parametrize("name", ["ehmcs", "alfaiz"])
def test_virtual_machine_and_compiled_code_agree(name, options):
    arm = SPHERICAL[name]
    if name == "alfaiz" and "prefer" in options:
        options = {"clearance_weight": 10.0}
    path, _ = smooth_path(arm, 20, seed=1)
    c, vm = (check(ak.solve(arm, path, backend=backend, **options)) for backend in ("c", "vm"))
    assert np.abs(c.q - vm.q).max() < 1e-9
    assert c.cost == pytest.approx(vm.cost, rel=1e-12)
    assert len(c.alternatives) == len(vm.alternatives)
    for one, other in zip(c.alternatives, vm.alternatives, strict=True):
        assert np.abs(one.q - other.q).max() < 1e-9


def test_without_any_compiler_it_works_with_one_warning(monkeypatch, tmp_path):
    expected = ak.solve(EHMCS, DRINKING).q
    monkeypatch.setenv("CC", "/no/such/compiler")
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path / "cache"))
    libraries = (swivel_library, trajectory_library)
    with forgotten(), warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        for library in libraries:
            library.cache_clear()
        solution = check(ak.solve(EHMCS, DRINKING))
        assert swivel_library() is None
        assert trajectory_library() is None
        for library in libraries:
            library.cache_clear()
    assert [one.category for one in told if issubclass(one.category, CompilerWarning)] == [CompilerWarning]
    assert np.abs(solution.q - expected).max() < 1e-9
