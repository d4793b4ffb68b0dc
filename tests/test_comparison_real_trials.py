"""Real trials through `armik compare`, a left and a right arm."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.comparison import predict
from benchmarks import real_trials

TRIALS = ("drink_L_ADL002_2", "drink_R_ADL002_5")


@pytest.mark.parametrize("name", TRIALS)
def test_a_trial_becomes_a_table_of_all_quantities(recordings: Path, tmp_path: Path, name: str) -> None:
    file = real_trials.write_recording(real_trials.load_trial(recordings / f"{name}.csv"), tmp_path)
    out = tmp_path / "out"
    command = [
        "compare",
        file,
        "--points",
        file.with_suffix(".toml"),
        "--method",
        "swivel-constant",
        "--out",
        out,
    ]
    result = CliRunner().invoke(app, [str(word) for word in command])
    assert result.exit_code == 0, result.output
    with (out / f"{name}_comparison.csv").open(encoding="utf-8") as text:
        found = {row["quantity"]: row for row in csv.DictReader(text)}
    assert float(found["elbow_flexion"]["max_abs"]) < 1e-6
    # These two people hold the swivel angle while they drink; a wrong side or axis would not show it.
    assert float(found["swivel"]["rms"]) < 5.0
    assert float(found["elbow_position"]["rms"]) < 15.0
    with (out / f"{name}_swivel-constant.csv").open(encoding="utf-8") as text:
        next(text)
        angles = [float(row["elbow_flexion_measured [deg]"]) for row in csv.DictReader(text)]
    recorded = np.genfromtxt(recordings / f"{name}.csv", delimiter=",", names=True)["isb_el_flex"]
    # The flexion of three points is that of the segments' own axes up to a constant of a few degrees.
    assert np.corrcoef(angles, recorded)[0, 1] > 0.99


@pytest.mark.parametrize("name", TRIALS)
def test_the_files_for_the_command_hold_the_same_motion_as_the_trial(
    recordings: Path, tmp_path: Path, name: str
) -> None:
    """Orientation as two points or as quaternions: the same joint angles."""
    trial = real_trials.load_trial(recordings / f"{name}.csv")
    assert trial.side == json.loads((recordings / f"{name}.json").read_text(encoding="utf-8"))["side"]
    file = real_trials.write_recording(trial, tmp_path)
    by_points = ak.fit_arm(ak.read_markers(file), file.with_suffix(".toml"))
    by_quaternions = trial.fit(None)
    assert by_points.side == trial.side
    np.testing.assert_allclose(by_points.unlimited.q, by_quaternions.unlimited.q, atol=np.deg2rad(0.01))


def test_a_prediction_from_the_first_posture_is_nearer_than_no_prediction(recordings: Path) -> None:
    """The hand decides most of the arm: any solution must beat a posture that does not follow it."""
    fitted = real_trials.load_trial(recordings / "reach_across_R_ADL002_2.csv").fit(None)
    measured = fitted.unlimited
    still = np.tile(measured.q[0], (len(measured), 1)) - measured.q
    c = ak.compare(predict(fitted.arm, fitted.path, measured.q[0]), measured)
    assert c.all_joints.rms < 0.5 * np.sqrt(np.mean(still**2))
    assert 1000 * c.elbow_summary.rms < 30
