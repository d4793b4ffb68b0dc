"""The baseline that keeps the swivel angle, and predictions from the first posture."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles

import armik_sym as ak
from armik_sym.comparison import constant_swivel, predict, predictors
from armik_sym.comparison.predicting import first_inside
from armik_sym.errors import ArmModelError, HandPathError, OptionError, ShapeError, UnknownNameError
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.spherical_arm import recognise

HUMAN = ak.catalog.human()


def lax(arm):
    """The same arm with half a radian more in every joint but the elbow."""
    more = np.where(np.arange(7) == 3, 0.0, 0.5)
    return arm.with_rom(arm.rom.lower - more, arm.rom.upper + more)


def held(arm, seed, n=60, turn=0.0):
    """A smooth hand path, and postures along it whose swivel angle stays what it was at the first sample."""
    q = smooth_angles(arm, n, seed, width=0.4, most=0.5)
    arm = lax(arm)
    map_ = ak.swivel_map(arm, path_of(arm, q))
    at = map_.swivel_of(q)
    return map_, map_.postures(at.psi[0] + turn, at.branch[0], q), int(at.branch[0])


@pytest.mark.parametrize("name", ["human", "ehmcs", "alfaiz"])
def test_a_person_who_keeps_the_swivel_angle_is_met_exactly(name):
    arm = lax(ARMS[name])
    map_, q, _ = held(ARMS[name], 4)
    assert np.all(arm.rom.margin(q) > 0)
    solution = constant_swivel(arm, map_.path, q[0])
    assert solution.position_error.max() < 1e-9
    assert solution.rotation_error.max() < 1e-9
    assert solution.settings["clipped"] == solution.settings["blocked"] == 0
    assert "kept at 60 of 60 samples" in solution.status
    c = ak.compare(solution, q)
    assert np.rad2deg(c.all_joints.max) < 1e-7
    assert 1000 * c.elbow_summary.max < 1e-7


def test_limits_move_the_angle_to_the_nearest_possible_one_and_it_is_said_where():
    map_, q, branch = held(HUMAN, 4)
    j = int(np.argmax(np.ptp(q, axis=0)))
    upper = map_.arm.rom.upper.copy()
    upper[j] = 0.5 * (q[0, j] + q[:, j].max())
    narrow = HUMAN.with_rom(map_.arm.rom.lower, upper)
    solution = constant_swivel(narrow, map_.path, q[0])
    psi = ak.swivel_map(narrow, map_.path).swivel_of(solution).psi
    inside = ak.swivel_map(narrow, map_.path).contains(np.full(60, psi[0]), branch)
    assert 0 < inside.sum() < 60
    assert solution.settings["blocked"] == 0
    assert solution.settings["clipped"] == (~inside).sum()
    np.testing.assert_allclose(psi[inside], psi[0], atol=1e-9)
    assert np.all(solution.q >= narrow.rom.lower)
    assert np.all(solution.q <= narrow.rom.upper)
    assert solution.position_error.max() < 1e-9
    # Moved no farther than needed: some joint is at a limit wherever the angle was moved.
    at_limit = narrow.rom.margin(solution.q).min(axis=1)
    np.testing.assert_allclose(at_limit[~inside], 0.0, atol=1e-7)
    first = map_.path.time[np.flatnonzero(~inside)[0]]
    assert f"({first:.3g} s to" in solution.status


def test_where_there_is_no_posture_joints_stop_and_the_hand_leaves_the_path():
    map_, q, _ = held(HUMAN, 4)
    upper = map_.arm.rom.upper.copy()
    upper[3] = 0.5 * (q[0, 3] + q[:, 3].max())
    assert upper[3] > q[0, 3]
    weak = HUMAN.with_rom(map_.arm.rom.lower, upper)
    beyond = q[:, 3] > upper[3]
    solution = constant_swivel(weak, map_.path, q[0])
    assert solution.settings["blocked"] == beyond.sum() > 0
    assert "no posture inside the range of motion" in solution.status
    assert not solution.ok
    assert solution.rom_margin.min() >= 0
    np.testing.assert_array_equal(solution.q[beyond, 3], upper[3])
    assert np.all(solution.position_error[beyond] > 1e-9)
    assert solution.position_error[~beyond].max() < 1e-9


def test_the_angle_from_below_stays_the_same_against_the_vertical():
    """Counted from straight down, as in the literature, the kept angle is constant in that sense."""
    map_, q, _ = held(HUMAN, 4)
    solution = constant_swivel(map_.arm, map_.path, q[0], zero="down")
    down = np.tile(-np.asarray(HUMAN.up), (60, 1))
    psi = swivel_of_postures(recognise(HUMAN), solution.q, down).psi
    kept = 60 - solution.settings["clipped"] - solution.settings["blocked"]
    assert kept > 40
    assert (np.abs(np.unwrap(psi) - psi[0]) < 1e-9).sum() == kept
    carried = constant_swivel(map_.arm, map_.path, q[0])
    assert np.abs(carried.q - solution.q).max() > 1e-3


def test_what_has_no_swivel_angle_to_keep_is_refused():
    q = smooth_angles(HUMAN, 20, 1)
    path = path_of(HUMAN, q)
    with pytest.raises(OptionError, match="no rotation"):
        constant_swivel(HUMAN, path_of(HUMAN, q, turned=False), q[0])
    five = ak.catalog.ehmcs(5)
    with pytest.raises(ArmModelError, match="5 joints"):
        constant_swivel(five, path, np.zeros(5))
    with pytest.raises(OptionError, match="zero is 'up'"):
        constant_swivel(HUMAN, path, q[0], zero="up")  # type: ignore[arg-type]
    with pytest.raises(ShapeError, match=r"\(7,\)"):
        constant_swivel(HUMAN, path, q[0, :6])
    with pytest.raises(HandPathError, match="finite"):
        constant_swivel(HUMAN, path, np.full(7, np.nan))
    with pytest.raises(OptionError, match="expected a HandPath"):
        constant_swivel(HUMAN, q, q[0])  # type: ignore[arg-type]
    with pytest.raises(OptionError, match="expected an Arm"):
        constant_swivel("human", path, q[0])  # type: ignore[arg-type]
    other = ARMS["custom_standard"]
    with pytest.raises(ArmModelError, match="joint 'lift' shifts"):
        constant_swivel(other, path, np.zeros(other.dof))
    with pytest.raises(ArmModelError, match="where up is"):
        constant_swivel(dataclasses.replace(HUMAN, up=None), path, q[0], zero="down")


def test_predictions_know_the_path_and_the_first_posture_only():
    map_, q, _ = held(HUMAN, 4)
    assert set(predictors()) == {*ak.methods(), "swivel-constant"}
    arm = map_.arm
    soft = predict(arm, map_.path, q[0], backend="vm")
    assert soft.settings["tracking"] == "soft"
    np.testing.assert_allclose(soft.q[0], q[0], atol=np.deg2rad(3))
    exact = predict(arm, map_.path, q[0], tracking="exact", backend="vm")
    assert exact.ok
    assert exact.position_error.max() < 1e-9
    assert predict(arm, map_.path, q[0], "swivel-constant").method == "swivel-constant"
    assert predict(arm, map_.path, q[0], "lm", backend="vm").method == "lm"
    with pytest.raises(UnknownNameError, match="swivel-constant"):
        predict(HUMAN, map_.path, q[0], "guess")


def test_a_first_posture_outside_the_limits_stops_at_them_and_it_is_said():
    first = HUMAN.rom.middle.copy()
    assert first_inside(HUMAN, first)[1] == ""
    first[4] = HUMAN.rom.upper[4] + np.deg2rad(12.5)
    moved, words = first_inside(HUMAN, first)
    assert moved[4] == HUMAN.rom.upper[4]
    assert np.array_equal(np.delete(moved, 4), np.delete(first, 4))
    assert "forearm pronation by 12.5°" in words
    with pytest.raises(ShapeError, match=r"\(7,\)"):
        first_inside(HUMAN, first[:3])
    with pytest.raises(HandPathError, match="finite"):
        first_inside(HUMAN, np.full(7, np.inf))
