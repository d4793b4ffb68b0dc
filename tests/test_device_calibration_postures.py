"""Calibration from files: postures in TOML, in a CSV table, and in recordings."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from armik_sym.cli import app
from armik_sym.device.calibration import fit_calibration, load_calibration
from armik_sym.device.calibration.posture_file import load_postures
from armik_sym.device.protocol import encode_info, encode_sample
from armik_sym.device.simulator import Encoder, Potentiometer, SimulatedDevice
from armik_sym.errors import CalibrationError
from armik_sym.motion.joint_motion import JointMotion

HEAD = """format = "armik postures 1"
device_id = 9
angle_unit = "deg"
[[channel]]
sensor = "potentiometer"
span_counts = 4096
[[channel]]
sensor = "encoder"
span_counts = 4000
"""
POSTURES = """[[posture]]
name = "zero pose"
angles = { shoulder_abduction = 0, shoulder_flexion = 0 }
counts = [[2000, 65000], [2001, 65000]]
[[posture]]
name = "lifted"
angles = { shoulder_abduction = 90.0 }
counts = [3068, 65000]
[[posture]]
name = "forwards"
angles = { shoulder_flexion = 90.0 }
counts = [2000, 464]
"""
TABLE = """# from the lab book
posture,shoulder_abduction,shoulder_flexion,channel_0,channel_1
zero pose,0,0,2000,65000
zero pose,0,0,2001,65000
lifted,90,,3068,65000
forwards,,90,2000,464
"""


def write(folder: Path, text: str) -> Path:
    file = folder / "postures.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_toml_and_csv_say_the_same(tmp_path: Path) -> None:
    plain = load_postures(write(tmp_path, HEAD + POSTURES))
    (tmp_path / "p.csv").write_text(TABLE, encoding="utf-8")
    tabled = load_postures(write(tmp_path, 'table = "p.csv"\n' + HEAD))
    assert plain.info == tabled.info
    assert plain.setups == tabled.setups
    assert [setup.joint for setup in plain.setups] == ["shoulder_abduction", "shoulder_flexion"]
    made = [fit_calibration(each.info, each.postures, each.setups, date="now") for each in (plain, tabled)]
    assert made[0] == made[1]
    flexion = made[0].joint("shoulder_flexion")
    # From 65000 over the overflow to 464 are 1,000 counts: a quarter of a turn.
    assert flexion.scale == pytest.approx(2 * math.pi / 4000)
    assert (flexion.direction, flexion.zero) == (1, pytest.approx(65000))


def test_command_with_joints_given(tmp_path: Path) -> None:
    joints = """[[joint]]
name = "elbow"
channel = 0
scale_rad_per_count = 0.0015
direction = -1
[[posture]]
name = "zero"
angles = { elbow = 0 }
counts = [1500, 0]
"""
    out = tmp_path / "out.toml"
    file = write(tmp_path, HEAD + joints)
    done = CliRunner().invoke(app, ["calibrate", "--from", str(file), "--out", str(out)])
    assert done.exit_code == 0, done.output
    (joint,) = load_calibration(out).joints
    assert (joint.joint, joint.zero, joint.scale, joint.direction) == ("elbow", 1500, 0.0015, -1)
    assert "scale and direction as given" in done.output


def test_refusal_reaches_the_command_line_and_nothing_is_written(tmp_path: Path) -> None:
    file = write(tmp_path, HEAD + POSTURES.replace("shoulder_abduction = 90.0", "shoulder_abduction = 10"))
    done = CliRunner().invoke(app, ["calibrate", "--from", str(file), "--out", str(tmp_path / "out.toml")])
    assert done.exit_code == 2
    assert "'shoulder_abduction' has to be moved" in done.output
    assert not (tmp_path / "out.toml").exists()


def test_recordings_with_postures(tmp_path: Path) -> None:
    sensors = (Potentiometer(-1, noise=1.0), Encoder(1, mounting=-0.5))
    truth = np.radians([[0, 0], [0, 0], [90, 80], [90, 80]])
    names = ("shoulder_abduction", "shoulder_flexion")
    motion = JointMotion(np.array([0.0, 1.0, 3.0, 5.0]), truth, names)
    device = SimulatedDevice(motion, sensors, device_id=9, rate=100)
    samples = itertools.islice(device.samples(), 450)
    stream = encode_info(device.info) + b"".join(encode_sample(sample) for sample in samples)
    (tmp_path / "both.armikrec").write_bytes(stream)
    text = """format = "armik postures 1"
