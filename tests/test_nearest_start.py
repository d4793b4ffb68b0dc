"""The posture at the first sample nearest to a known one: against dense scans of all branches."""

from __future__ import annotations

import numpy as np
import pytest
from exact_solves import check
from smooth_motions import path_of, smooth_angles, smooth_path
from spherical_arms import ARMS
from swivel_backends import swivel_backend

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.errors import LimitError
from armik_sym.swivel.full_turns import split_at_full_turns
from armik_sym.swivel.map import swivel_map
from armik_sym.swivel.postures_at import postures_at
from armik_sym.trajectory.nearest_start import nearest_on_curve

EHMCS = ARMS["ehmcs"]


def intervals_of(arm, path):
    return split_at_full_turns(swivel_map(arm, path).intervals, "auto")


def scanned(arm, path, start, n=4001):
    """The nearest posture on a grid of every interval of sample 0, in the nearest turn of every joint."""
    map_ = swivel_map(arm, path)
    first, least = None, np.inf
    for i in np.flatnonzero(map_.intervals.sample == 0):
        psi = np.linspace(map_.intervals.start[i], map_.intervals.end[i], n)
        samples, branch = np.zeros(n, dtype=np.int64), np.full(n, map_.intervals.branch[i])
        q = postures_at(map_.intervals.curves, samples, branch, psi, start).q
        q = q[arm.rom.margin(q).min(axis=1) >= -1e-9]
        if len(q):
            away = np.linalg.norm(q - start, axis=1)
            if away.min() < least:
                first, least = q[away.argmin()], away.min()
    return first, least


@pytest.mark.parametrize("name", sorted(ARMS))
@pytest.mark.parametrize("seed", range(6))
def test_no_posture_of_a_dense_scan_is_nearer(name, seed):
    arm = ARMS[name]
    rng = np.random.default_rng(seed)
    path, q = smooth_path(arm, 3, seed)
    near = arm.rom.clip(q[0] + rng.normal(0, 0.1, 7))
    anywhere = arm.rom.random_postures(rng, 1)[0]
    for start in (near, anywhere, arm.rom.lower, arm.rom.upper):
        found = nearest_on_curve(intervals_of(arm, path), start)
        position, rotation = hand_pose(arm.chain, found[None], arm.lengths)
        assert np.abs(position - path.position[0]).max() < 1e-12
        assert np.abs(rotation - path.rotation[0]).max() < 1e-12
        assert arm.rom.margin(found).min() >= 0
        _, least = scanned(arm, path, start)
        assert np.linalg.norm(found - start) <= least + 1e-9


@pytest.mark.parametrize("backend", ["auto", "vm"])
@pytest.mark.parametrize("name", sorted(ARMS))
def test_a_posture_on_the_path_is_found_itself(name, backend):
    arm = ARMS[name]
    with swivel_backend(backend):
        for seed in range(4):
            path, q = smooth_path(arm, 3, seed)
            assert np.abs(nearest_on_curve(intervals_of(arm, path), q[0], backend) - q[0]).max() < 1e-9


@pytest.mark.parametrize("joint", range(7))
@pytest.mark.parametrize("end", ["lower", "upper"])
def test_a_posture_at_a_limit_is_found_itself(joint, end):
    q = smooth_angles(EHMCS, 3, 2)
    q[0, joint] = getattr(EHMCS.rom, end)[joint]
    path = path_of(EHMCS, q)
    found = nearest_on_curve(intervals_of(EHMCS, path), q[0])
    # At an end of the interval; the straight arm has no swivel angle, and rounding bends it by 1e-8 rad.
    straight = joint == 3 and end == "lower"
    assert np.abs(found - q[0]).max() < (1e-5 if straight else 1e-9)
    assert EHMCS.rom.margin(found).min() >= 0


@pytest.mark.parametrize("name", sorted(ARMS))
def test_solve_begins_with_a_start_on_the_path(name):
    arm = ARMS[name]
    path, q = smooth_path(arm, 20, 1)
    solution = check(ak.solve(arm, path, start=q[0]))
    assert np.abs(solution.q[0] - q[0]).max() < 1e-9


@pytest.mark.parametrize("name", ["ehmcs", "alfaiz", "odd_standard"])
def test_solve_begins_with_the_nearest_posture_and_says_how_far_away_it_is(name):
    arm = ARMS[name]
    path, q = smooth_path(arm, 20, 1)
    start = arm.rom.clip(q[0] + np.random.default_rng(3).normal(0, 0.08, 7))
    solution = ak.solve(arm, path, start=start, search="swivel", max_speed=None)
    _, least = scanned(arm, path, start)
    away = np.linalg.norm(solution.q[0] - start)
    assert least - 1e-4 < away <= least + 1e-9
    assert np.array_equal(solution.start, start)
    assert not solution.ok
    assert "start posture does not put the hand on the path" in solution.reasons[0]
    enough = np.abs(solution.q[0] - start).max() + 1e-9
    check(ak.solve(arm, path, start=start, search="swivel", max_speed=None, start_tolerance=enough))


@pytest.mark.parametrize("search", ["swivel", "full-space"])
def test_a_start_outside_the_range_of_motion_is_refused(search):
    path, q = smooth_path(EHMCS, 5, 1)
    start = q[0].copy()
    start[3] = EHMCS.rom.upper[3] + 0.01
    with pytest.raises(LimitError, match="elbow_flexion"):
        ak.solve(EHMCS, path, start=start, search=search)


def test_a_start_decides_the_branch_even_where_another_is_cheaper():
    """Alternatives of a free solve, given as start, come back as the best from there."""
    task = ak.load_task("playing_ball").path
    path = ak.HandPath(task.time[::4], task.position[::4], task.rotation[::4])
    (other,) = ak.solve(EHMCS, path, n_best=2).alternatives
    again = check(ak.solve(EHMCS, path, start=other.q[0]))
    assert np.abs(again.q[0] - other.q[0]).max() < 1e-9
    assert again.cost <= other.cost * (1 + 1e-6)
