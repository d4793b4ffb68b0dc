"""What a solve refuses, and how clearly it says so."""

from __future__ import annotations

import numpy as np
import pytest
from exact_solves import EHMCS
from sample_arms import ARMS
from smooth_motions import smooth_path

import armik_sym as ak
from armik_sym.errors import LimitError, OptionError, ShapeError, SolverError, UnreachablePathError
from armik_sym.motion.hand_path import HandPath
from armik_sym.trajectory import full_space_method, swivel_method


def test_out_of_reach_names_samples_and_shortfall():
    shoulder = np.array([0.0, 0.0, 0.143])
    direction = np.array([0.0, 0.6, 0.8])
    far = np.array([0.70, 0.75, 0.80])
    with pytest.raises(UnreachablePathError) as caught:
        ak.solve(EHMCS, HandPath([0.0, 1.0, 2.0], shoulder + far[:, None] * direction))
    error = caught.value
    assert error.samples.tolist() == [0, 1, 2]
    longest = EHMCS.lengths["upper_arm"] + EHMCS.lengths["forearm"]
    np.testing.assert_allclose(error.shortfall, far - longest, atol=1e-3)
    assert f"sample 0 by {1000 * error.shortfall[0]:.3g} mm" in str(error)
    assert 'tracking="soft"' in str(error)
    assert "3 of 3 samples" in str(error)


def test_only_the_samples_out_of_reach_are_named():
    shoulder = np.array([0.0, 0.0, 0.143])
    direction = np.array([0.0, 0.6, 0.8])
    longest = EHMCS.lengths["upper_arm"] + EHMCS.lengths["forearm"]
    distance = longest + np.array([-0.2, -0.1, -0.02, 0.02, 0.05, 0.03, -0.01, -0.05, 0.01, -0.1])
    with pytest.raises(UnreachablePathError) as caught:
        ak.solve(EHMCS, HandPath(np.arange(10.0), shoulder + distance[:, None] * direction))
    assert caught.value.samples.tolist() == [3, 4, 5, 8]
    np.testing.assert_allclose(caught.value.shortfall, [0.02, 0.05, 0.03, 0.01], atol=1e-3)


def locked_wrist():
    """An arm whose wrist does not move, and a path that needs a moving one."""
    path, _ = smooth_path(EHMCS, 6, seed=1)
    upper = EHMCS.rom.upper.copy()
    upper[4:] = EHMCS.rom.lower[4:]
    return EHMCS.with_rom(EHMCS.rom.lower, upper), path


def test_an_orientation_out_of_reach_is_told_in_degrees():
    with pytest.raises(UnreachablePathError, match=r"mm and .*°") as caught:
        ak.solve(*locked_wrist(), search="full-space")
    assert np.all(caught.value.turn + caught.value.shortfall > 1e-3)


def test_an_orientation_out_of_reach_is_told_joint_by_joint_by_the_swivel_map():
    arm, path = locked_wrist()
    said = r"sample 0 \(0 s\): (forearm|wrist) \w+ limit \(.*°\) missed by [\d.]+°.*tracking=\"soft\""
    with pytest.raises(UnreachablePathError, match=said) as caught:
        ak.solve(arm, path)
    error = caught.value
    assert "of 6 samples cannot be reached by arm 'ehmcs' inside its range of motion" in str(error)
    assert error.samples.shape == error.shortfall.shape == error.turn.shape
    assert np.all(error.turn + error.shortfall > 1e-3)


def test_poses_too_far_away_are_told_in_millimetres_by_the_swivel_map():
    path, _ = smooth_path(EHMCS, 8, seed=1)
    shoulder = np.array([0.0, 0.0, 0.143])
    direction = path.position - shoulder
    position = path.position.copy()
    position[3:5] += 0.5 * direction[3:5] / np.linalg.norm(direction[3:5], axis=1)[:, None]
    with pytest.raises(UnreachablePathError, match=r"\d mm") as caught:
        ak.solve(EHMCS, HandPath(path.time, position, path.rotation))
    assert caught.value.samples.tolist() == [3, 4]
    assert np.all(caught.value.shortfall > 0.05)


def test_hand_faster_than_the_joints_allow():
    path = HandPath([0.0, 1.0, 1.01, 2.0], [[0, 0.1, 0.5], [0, 0.1, 0.5], [0, 0.4, 0.5], [0, 0.4, 0.5]])
    with pytest.raises(LimitError, match=r"between samples 1 and 2 the hand moves at 30 m/s.*max_speed"):
        ak.solve(EHMCS, path, max_speed=1.0)


@pytest.mark.parametrize("name", ["max_speed", "max_acceleration"])
def test_a_rate_limit_that_contradicts_the_path_names_a_joint(name):
    # Four joints and three coordinates, far from singular: nothing to give way.
    arm = ARMS["ehmcs_4dof"]
    path, _ = smooth_path(arm, 15, seed=1)
    limit = 0.05 * getattr(ak.solve(arm, path, orientation="none"), name).max()
    with pytest.raises(LimitError) as caught:
        ak.solve(arm, path, orientation="none", **{name: limit, "max_iterations": 60})
    text = str(caught.value)
    assert name in text
    assert any(joint in text for joint in arm.joint_names) or "between samples" in text
    assert "slow the path down" in text


def test_more_equations_than_joints_is_told_before_anything_runs():
    path, _ = smooth_path(ARMS["ehmcs_5dof"], 6, seed=1)
    with pytest.raises(OptionError, match=r"6 equations.*5 joints.*'pointing' or 'none'.*tracking=\"soft\""):
        ak.solve(ARMS["ehmcs_5dof"], path)
    soft = ak.solve(ARMS["ehmcs_5dof"], path, tracking="soft", position_sigma=1e-4, rotation_sigma=1e-4)
    assert soft.position_error.max() < 1e-5


def test_too_few_iterations_is_a_solver_error_with_the_solvers_word():
    path, _ = smooth_path(EHMCS, 8, seed=1)
    with pytest.raises(
        SolverError, match=r"no attempt converged.*[Rr]aise max_iterations \(now 1\)"
    ) as caught:
        ak.solve(EHMCS, path, max_iterations=1, search="full-space")
    assert caught.value.status == "Maximum_Iterations_Exceeded"


def test_a_wrong_start_is_refused_before_anything_is_compiled(monkeypatch):
    path, q = smooth_path(EHMCS, 4, seed=1)
    monkeypatch.setattr(full_space_method, "compile", None)
    for library in ("swivel_library", "trajectory_library"):
        monkeypatch.setattr(swivel_method, library, None)
    for search in ("auto", "full-space"):
        with pytest.raises(ShapeError, match="start"):
            ak.solve(EHMCS, path, start=q, search=search)
