"""`armik solve` on recordings: markers of an arm that is known, and joint angles, in every form of file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from anatomy import HAND
from synthetic_markers import FRAME, LENGTHS, POINTS, Known, known_markers
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.cli import app
from armik_sym.motion.marker_recording import MarkerRecording

SAMPLES = 120
ELBOW_FLEXION = 3


def run(*arguments: object):
    return CliRunner().invoke(app, ["solve", *map(str, arguments)])


def write_points(folder: Path, side: str) -> Path:
    lines = [f'side = "{side}"', f'frame = "{FRAME}"', "[points]"]
    lines += [f"{point} = {json.dumps(names)}" for point, names in POINTS.items()]
    file = folder / "points.toml"
    file.write_text("\n".join(lines), encoding="utf-8")
    return file


def write_bvh_of_points(file: Path, recording: MarkerRecording) -> None:
    """Every marker a joint of its own that is moved by positions, in centimetres."""
    channels = "OFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition"
    joints = "\n".join(
        f"JOINT {name}\n{{\n{channels}\nEnd Site\n{{\nOFFSET 0 0 0\n}}\n}}" for name in recording.names
    )
    rows = [
        " ".join(repr(100 * x) for x in [0.0, 0.0, 0.0, *row.ravel().tolist()]) for row in recording.position
    ]
    head = (
        f"HIERARCHY\nROOT room\n{{\n{channels}\n{joints}\n}}\nMOTION\nFrames: {len(rows)}\nFrame Time: 0.01"
    )
    file.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


def write(file: Path, form: str, recording: MarkerRecording) -> list[object]:
    """Write markers in a form; what has to be typed to read them again."""
    if form == "bvh":
        write_bvh_of_points(file, recording)
        return ["--unit", "cm"]
    if form == "c3d":
        pytest.importorskip("ezc3d", reason="writing c3d needs ezc3d")
    ak.write_markers(file, recording, nexus=form == "nexus")
    return []


def saved(folder: Path, stem: str) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    with np.load(folder / f"{stem}_solution.npz") as file:
        arrays = {name: file[name] for name in file.files}
    return arrays, json.loads(str(arrays["record"]))


def said(result) -> str:
    return " ".join(result.output.split())


@pytest.fixture(scope="module", params=["left", "right"])
def known(request) -> tuple[Known, str]:
    return known_markers(request.param, n=SAMPLES), request.param


@pytest.mark.parametrize(
    ("form", "name", "digits"),
    [
        ("trc", "me.trc", 1e-9),
        ("csv", "me.csv", 1e-9),
        ("nexus", "me.csv", 1e-9),
        ("bvh", "me.bvh", 1e-9),
        ("c3d", "me.c3d", 2e-5),
    ],
)
def test_markers_become_the_arm_they_were_made_from_and_a_trajectory(known, form, name, digits, tmp_path):
    truth, side = known
    options = write(tmp_path / name, form, truth.recording)
    points = write_points(tmp_path, side)
    result = run(
        tmp_path / name, "--points", points, "--tracking", "exact", "--start", "recorded", *options,
        "--out", tmp_path / "out",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    arm = ak.load_arm(tmp_path / "out" / "me_arm.toml")
    assert dict(arm.lengths) == pytest.approx(LENGTHS, abs=digits)
    arrays, record = saved(tmp_path / "out", "me")
    q, (position, rotation) = arrays["q"], hand_pose(truth.arm.chain, truth.q, truth.arm.lengths)
    np.testing.assert_allclose(arrays["path_position"], position, atol=10 * digits)
    np.testing.assert_allclose(arrays["path_rotation"], rotation, atol=1e3 * digits)
    # The same hand and lengths leave the elbow no choice; the rest is free but for the recorded start.
    np.testing.assert_allclose(q[:, ELBOW_FLEXION], truth.q[:, ELBOW_FLEXION], atol=1e3 * digits)
    np.testing.assert_allclose(q[0], truth.q[0], atol=1e4 * digits)
    solved = joint_frames(arm.chain, q, arm.lengths)[:, HAND, :3, 3]
    np.testing.assert_allclose(solved, truth.hand, atol=10 * digits + 1e-8)
    # A right arm is mirrored, and everything written says so.
    text = (tmp_path / "out" / "me_fit.txt").read_text(encoding="utf-8")
    for words in (record["note"], record["arm_description"], arm.description, text, said(result)):
        assert f"{side} arm" in words
        assert ("mirrored" in words) == (side == "right")
    assert "upper arm 301.0 mm" in said(result)
    assert record["settings"]["tracking"] == "exact"


def test_markers_are_tracked_softly_and_noise_is_no_error(tmp_path):
    """With noise of 1 mm on every marker; the same options as `armik compare` has reach the fit."""
    truth = known_markers("left", n=SAMPLES, noise=1e-3)
    ak.write_markers(tmp_path / "noisy.trc", truth.recording)
    points = write_points(tmp_path, "left")
    result = run(
        tmp_path / "noisy.trc", "--points", points, "--cutoff", 6, "--fill", 0.1, "--base", "moving",
        "--begin", 0.1, "--end", 1.0, "--rom", "widened", "--backend", "vm", "--figures", "--out", tmp_path,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    arrays, record = saved(tmp_path, "noisy")
    assert record["settings"]["tracking"] == "soft"
    assert "tracking soft, because markers are noisy" in said(result)
    assert "the recorded posture was not used" in said(result)
    assert "low-pass filtered at 6 Hz" in said(result)
    assert "moving base" in record["note"]
    np.testing.assert_allclose(arrays["time"][[0, -1]], [0.1, 1.0], atol=1e-9)
    assert 0 < arrays["position_error"].max() < 0.01
    first = round(100 * arrays["time"][0])
    expected = truth.q[first : first + len(arrays["q"]), ELBOW_FLEXION]
    np.testing.assert_allclose(arrays["q"][:, ELBOW_FLEXION], expected, atol=np.deg2rad(3))
    for ending in ("joints", "hand", "swivel_map"):
        assert (tmp_path / f"noisy_{ending}.png").stat().st_size > 1000


def test_the_fitted_arm_is_an_arm_like_any_other(tmp_path):
    """Its file solves the path of its hand again, to the same angles."""
    truth = known_markers("right", n=SAMPLES)
    ak.write_markers(tmp_path / "me.trc", truth.recording)
    typed = ["--points", write_points(tmp_path, "right"), "--tracking", "exact", "--out", tmp_path / "one"]
    assert run(tmp_path / "me.trc", *typed).exit_code == 0
    one, _ = saved(tmp_path / "one", "me")
    path = ak.HandPath(one["time"], one["path_position"], one["path_rotation"])
    ak.write_path(tmp_path / "me.csv", path)
    result = run(tmp_path / "me.csv", "--arm", tmp_path / "one" / "me_arm.toml", "--out", tmp_path / "two")
    assert result.exit_code == 0, result.output
    two, _ = saved(tmp_path / "two", "me")
    np.testing.assert_allclose(two["q"], one["q"], atol=1e-6)


def test_an_arm_that_was_typed_gives_limits_and_on_request_lengths(tmp_path):
    """A patient who cannot rotate the shoulder far; the lengths are those of the person, or those typed."""
    truth = known_markers("left", n=SAMPLES)
    ak.write_markers(tmp_path / "me.trc", truth.recording)
    (tmp_path / "patient.toml").write_text(
        'arm = "human"\nangle_unit = "deg"\nlength_unit = "mm"\n[lengths]\nupper_arm = 310\nforearm = 255\n'
        "hand = 80\n[range_of_motion]\nshoulder_internal_rotation = [-40, 30]\n",
        encoding="utf-8",
    )
    points = write_points(tmp_path, "left")
    typed = [tmp_path / "me.trc", "--points", points, "--arm", tmp_path / "patient.toml"]
    for lengths, upper_arm in ((None, 0.301), ("fitted", 0.301), ("arm", 0.31)):
        out = tmp_path / f"out_{lengths}"
        result = run(*typed, *(["--lengths", lengths] if lengths else []), "--out", out)
        assert result.exit_code == 0, result.output
        arrays, record = saved(out, "me")
        assert record["lengths_m"]["upper_arm"] == pytest.approx(upper_arm, abs=1e-9)
        assert np.rad2deg([arrays["lower"][2], arrays["upper"][2]]) == pytest.approx([-40, 30])
        assert (out / "me_arm.toml").exists() == (lengths != "arm")
        assert (out / "me_fit.txt").exists()
    assert "segment lengths of arm human: those it came with" in said(result)


@pytest.mark.parametrize("ending", ["csv", "mot", "sto"])
def test_joint_angles_become_the_path_of_the_hand_and_are_solved_anew(ending, tmp_path):
    task, file = ak.load_task("drinking_reach"), tmp_path / f"device.{ending}"
    ak.write_motion(file, task.measured)
    arm = ak.catalog.ehmcs()
    for start in (None, "recorded"):
        out = tmp_path / f"out_{start}"
        result = run(file, "--arm", "ehmcs", *(["--start", start] if start else []), "--out", out)
        assert result.exit_code == 0, result.output
        arrays, record = saved(out, "device")
        np.testing.assert_allclose(arrays["path_position"], task.path.position, atol=1e-9)
        first = None if start is None else task.measured.q[0]
        np.testing.assert_allclose(arrays["q"], ak.solve(arm, task.path, start=first).q, atol=1e-5)
        assert ("the recorded posture was not used" in said(result)) == (start is None)
        assert "hand of arm ehmcs in device" in record["note"]
        assert not (out / "device_arm.toml").exists()
    np.testing.assert_allclose(arrays["q"][0], task.measured.q[0], atol=1e-6)


def test_of_an_arm_with_few_joints_the_position_is_followed(tmp_path):
    arm = ak.catalog.ehmcs(5)
    ak.save_arm(arm, tmp_path / "five.toml")
    t = np.linspace(0, 2, 60)
    q = arm.rom.middle + 0.3 * arm.rom.width * np.sin(t[:, None] + np.arange(5)) * 0.5
    ak.write_motion(tmp_path / "angles.mot", ak.JointMotion(t, q, arm.joint_names))
    result = run(tmp_path / "angles.mot", "--arm", tmp_path / "five.toml", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    arrays, _ = saved(tmp_path, "angles")
    assert arrays["path_rotation"].size == 0
    reached = hand_pose(arm.chain, arrays["q"], arm.lengths)[0]
    np.testing.assert_allclose(reached, hand_pose(arm.chain, q, arm.lengths)[0], atol=1e-6)
    assert "of the recorded angles the position of the hand" in said(result)


def test_compare_fits_the_same_arm_as_solve(tmp_path):
    """One meaning of the options, --arm among them: the exoskeleton has no length of the hand."""
    truth = known_markers("left", n=SAMPLES)
    ak.write_markers(tmp_path / "me.trc", truth.recording)
    typed = [tmp_path / "me.trc", "--points", write_points(tmp_path, "left"), "--arm", "ehmcs"]
    result = run(*typed, "--out", tmp_path / "solved")
    assert result.exit_code == 0, result.output
    (report, _, _) = (tmp_path / "solved" / "me_fit.txt").read_text(encoding="utf-8").partition("note:")
    compared = CliRunner().invoke(
        app,
        ["compare", *map(str, typed), "--method", "swivel-constant", "--out", str(tmp_path / "compared")],
    )
    assert compared.exit_code == 0, compared.output
    assert report.partition("\n")[2].strip() in compared.output
    assert ak.load_arm(tmp_path / "solved" / "me_arm.toml").name == "ehmcs"


def test_a_fitted_arm_goes_on_as_urdf_and_toml(tmp_path):
    arm = ak.catalog.human(0.29, 0.24, 0.07)
    ak.save_arm(arm, tmp_path / "me_arm.toml")
    for target in ("me.urdf", "copy.toml"):
        done = CliRunner().invoke(app, ["convert", str(tmp_path / "me_arm.toml"), str(tmp_path / target)])
        assert done.exit_code == 0, done.output
    assert dict(ak.load_arm(tmp_path / "copy.toml").lengths) == pytest.approx(dict(arm.lengths))
    assert (tmp_path / "me.urdf").read_text(encoding="utf-8").count('type="revolute"') == 7
