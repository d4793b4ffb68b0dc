"""`armik calibrate` in dialogue with a simulated device on a socket."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from held_device import HeldDevice, calibrate, serving
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.device.calibration import ScaleSource, load_calibration, tap
from armik_sym.device.simulator import Encoder, Potentiometer, SimulatedDevice, sensors_of, serve_pty
from armik_sym.motion.joint_motion import JointMotion

NAMES = ak.catalog.ehmcs(5).joint_names
ZERO = (0.0, 0.0, 0.0, 0.0, 0.0)
# Abduction, flexion, elbow, then internal rotation and pronation with the elbow bent.
POSES = [(90, 0, 0, 0, 0), (0, 90, 0, 0, 0), (0, 0, 0, 90, 0), (0, 0, 45, 90, 0), (0, 0, 0, 90, 60)]


def test_guided_calibration_recovers_the_device(tmp_path: Path) -> None:
    sensors = sensors_of(ak.catalog.ehmcs(5), seed=4)
    out = tmp_path / "device.toml"
    with serving(HeldDevice(sensors)) as device:
        typed = [("", ZERO), *(("", pose) for pose in POSES)]
        # The elbow was held at 84°, and this was measured and typed.
        typed[3] = ("84", (0, 0, 0, 84, 0))
        done = calibrate(device, out, typed)
    assert done.exit_code == 0, done.output
    assert "Posture 1 of 6: zero pose" in done.output
    assert "hang straight down" in done.output
    assert "two postures only" in done.output
    calibration = load_calibration(out)
    assert calibration.device_id == 7
    assert calibration.joint_names == NAMES
    for joint, sensor in zip(calibration.joints, sensors, strict=True):
        assert (joint.direction, joint.kind) == (sensor.direction, sensor.channel.kind)
        assert abs(joint.scale - sensor.scale) < 6 * joint.quality.scale_error
        if isinstance(sensor, Potentiometer):
            assert abs(joint.zero - sensor.zero) < 6 * joint.quality.zero_error
            assert joint.largest_step < math.radians(15)


def test_postures_that_are_not_held_as_meant_are_taken_again(tmp_path: Path) -> None:
    sensors = [
        Potentiometer(noise=1.0),
        Encoder(start=65000),
        Potentiometer(-1),
        Potentiometer(),
        Encoder(-1),
    ]
    out = tmp_path / "device.toml"
    with serving(HeldDevice(sensors)) as device:
        typed = [
            ("", ZERO),
            ("nonsense", ZERO),
            ("999", ZERO),
            ("", (5, 0, 0, 0, 0)),
            ("", (90, 0, 0, 40, 0)),
            *(("", pose) for pose in POSES),
        ]
        done = calibrate(device, out, typed)
    assert done.exit_code == 0, done.output
    assert "999° is no angle of a joint" in done.output
    assert "was to move by 90°, but the sensor on channel 0 moved by about 5°" in done.output
    assert "elbow_flexion moved by about 40° as well since posture 'zero pose'" in done.output
    assert load_calibration(out).joint("elbow_flexion").quality.postures == 2


def test_an_arm_that_trembles_is_given_up_after_four_attempts(tmp_path: Path) -> None:
    device = HeldDevice([Potentiometer(), Encoder(), Potentiometer()])
    device.shaking_deg = 4.0
    with serving(device):
        done = calibrate(device, tmp_path / "a.toml", [("", ZERO[:3])] * 4, "--channels", "0,1,2")
    assert done.exit_code == 2
    assert done.output.count("Not taken") == 4
    assert "was not" in done.output
    assert "given up after 4 attempts" in done.output
    assert not list(tmp_path.iterdir())


def test_joint_on_another_channel_and_thorough(tmp_path: Path) -> None:
    sensors = [Potentiometer(), Potentiometer(-1)]
    poses = [(0.0, 0.0), (0.0, 90.0), (0.0, 45.0), (90.0, 0.0), (45.0, 0.0)]
    with serving(HeldDevice(sensors)) as device:
        done = calibrate(
            device, tmp_path / "a.toml", [("", pose) for pose in poses], "--channels", "1,0", "--thorough"
        )
    assert done.exit_code == 0, done.output
    calibration = load_calibration(tmp_path / "a.toml")
    assert [(joint.channel, joint.direction) for joint in calibration.joints] == [(1, -1), (0, 1)]
    assert [joint.quality.postures for joint in calibration.joints] == [3, 3]
    assert all(joint.quality.residual_max < math.radians(0.2) for joint in calibration.joints)


def test_zero_pose_only_and_zeros_after_power_up(tmp_path: Path) -> None:
    old, new = tmp_path / "old.toml", tmp_path / "new.toml"
    with serving(HeldDevice([Potentiometer(-1, noise=1.0), Encoder(start=50)])) as device:
        done = calibrate(device, old, [("", (0.0, 0.0))], "--datasheet", "-,+")
    assert done.exit_code == 0, done.output
    assert "scale and direction as given, not measured" in done.output
    first = load_calibration(old)
    assert [joint.scale_source for joint in first.joints] == [ScaleSource.GIVEN] * 2
    assert first.joints[1].zero == 50
    with serving(HeldDevice([Potentiometer(-1, noise=1.0), Encoder(start=700)])) as device:
        done = calibrate(device, new, [("", (0.0, 0.0))], "--zero", str(old))
    assert done.exit_code == 0, done.output
    second = load_calibration(new)
    assert second.joints[0] == first.joints[0]
    assert second.joints[1].zero == 700
    with serving(HeldDevice([Potentiometer(-1), Encoder()], device_id=8)) as device:
        done = calibrate(device, new, [], "--zero", str(old))
    assert done.exit_code == 2
    assert "belongs to device 7" in done.output


def test_index_passed_on_the_way_is_kept(tmp_path: Path) -> None:
    sensor = Encoder(1, mounting=-0.5, start=1000)
    with serving(HeldDevice([sensor])) as device:
        done = calibrate(device, tmp_path / "a.toml", [("", (0.0,)), ("", (90.0,))])
    assert done.exit_code == 0, done.output
    joint = load_calibration(tmp_path / "a.toml").joints[0]
    assert joint.index is not None
    # The index lies half a radian above the zero pose.
    assert (joint.index - joint.zero) * joint.scale == pytest.approx(0.5, abs=0.01)


def test_wrong_use(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tap, "WAIT_FOR_FRAMES", 0.3)
    out = str(tmp_path / "a.toml")
    for arguments, said in (
        (["--out", out], "give either --port"),
        (["--out", out, "--from", "a", "--port", "b"], "give either --port"),
        (["--out", out, "--from", "a", "--zero", "b"], "go with --port"),
        (["--out", out, "--port", "a", "--zero", "b", "--datasheet", "+"], "exclude each other"),
        (["--out", out, "--port", "a", "--seconds", "0"], "--seconds is 0"),
        (["--out", out, "--port", "loop://"], "no byte came"),
        (["--out", out, "--port", "/dev/not-there"], "no such port"),
        (["--out", out, "--port", "loop://", "--channels", "a"], "expected whole numbers"),
        (["--out", str(tmp_path / "x" / "a"), "--port", "loop://"], "there is no folder"),
        (["--out", out, "--from", "not-there.toml"], "no such file"),
    ):
        done = CliRunner().invoke(app, ["calibrate", *arguments])
        assert (done.exit_code, said in done.output) == (2, True), done.output
    with serving(HeldDevice([Potentiometer(), Encoder()])) as device:
        for options, said in (
            (["--datasheet", "+"], "expected 2 signs"),
            (["--channels", "0,0"], "channels 0, 0: expected different ones"),
        ):
            done = calibrate(device, Path(out), [], *options)
            assert (done.exit_code, said in done.output) == (2, True), done.output
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals")
def test_on_a_pseudo_terminal(tmp_path: Path) -> None:
    sensors = (Potentiometer(-1, noise=6.0), Encoder(start=40))
    motion = JointMotion(np.array([0.0]), np.zeros((1, 2)), NAMES[:2])
    out = tmp_path / "a.toml"
    with serve_pty(SimulatedDevice(motion, sensors, device_id=5)) as served:
        arguments = ["calibrate", "--port", served.port, "--out", str(out), "--datasheet", "-,+"]
        done = CliRunner().invoke(app, [*arguments, "--seconds", "0.5"], input="\n")
    assert done.exit_code == 0, done.output
    first, second = load_calibration(out).joints
    assert abs(first.zero - sensors[0].zero) < 6 * first.quality.zero_error
    assert (second.zero, second.quality.samples) == (40, 250)
