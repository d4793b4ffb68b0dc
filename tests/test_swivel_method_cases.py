"""The swivel method where it is difficult: blocked samples, several answers, odd ranges, singular places."""

from __future__ import annotations

import re

import numpy as np
import pytest
import spherical_arms
from exact_solves import check
from map_solves import DRINKING, EHMCS, over_the_map, thin
from random_trajectories import trajectory
from reference_cost import full_space_from
from smooth_motions import objective as plain_objective
from smooth_motions import path_of, smooth_angles, smooth_path

import armik_sym as ak
from armik_sym.errors import UnreachablePathError
from armik_sym.swivel.map import swivel_map
from armik_sym.trajectory.options import TrajectoryOptions

SPHERICAL = spherical_arms.ARMS


# --- samples without a posture ----------------------------------------------------------------------


def stiff(joint, upper_deg):
    upper = EHMCS.rom.upper.copy()
    upper[EHMCS.joint_index(joint)] = np.deg2rad(upper_deg)
    return EHMCS.with_rom(EHMCS.rom.lower, upper)


def test_blocked_samples_name_samples_joint_and_degrees_and_the_attributes_fit():
    arm = stiff("elbow_flexion", 100)
    with pytest.raises(UnreachablePathError) as caught:
        ak.solve(arm, DRINKING)
    error, map_ = caught.value, swivel_map(arm, DRINKING)
    assert np.array_equal(error.samples, map_.blocked)
    first, last = int(error.samples[0]), int(error.samples[-1])
    needed = swivel_map(EHMCS, DRINKING).intervals.curves[0].elbow  # the elbow does not depend on ψ
    wanted = np.flatnonzero(needed > np.deg2rad(100))
    assert np.array_equal(error.samples, wanted)
    text = str(error)
    assert f"{len(wanted)} of {len(DRINKING)} samples cannot be reached by arm 'ehmcs'" in text
    assert f"samples {first} to {last} " in text
    told = re.search(r"elbow flexion limit \(100°\) missed by ([\d.]+)° at the worst \(sample (\d+)\)", text)
    assert told is not None
    assert float(told[1]) == pytest.approx(np.rad2deg(needed.max()) - 100, rel=5e-3)
    assert int(told[2]) == needed.argmax()
    assert error.samples.shape == error.shortfall.shape == error.turn.shape == (len(wanted),)
    assert np.all(np.isfinite(error.shortfall))
    assert np.all(error.shortfall + error.turn > 0)


@pytest.mark.parametrize(
    ("joint", "upper_deg"), [("elbow_flexion", 100), ("elbow_flexion", 60), ("forearm_pronation", -100)]
)
def test_widening_the_joint_that_blocks_by_what_is_missing_frees_the_path(joint, upper_deg):
    arm = stiff(joint, upper_deg)
    map_ = swivel_map(arm, DRINKING)
    why = map_.why_blocked()
    with pytest.raises(UnreachablePathError):
        ak.solve(arm, DRINKING)
    if len(set(why.joint.tolist())) == 1:
        assert EHMCS.joint_names[why.joint[0]] == joint
        wider = np.zeros(7)
        wider[why.joint[0]] = 1.0
    else:
        wider = np.ones(7)
    for more, solvable in ((1e-6, True), (-1e-6, False)):
        room = (why.missing.max() + more) * wider
        wide = arm.with_rom(arm.rom.lower - room, arm.rom.upper + room)
        if solvable:
            assert not swivel_map(wide, DRINKING).blocked.size
            check(ak.solve(wide, DRINKING, max_speed=None))
        else:
            with pytest.raises(UnreachablePathError):
                ak.solve(wide, DRINKING)


# --- several answers --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arm", "path"),
    [
        (EHMCS, thin(ak.load_task("playing_ball").path)),
        (SPHERICAL["alfaiz"], smooth_path(SPHERICAL["alfaiz"], 25, seed=0)[0]),
        (SPHERICAL["human"], smooth_path(SPHERICAL["human"], 25, seed=1)[0]),
    ],
    ids=["ehmcs", "alfaiz", "human"],
)
def test_alternatives_are_sorted_different_and_good_on_their_own(arm, path):
    best = check(ak.solve(arm, path, n_best=4))
    everything = [best, *best.alternatives]
    assert 2 <= len(everything) <= 4
    costs = [each.cost for each in everything]
    assert costs == sorted(costs)
    assert best.cost == pytest.approx(ak.solve(arm, path).cost, rel=1e-9)
    for i, each in enumerate(everything):
        check(each)
        assert each.alternatives == () or i == 0
        assert each.path is path
        for other in everything[:i]:
            assert np.abs(each.q - other.q).max() > 0.02
        # An optimum: full space, started there, stays there.
        stays = full_space_from(arm, path, each.q)
        assert each.cost <= stays.cost * (1 + 1e-6)


def test_fewer_are_given_where_fewer_exist():
    task = ak.load_task("drinking_reach")
    best = check(ak.solve(EHMCS, thin(task.path), n_best=50))
    assert len(best.alternatives) < 49


def test_alternatives_are_saved_and_told(tmp_path):
    best = ak.solve(EHMCS, thin(ak.load_task("playing_ball").path), n_best=2)
    (other,) = best.alternatives
    lines = str(best).splitlines()
    assert f"  cost            {best.cost:.6g} 1/s" in lines
    (line,) = [line for line in lines if line.startswith("  choice 2")]
    assert f"cost {other.cost:.6g} 1/s" in line
    away = np.rad2deg(np.abs(other.q - best.q).max(axis=0))
    assert f"{away.max():.3g}° ({EHMCS.joint_names[away.argmax()]})" in line
    assert "choice" not in str(other)
    for each in (best, other):
        with np.load(each.save(tmp_path / "one.npz")) as saved:
            assert np.array_equal(saved["q"], each.q)


