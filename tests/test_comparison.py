"""Solutions beside measured motions: known differences come out as they were put in."""

from __future__ import annotations

import csv
from types import SimpleNamespace

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import smooth_angles
from solutions import of_motion

import armik_sym as ak
from armik_sym.comparison import Difference
from armik_sym.comparison.difference import difference_of
from armik_sym.errors import HandPathError, MotionFileError, OptionError, ShapeError, UnknownNameError
from armik_sym.motion import JointMotion

HUMAN = ak.catalog.human()
TIME = np.linspace(0.0, 4.0, 81)


@pytest.fixture(scope="module")
def solved() -> ak.Solution:
    return of_motion(HUMAN, smooth_angles(HUMAN, len(TIME), 3), time=TIME)


def motion(q, time=TIME, names=HUMAN.joint_names):
    return JointMotion(time, q, names)


def test_the_numbers_of_a_difference_are_those_of_its_definition():
    d = difference_of([0.0, 1.0, 2.0, 3.0, 4.0], [1.0, -3.0, np.nan, 2.0, 0.0])
    assert d == Difference(mean=1.5, rms=np.sqrt(14 / 4), max=3.0, at=1.0, bias=0.0, samples=4)
    nothing = difference_of([0.0], [np.nan])
    assert nothing.samples == 0
    assert np.isnan([nothing.mean, nothing.rms, nothing.max, nothing.at, nothing.bias]).all()


def test_the_same_motion_differs_by_nothing(solved):
    for measured in (solved.q, motion(solved.q)):
        c = ak.compare(solved, measured)
        assert c.notes == ()
        assert c.all_joints.max == 0.0
        assert c.swivel_summary.max < 1e-12
        assert c.elbow_summary.max == 0.0
        assert np.array_equal(c.time, TIME)


def test_each_joint_gets_the_difference_that_was_put_in(solved):
    """A constant offset, a ramp and a wave, in degrees."""
    put = np.zeros((len(TIME), 7))
    put[:, 1] = 5.0
    put[:, 3] = -2.0 * TIME
    put[:, 6] = 3.0 * np.where(np.arange(len(TIME)) % 2, 1, -1)
    c = ak.compare(solved, solved.q - np.deg2rad(put))
    np.testing.assert_allclose(np.rad2deg(c.joint_difference), put, atol=1e-12)
    offset, ramp, wave = (c.joints[j] for j in (1, 3, 6))
    in_deg = {name: np.rad2deg([getattr(d, name) for d in (offset, ramp, wave)]) for name in
              ("mean", "rms", "max", "bias")}  # fmt: skip
    np.testing.assert_allclose(in_deg["mean"], [5, 4, 3], atol=1e-12)
    np.testing.assert_allclose(in_deg["rms"], [5, 2 * np.sqrt(np.mean(TIME**2)), 3], atol=1e-12)
    np.testing.assert_allclose(in_deg["max"], [5, 8, 3], atol=1e-12)
    np.testing.assert_allclose(in_deg["bias"], [5, -4, -3 / 81], atol=1e-12)
    assert ramp.at == 4.0
    assert np.rad2deg(c.all_joints.mean) == pytest.approx((5 + 4 + 3) / 7)
    assert np.rad2deg(c.all_joints.max) == pytest.approx(8)


@pytest.mark.parametrize("name", ["human", "ehmcs", "alfaiz"])
def test_the_elbow_turned_about_the_line_to_the_wrist_is_a_difference_of_the_swivel_alone(name):
    """Postures from the map: the same hand, the swivel angle moved by a known amount."""
    arm = ARMS[name]
    path = of_motion(arm, smooth_angles(arm, 60, 5, width=0.5)).path
    map_ = ak.swivel_map(arm, path)
    at = map_.swivel_of(smooth_angles(arm, 60, 5, width=0.5))
    moved = at.psi + np.deg2rad(20.0)
    here, there = (map_.postures(psi, at.branch) for psi in (at.psi, moved))
    c = ak.compare(of_motion(arm, here, path=path), there)
    known = np.isfinite(c.swivel_difference)
    assert known.sum() > 50
    np.testing.assert_allclose(np.rad2deg(c.swivel_difference[known]), -20.0, atol=1e-8)
    np.testing.assert_allclose(c.joint_difference[:, 3], 0.0, atol=1e-9)
    # The elbow goes along a chord of its circle.
    centre = map_.spherical.shoulder.centre
    upper = c.elbow - centre
    from armik_sym.swivel.reference import wrist_directions

    along = wrist_directions(map_.spherical, path.position, path.rotation)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    radius = np.linalg.norm(np.cross(along, upper), axis=1)
    np.testing.assert_allclose(c.elbow_difference, 2 * radius * np.sin(np.deg2rad(10.0)), atol=1e-9)


