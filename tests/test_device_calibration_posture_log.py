"""Postures taken by `armik calibrate` outlive Ctrl-C and a refused fit."""

from __future__ import annotations

from pathlib import Path

import pytest
from held_device import CTRL_C, HeldDevice, calibrate, serving
from typer.testing import CliRunner

from armik_sym.cli import app
from armik_sym.device.calibration import load_calibration
from armik_sym.device.calibration.posture_file import load_postures
from armik_sym.device.simulator import Encoder, Potentiometer


def two_joints(folder: Path) -> tuple[HeldDevice, Path]:
    return HeldDevice([Potentiometer(noise=1.0), Encoder()]), folder / "device.toml"


def test_ctrl_c_loses_no_posture_and_the_same_command_goes_on(tmp_path: Path) -> None:
    device, out = two_joints(tmp_path)
    kept = tmp_path / "device.postures.toml"
    with serving(device):
        stopped = calibrate(device, out, [("", (0.0, 0.0)), ("85", (85.0, 0.0)), (CTRL_C, ())])
        assert stopped.exit_code == 130, stopped.output
        assert f"kept in {kept}" in " ".join(stopped.output.split())
        assert [posture.name for posture in load_postures(kept).postures] == [
            "zero pose", "shoulder_abduction at 90°",
        ]  # fmt: skip
        assert not out.exists()
        done = calibrate(device, out, [("y", (85.0, 0.0)), ("", (0.0, 90.0))])
    assert done.exit_code == 0, done.output
    assert "Posture 1" not in done.output
    assert "Posture 3 of 3" in done.output
    assert load_calibration(out).joint("shoulder_abduction").quality.postures == 2
    # The file alone gives the same calibration.
    again = CliRunner().invoke(app, ["calibrate", "--from", str(kept), "--out", str(tmp_path / "again.toml")])
    assert again.exit_code == 0, again.output
    for first, second in zip(
        load_calibration(out).joints, load_calibration(tmp_path / "again.toml").joints, strict=True
    ):
        assert first.index == second.index
        assert first.scale == pytest.approx(second.scale, rel=1e-12)


def test_postures_kept_are_replaced_only_when_told(tmp_path: Path) -> None:
    device, out = two_joints(tmp_path)
    kept = tmp_path / "device.postures.toml"
    poses = [("", (0.0, 0.0)), ("", (90.0, 0.0)), ("", (0.0, 90.0))]
    with serving(device):
        calibrate(device, out, [poses[0], (CTRL_C, ())])
        calibrate(device, out, [("", (0.0, 0.0)), (CTRL_C, ())])  # neither yes nor no
        assert len(load_postures(kept).postures) == 1
        done = calibrate(device, out, [("n", (0.0, 0.0)), *poses])
        assert "Posture 1 of 3" in done.output
        assert done.exit_code == 0
        before = kept.read_bytes()
        assert calibrate(device, out, [("n", (0.0, 0.0))]).exit_code != 0
        assert kept.read_bytes() == before
        done = calibrate(device, out, [("y", (0.0, 0.0)), *poses])
        assert done.exit_code == 0, done.output
        assert kept.read_bytes() != before
        swapped = calibrate(device, out, [], "--channels", "1,0")
        assert (swapped.exit_code, "on other channels" in swapped.output) == (2, True)
    with serving(HeldDevice([Potentiometer(), Encoder()], device_id=8)) as other:
        done = calibrate(other, out, [])
    assert (done.exit_code, "are of device 7" in done.output) == (2, True)


def test_a_refused_fit_keeps_the_postures(tmp_path: Path) -> None:
    device, out = two_joints(tmp_path)
    with serving(device):
        # 9 typed instead of 90: too near to the zero pose.
        done = calibrate(device, out, [("", (0.0, 0.0)), ("9", (90.0, 0.0)), ("", (0.0, 90.0))])
    assert done.exit_code == 2
    assert "shoulder_abduction" in done.output
    kept = tmp_path / "device.postures.toml"
    kept.write_text(
        kept.read_text(encoding="utf-8").replace('"shoulder_abduction" = 9.0 ', '"shoulder_abduction" = 90 '),
        encoding="utf-8",
    )
    done = CliRunner().invoke(app, ["calibrate", "--from", str(kept), "--out", str(out)])
    assert done.exit_code == 0, done.output