angle_unit = "deg"
[[posture]]
name = "zero"
angles = { shoulder_abduction = 0, shoulder_flexion = 0 }
recording = "both.armikrec"
seconds = [0.0, 0.9]
[[posture]]
name = "both up"
angles = { shoulder_abduction = 90, shoulder_flexion = 80 }
recording = "both.armikrec"
seconds = [3.1, 4.4]
"""
    read = load_postures(write(tmp_path, text))
    assert read.info.device_id == 9
    calibration = fit_calibration(read.info, read.postures, read.setups)
    for joint, sensor in zip(calibration.joints, sensors, strict=True):
        assert joint.direction == sensor.direction
        assert abs(joint.scale - sensor.scale) < 6 * joint.quality.scale_error
    index = calibration.joint("shoulder_flexion")
    assert index.index is not None
    assert (index.index - index.zero) * index.scale == pytest.approx(0.5, abs=0.01)
    with pytest.raises(CalibrationError, match=r"line 7: seconds|it has no sample there"):
        load_postures(write(tmp_path, text.replace("[0.0, 0.9]", "[9, 10]")))
    wrong = (
        text.replace('angle_unit = "deg"\n', 'angle_unit = "deg"\ndevice_id = 8\n')
        + HEAD[HEAD.index("[[channel") :]
    )
    with pytest.raises(CalibrationError, match="the recordings are of device 9"):
        load_postures(write(tmp_path, wrong))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('format = "armik postures 1"', "", "line 1: format is missing"),
        (
            'angle_unit = "deg"',
            'angle_unit = "grad"',
            'line 3: angle_unit is \'grad\': expected "deg" or "rad"',
        ),
        ("device_id = 9", 'device_id = "9"', "line 2: device_id is '9'"),
        ("span_counts = 4096", "span_counts = 0", "line 6: span_counts is 0"),
        ('sensor = "encoder"', 'sensor = "x"', "line 8: sensor is 'x'"),
        ("counts = [3068, 65000]", "", "line 14: counts is missing: expected either counts or a recording"),
        ("counts = [3068, 65000]", "counts = [3068.5, 65000]", "line 17: posture 'lifted': counts"),
        ("counts = [3068, 65000]", "counts = [3068]", "posture 'lifted' has counts of 1 channels"),
        ("counts = [3068, 65000]", "counts = 3", "line 17: posture 'lifted': counts"),
        ("{ shoulder_abduction = 90.0 }", "{ shoulder_abduction = true }", "line 16: angles is"),
        ("{ shoulder_abduction = 90.0 }", "90", "line 16: angles is 90"),
        ("device_id = 9", 'device_id = 9\narm = "x"', "line 3: arm is 'x': unknown arm"),
        ("counts = [3068, 65000]", "index = 3\ncounts = [3068, 65000]", "line 17: index is 3: expected { ch"),
        ("counts = [3068, 65000]", "index = { a = 3 }\ncounts = [3068, 65000]", "line 17: index is {'a': 3}"),
        ("counts = [3068, 65000]", "index = { 1 = 70000 }\ncounts = [3068, 65000]", "index is {'1':"),
        ("device_id = 9", "device_id = 9\nrate = 5", "line 3: rate is 5: unknown key"),
        ("device_id = 9", "device_id = 9\nrate_hz = 0", "line 3: rate_hz is 0"),
    ],
)
def test_errors_name_the_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = HEAD + POSTURES
    assert old in text
    file = write(tmp_path, text.replace(old, new, 1))
    with pytest.raises(CalibrationError) as caught:
        load_postures(file)
    assert str(caught.value).startswith(f"{file}: ")
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("3068,65000", "x,65000", "line 5, column channel_0: 'x' is no number"),
        ("3068,65000", "3068,65000,1", "line 5: 6 values, expected 5"),
        ("3068,65000", "3068,-1", "line 5, column channel_1: '-1', expected a whole number"),
        ("zero pose,0,0,2001", "zero pose,1,0,2001", "line 4: posture 'zero pose' has other angles"),
        ("channel_1", "channel_2", "line 2: columns"),
        (TABLE, "", "the file is empty"),
    ],
)
def test_errors_in_a_table_name_the_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    table = tmp_path / "p.csv"
    table.write_text(TABLE.replace(old, new, 1), encoding="utf-8")
    file = write(tmp_path, 'table = "p.csv"\n' + HEAD)
    with pytest.raises(CalibrationError) as caught:
        load_postures(file)
    assert str(caught.value).startswith(f"{table}: ")
    assert said in str(caught.value)


def test_no_postures_at_all(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="posture is missing"):
        load_postures(write(tmp_path, HEAD))