def test_the_elbow_is_where_the_upper_arm_ends():
    q = smooth_angles(HUMAN, 20, 1)
    elbow = ak.compare(of_motion(HUMAN, q), q).elbow
    np.testing.assert_allclose(np.linalg.norm(elbow, axis=1), HUMAN.lengths["upper_arm"], atol=1e-12)
    longer = HUMAN.with_lengths(forearm=0.4, hand=0.0)
    assert np.array_equal(ak.compare(of_motion(longer, q), q).elbow, elbow)


def test_joints_that_can_turn_round_differ_the_short_way_and_others_do_not(solved):
    """Flexion of the human arm has a range of 360°, abduction has not."""
    q = np.array(solved.q)
    q[:, 0] = np.deg2rad(np.linspace(170, 179, len(q)))
    far = of_motion(HUMAN, q, time=TIME)
    measured = q.copy()
    measured[:, 0] -= np.deg2rad(350.0)
    measured[:, 1] -= np.deg2rad(350.0)
    c = ak.compare(far, measured)
    np.testing.assert_allclose(np.rad2deg(c.joint_difference[:, 0]), -10.0, atol=1e-10)
    np.testing.assert_allclose(np.rad2deg(c.joint_difference[:, 1]), 350.0, atol=1e-10)


def test_missing_samples_are_missing_in_every_number(solved):
    measured = solved.q - np.deg2rad(1.0)
    measured[10:20] = np.nan
    measured[30, 2] = np.inf
    measured[:, 5] = np.nan
    c = ak.compare(solved, measured)
    assert [d.samples for d in c.joints] == [71, 71, 70, 71, 71, 0, 71]
    assert np.rad2deg(c.all_joints.mean) == pytest.approx(1.0)
    assert np.isnan(c.swivel_difference).all()
    # The place of the elbow does not depend on the wrist.
    assert c.elbow_summary.samples == 70
    assert any("missing at 81 of 81" in note for note in c.notes)
    assert " - " in str(c)
    measured[:, 5] = solved.q[:, 5]
    c = ak.compare(solved, measured)
    assert c.swivel_summary.samples == 70
    assert c.elbow_summary.samples == 70


def test_joints_are_matched_by_name_and_those_not_measured_are_named(solved):
    names = ("wrist_extension", "scapula_tilt", "elbow_flexion")
    q = np.column_stack([solved.q[:, 5] - 0.1, np.zeros(len(TIME)), solved.q[:, 3] + 0.2])
    c = ak.compare(solved, motion(q, names=names))
    assert c.joint_names == ("elbow_flexion", "wrist_extension")
    np.testing.assert_allclose([d.bias for d in c.joints], [-0.2, 0.1], atol=1e-12)
    assert c.swivel is None
    assert c.elbow_difference is None
    assert c.elbow_summary is None
    assert any("forearm_pronation" in note for note in c.notes)
    assert any("scapula_tilt" in note for note in c.notes)


def test_arms_without_a_swivel_angle_are_compared_joint_by_joint():
    arm = ARMS["custom_standard"]
    q = smooth_angles(arm, 30, 2)
    c = ak.compare(of_motion(arm, q), q + 0.01)
    assert c.swivel is None
    assert c.elbow is None
    assert any("no swivel and elbow" in note for note in c.notes)
    assert [unit.name for unit in c.units] == ["mm", "deg", "deg", "mm", "deg"]
    # A shift of 10 mm is no angle.
    assert c.all_joints.samples == 3 * 30
    assert "lift [mm]" in str(c)
    assert c.plot().axes


