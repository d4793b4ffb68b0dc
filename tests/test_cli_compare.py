"""`armik compare`: from a recording to tables and figures."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from smooth_motions import path_of, smooth_angles
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.comparison.elbow import elbow_position
from armik_sym.motion.joint_csv import write_joint_angles
from armik_sym.motion.marker_csv import write_marker_csv
from armik_sym.motion.marker_recording import MarkerRecording

HUMAN = ak.catalog.human(0.3, 0.25, 0.08)
TIME = np.linspace(0.0, 3.0, 61)
SHOULDER = np.array([0.1, 0.2, 1.3])


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def markers(q, side="left"):
    """Points of an arm in the axes of a laboratory: x forward, y left, z up."""
    path = path_of(HUMAN, q, TIME)
    wrist = path.position - 0.08 * path.rotation[:, :, 0]
    points = {
        "shoulder": np.zeros((len(q), 3)),
        "elbow": elbow_position(HUMAN, q),
        "wrist": wrist,
        "hand": path.position,
        "hand_ulnar": wrist + 0.05 * path.rotation[:, :, 1],
    }
    # The base of the arm has x up, y right, z forward.
    to_lab = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    if side == "right":
        to_lab = np.diag([1.0, -1.0, 1.0]) @ to_lab
    position = np.stack([values @ to_lab.T + SHOULDER for values in points.values()], axis=1)
    return MarkerRecording(TIME, tuple(points), position)


@pytest.fixture(scope="module")
def motion() -> np.ndarray:
    """Reaching forward: degrees at the beginning and at the end, and a wave of the upper arm."""
    first, last = np.deg2rad([[10, 20, 5, 90, 10, 0, 0], [60, 30, 20, 40, 30, 10, -5]])
    share = 0.5 - 0.5 * np.cos(np.pi * TIME / TIME[-1])
    q = first + share[:, None] * (last - first)
    q[:, 2] += np.deg2rad(15.0) * np.sin(2 * np.pi * TIME / TIME[-1])
    return q


def summary(file):
    with file.open(encoding="utf-8") as text:
        return {(row["method"], row["quantity"]): row for row in csv.DictReader(text)}


@pytest.mark.parametrize("side", ["left", "right"])
def test_markers_of_an_arm_become_tables_and_figures(motion, side, tmp_path):
    """All methods of the default on one side; one method, with the same angles, on the other."""
    methods = ("trajectory", "pro-isade", "swivel-constant") if side == "left" else ("swivel-constant",)
    chosen = () if side == "left" else ("--method", "swivel-constant")
    write_marker_csv(tmp_path / "reach.csv", markers(motion, side))
    result = run(
        "compare", tmp_path / "reach.csv", "--side", side, "--frame", "x forward, z up", *chosen,
        "--out", tmp_path / "out",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    out = tmp_path / "out"
    found = summary(out / "reach_comparison.csv")
    assert {method for method, _ in found} == set(methods)
    for method in methods:
        for quantity in (*HUMAN.joint_names, "all_joints", "swivel", "elbow_position"):
            assert int(found[method, quantity]["samples"]) > 0
        # The same arm and hand: elbow flexion leaves no choice.
        assert float(found[method, "elbow_flexion"]["max_abs"]) < 0.5
        for ending in ("csv", "png"):
            assert (out / f"reach_{method}.{ending}").stat().st_size > 1000
    assert (out / "reach_swivel_map.png").stat().st_size > 1000
    text = (out / "reach_comparison.txt").read_text(encoding="utf-8")
    assert "upper arm       300.0 mm" in text
    assert f"{side} arm" in text
    assert "a difference is no error" in text
    assert "swivel [deg]" in result.output
    assert "elbow position [mm]" in result.output
    assert methods[0] in result.output
    # Measured angles in the files are those the markers were made from.
    with (out / "reach_swivel-constant.csv").open(encoding="utf-8") as file:
        next(file)
        rows = list(csv.DictReader(file))
    measured = [float(row["forearm_pronation_measured [deg]"]) for row in rows]
    np.testing.assert_allclose(measured, np.rad2deg(motion[:, 4]), atol=1e-4)


def test_a_person_who_keeps_the_swivel_angle_is_met_by_the_baseline(motion, tmp_path):
    map_ = ak.swivel_map(HUMAN, path_of(HUMAN, motion, TIME))
    at = map_.swivel_of(motion)
    assert np.rad2deg(np.ptp(at.psi)) > 10
    q = map_.postures(at.psi[0], at.branch[0], motion)
    assert np.all(HUMAN.rom.margin(q) > 0)
    write_marker_csv(tmp_path / "keep.csv", markers(q))
    result = run(
        "compare", tmp_path / "keep.csv", "--side", "left", "--frame", "x forward, z up",
        "--method", "swivel-constant", "--out", tmp_path,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    found = summary(tmp_path / "keep_comparison.csv")
    assert {method for method, _ in found} == {"swivel-constant"}
    assert float(found["swivel-constant", "swivel"]["max_abs"]) < 0.01
    assert float(found["swivel-constant", "elbow_position"]["max_abs"]) < 0.05
    assert "swivel-constant: swivel" in result.output


def test_names_of_markers_come_from_a_file(motion, tmp_path):
    named = markers(motion)
    renamed = MarkerRecording(named.time, ("LSHO", "LELB", "LWRI", "LFIN", "LPIN"), named.position)
    write_marker_csv(tmp_path / "reach.csv", renamed)
    result = run("compare", tmp_path / "reach.csv", "--out", tmp_path)
    assert result.exit_code == 2
    assert "--points is missing" in result.output
    assert "LELB" in result.output
    (tmp_path / "points.toml").write_text(
        'side = "left"\nframe = "x forward, z up"\n[points]\nshoulder = "LSHO"\nelbow = "LELB"\n'
        'wrist = "LWRI"\nhand = "LFIN"\nhand_ulnar = "LPIN"\n',
        encoding="utf-8",
    )
    result = run(
        "compare", tmp_path / "reach.csv", "--points", tmp_path / "points.toml",
        "--method", "swivel-constant", "--out", tmp_path,
    )  # fmt: skip
    assert result.exit_code == 0, result.output


def test_joint_angles_of_an_exoskeleton_are_compared_without_a_fit(tmp_path):
    """As in Nguyen 2021: the device measures the angles, its hand path is solved, the angles are compared."""
    task = ak.load_task("drinking_reach")
    file = tmp_path / "device.csv"
    write_joint_angles(file, task.measured.time, task.measured.q, task.measured.joint_names)
    result = run(
        "compare", file, "--arm", "ehmcs", "--method", "trajectory", "--tracking", "exact", "--out", tmp_path
    )
    assert result.exit_code == 0, result.output
    solution = ak.solve(ak.catalog.ehmcs(), task.path, start=task.measured.q[0])
    expected = ak.compare(solution, task.measured)
    found = summary(tmp_path / "device_comparison.csv")
    rms = float(found["trajectory", "all_joints"]["rms"])
    assert rms == pytest.approx(np.rad2deg(expected.all_joints.rms), rel=1e-3)


def test_arms_without_a_swivel_angle_are_compared_by_the_methods_that_fit(tmp_path, monkeypatch):
    """Five joints cannot follow a hand that turns: its position is followed."""
    arm = ak.catalog.ehmcs(5)
    monkeypatch.setattr(ak, "load_arm", lambda name: arm)
    q = smooth_angles(arm, len(TIME), 3, width=0.5)
    write_joint_angles(tmp_path / "five.csv", TIME, q, arm.joint_names)
    result = run("compare", tmp_path / "five.csv", "--arm", "five", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    found = summary(tmp_path / "five_comparison.csv")
    assert {method for method, _ in found} == {"trajectory", "pro-isade"}
    assert not (tmp_path / "five_swivel_map.png").exists()
    write_joint_angles(tmp_path / "four.csv", TIME, q[:, :4], arm.joint_names[:4])
    result = run("compare", tmp_path / "four.csv", "--arm", "five", "--out", tmp_path)
    assert result.exit_code == 2
    assert f"no joint {arm.joint_names[4]}" in result.output


def test_wrong_options_are_refused_with_the_valid_ones(motion, tmp_path):
    write_marker_csv(tmp_path / "reach.csv", markers(motion))
    said = ("--side", "left", "--frame", "x forward, z up", "--out", tmp_path)
    for typed, words in (
        (("--tracking", "firm"), "valid are soft, exact"),
        (("--rom", "wide"), "valid are model, widened"),
        (("--method", "guess"), "swivel-constant"),
        (("--backend", "gpu"), "auto, c, vm"),
        (("--base", "floating"), "'fixed' or 'moving'"),
    ):
        result = run("compare", tmp_path / "reach.csv", *typed, *said)
        assert result.exit_code == 2, typed
        assert words in result.output
    assert run("compare", tmp_path / "none.trc", *said).exit_code == 2


def test_a_method_without_a_solution_does_not_hide_the_others(motion, tmp_path, monkeypatch):
    from armik_sym.comparison import predicting
    from armik_sym.errors import SolverError

    def fail(*arguments, **options):
        raise SolverError("IPOPT stopped: out of luck", "out of luck")

    monkeypatch.setattr(predicting, "solve", fail)
    write_marker_csv(tmp_path / "reach.csv", markers(motion))
    result = run(
        "compare", tmp_path / "reach.csv", "--side", "left", "--frame", "x forward, z up",
        "--method", "trajectory", "--method", "swivel-constant", "--out", tmp_path,
    )  # fmt: skip
    assert result.exit_code == 1
    assert "trajectory: no solution: IPOPT stopped: out of luck" in result.output
    assert {method for method, _ in summary(tmp_path / "reach_comparison.csv")} == {"swivel-constant"}
    assert "out of luck" in (tmp_path / "reach_comparison.txt").read_text(encoding="utf-8")