# --- joints and places of all kinds -----------------------------------------------------------------


@pytest.mark.parametrize("turns", [1.5, 1.95])
def test_ranges_of_more_than_a_turn(turns):
    """A forearm that turns on and on: the angles follow it past the half turn on both sides."""
    lower, upper = EHMCS.rom.lower.copy(), EHMCS.rom.upper.copy()
    lower[4], upper[4] = -turns * 2 * np.pi, turns * 2 * np.pi
    arm = EHMCS.with_rom(lower, upper)
    q = smooth_angles(EHMCS, 60, seed=1, most=0.2)
    q[:, 4] = np.linspace(-1.5 * np.pi, 1.5 * np.pi, 60)
    path = path_of(arm, q)
    options = TrajectoryOptions(max_speed=None)
    for shift in (0.0, 2 * np.pi):
        start = q[0] + shift * np.eye(7)[4]
        solution = check(ak.solve(arm, path, max_speed=None, start=start))
        assert np.abs(solution.q[0] - start).max() < 1e-9
    solution = over_the_map(arm, path, max_speed=None)
    assert np.ptp(solution.q[:, 4]) > 1.5 * np.pi
    assert solution.cost <= full_space_from(arm, path, q, options).cost * (1 + 1e-6)


def test_a_range_of_more_than_a_turn_still_ends_somewhere():
    """The forearm begins a quarter turn from its limit and turns towards it: the other way round is taken."""
    lower, upper = EHMCS.rom.lower.copy(), EHMCS.rom.upper.copy()
    lower[4], upper[4] = -1.25 * np.pi, 1.25 * np.pi
    arm = EHMCS.with_rom(lower, upper)
    q = smooth_angles(EHMCS, 60, seed=1, most=0.2)
    q[:, 4] = np.linspace(-1.2 * np.pi, 1.2 * np.pi, 60)
    path = path_of(arm, q)
    solution = over_the_map(arm, path, max_speed=None)
    assert np.all(np.abs(solution.q[:, 4]) <= 1.25 * np.pi)
    assert solution.cost <= (1 + 1e-6) * full_space_from(arm, path, q).cost


def test_ranges_of_exactly_a_turn():
    arm = SPHERICAL["alfaiz"]
    assert np.any(np.abs(arm.rom.width - 2 * np.pi) < 1e-9)
    for seed in (2, 3):
        path, q = smooth_path(arm, 25, seed)
        mine = over_the_map(arm, path)
        assert mine.cost <= (1 + 1e-6) * full_space_from(arm, path, q).cost


@pytest.mark.parametrize(
    "family",
    [
        "reference_line",
        "through_shoulder_pole",
        "near_shoulder_pole",
        "through_straight_arm",
        "wrist_singularity",
        "behind_the_shoulder",
        "wrist_limits",
        "tight_limits",
        "loops",
    ],
)
def test_difficult_places(family):
    for number in (0, 1):
        case = trajectory(family, number)
        solution = check(ak.solve(case.arm, case.path))
        other = full_space_from(case.arm, case.path, case.q)
        assert solution.cost <= 1.001 * other.cost


@pytest.mark.parametrize("room", [0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3])
@pytest.mark.parametrize("joint", [0, 2, 4, 6])
def test_a_joint_with_next_to_no_range_leaves_next_to_no_choice(joint, room):
    q = smooth_angles(EHMCS, 25, 1)
    q[:, joint] = q[0, joint]
    lower, upper = EHMCS.rom.lower.copy(), EHMCS.rom.upper.copy()
    lower[joint], upper[joint] = q[0, joint] - 0.7 * room, q[0, joint] + room
    arm = EHMCS.with_rom(lower, upper)
    solution = over_the_map(arm, path_of(arm, q))
    assert np.ptp(solution.q[:, joint]) <= 1.7 * room + 1e-15


@pytest.mark.parametrize("n", [3, 25])
def test_ranges_that_touch_the_generating_motion_on_both_sides_of_every_joint(n):
    for seed in (0, 1):
        for room in (0.0, 1e-9, 1e-6):
            q = smooth_angles(EHMCS, n, seed)
            arm = EHMCS.with_rom(q.min(axis=0) - room, q.max(axis=0) + room)
            solution = over_the_map(arm, path_of(arm, q))
            assert solution.cost <= (1 + 1e-9) * plain_objective(
                solution.time, q, arm.rom.middle, (1.0, 0.01, 1e-3)
            )


def test_alternatives_begin_with_the_start_and_keep_rate_limits():
    arm = SPHERICAL["alfaiz"]
    path, q = smooth_path(arm, 25, seed=0)
    for each in (best := ak.solve(arm, path, start=q[0], n_best=3), *best.alternatives):
        check(each)
        assert np.abs(each.q[0] - q[0]).max() < 1e-9
    free = ak.solve(arm, path, n_best=3)
    limits = np.full(7, np.inf)
    limits[0] = 0.9 * free.max_speed[0]
    for each in (best := ak.solve(arm, path, max_speed=limits, n_best=3), *best.alternatives):
        check(each)
        assert each.max_speed[0] <= limits[0]