def test_a_straight_arm_has_no_swivel_to_compare():
    q = smooth_angles(HUMAN, 40, 1)
    q[:, 3] = np.deg2rad(60.0)
    q[10:15, 3] = 0.0
    c = ak.compare(of_motion(HUMAN, q), q)
    assert np.flatnonzero(np.isnan(c.swivel_difference)).tolist() == list(range(10, 15))
    assert any("swivel not compared at 5 samples" in note for note in c.notes)


def test_where_the_person_left_the_range_of_motion_is_said(solved):
    measured = np.array(solved.q)
    measured[5:8, 4] = HUMAN.rom.upper[4] + np.deg2rad([1.0, 12.5, 2.0])
    (note,) = ak.compare(solved, measured).notes
    assert "forearm pronation" in note
    assert "3 samples" in note
    assert "12.5°" in note


def test_samples_a_solver_left_without_angles_are_not_compared(solved):
    q = np.array(solved.q)
    q[20:25] = np.nan
    c = ak.compare(of_motion(HUMAN, q, time=TIME, path=solved.path), solved.q)
    assert c.all_joints.samples == 7 * 76
    assert c.all_joints.max == 0.0
    assert c.swivel_summary.samples == 76
    assert np.isfinite(c.swivel[25:]).all()
    assert any("solved angles are not finite at 5 of 81" in note for note in c.notes)
    assert c.plot().axes


def test_the_table_and_the_files_say_the_same(solved, tmp_path):
    measured = solved.q - np.deg2rad(np.arange(7.0))
    measured[3, 0] = np.nan
    c = ak.compare(solved, measured)
    table = str(c).splitlines()
    assert "by hand" in table[0]
    (line,) = [row for row in table if "elbow_flexion [deg]" in row]
    cells = line.split()[2:]
    assert cells[:3] + cells[4:] == ["3.00", "3.00", "3.00", "+3.00"]
    assert any("swivel [deg]" in row for row in table)
    assert any("elbow_position [mm]" in row for row in table)
    file = c.save(tmp_path / "samples.csv")
    with file.open(encoding="utf-8") as text:
        assert "missing at 1 of 81" in next(text)
        rows = list(csv.DictReader(text))
    assert len(rows) == 81
    assert rows[3]["shoulder_flexion_difference [deg]"] == ""
    assert float(rows[0]["wrist_extension_difference [deg]"]) == pytest.approx(5.0)
    assert float(rows[7]["elbow_difference [mm]"]) == pytest.approx(1000 * c.elbow_difference[7])
    for wrong in ("samples.txt", "no/such/folder.csv"):
        with pytest.raises(MotionFileError, match=wrong):
            c.save(tmp_path / wrong)


def test_what_cannot_be_compared_is_refused(solved):
    with pytest.raises(OptionError, match="solution is a ndarray"):
        ak.compare(solved.q, solved.q)  # type: ignore[arg-type]
    with pytest.raises(OptionError, match="read_joint_angles"):
        ak.compare(solved, "angles.csv")
    with pytest.raises(OptionError, match="measured is a Solution"):
        ak.compare(solved, solved)  # type: ignore[arg-type]
    fitted = SimpleNamespace(unlimited=solved.q, measured=solved.q)
    with pytest.raises(OptionError, match=r"give its \.unlimited"):
        ak.compare(solved, fitted)  # type: ignore[arg-type]
    with pytest.raises(ShapeError, match=r"\(80, 7\), expected \(81, 7\)"):
        ak.compare(solved, solved.q[1:])
    with pytest.raises(HandPathError, match="nothing to compare"):
        ak.compare(solved, np.full((81, 7), np.nan))
    with pytest.raises(HandPathError, match="not an array of numbers"):
        ak.compare(solved, [["a"] * 7] * 81)
    with pytest.raises(UnknownNameError, match="hip"):
        ak.compare(solved, motion(solved.q[:, :1], names=("hip",)))
