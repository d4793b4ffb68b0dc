"""Drives and their files: what they mean, and what is refused."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import pytest
from servo_helpers import MOTOR

from armik_sym.arm import Arm, DHChain, DHLink, JointType, RangeOfMotion
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.errors import DriveError, UnknownNameError
from armik_sym.motion.bundled import data_folder
from armik_sym.servo import Drive, Gear, JointDrive, Motor, drives, load_drive

OWN = data_folder() / "drives" / "light_exoskeleton.toml"


def test_torques_and_speeds_arrive_at_the_joint_through_the_gear():
    gear = Gear(50.0, 0.8, 1e-5, rated_torque=12.0, peak_torque=100.0)
    joint = JointDrive("j", MOTOR, gear, 400.0, viscous=0.2, dry=0.3)
    assert joint.inertia == pytest.approx(2500 * (3e-4 + 1e-5))
    assert joint.rated_torque == 12.0  # the gear limits; the motor would give 16
    assert joint.peak_torque == pytest.approx(0.8 * 50 * 1.2)
    assert joint.top_speed == pytest.approx(min(500.0, 24.0 / 0.05) / 50)
    assert joint.stall_torque == pytest.approx(0.8 * 50 * 0.05 * 24.0 / 0.5)
    sticky = replace(joint, motor=replace(MOTOR, friction=0.01))
    assert sticky.friction == pytest.approx(0.3 + 0.8 * 50 * 0.01)


def test_the_drive_of_the_package_is_the_data_sheet():
    drive = load_drive()
    assert drives() == ("light_exoskeleton",)
    assert load_drive("light_exoskeleton") == drive
    motor = drive.joints[0].motor
    # Rows of the sheet that follow from others: no-load speed, mechanical time constant, stall torque.
    assert motor.no_load_speed * 30 / math.pi == pytest.approx(3190, rel=0.03)
    assert motor.rotor_inertia * motor.resistance / motor.torque_constant**2 == pytest.approx(
        22.3e-3, rel=0.01
    )
    assert motor.torque_constant * motor.voltage / motor.resistance == pytest.approx(4.67, rel=0.01)
    small = drive.joints[-1].motor
    assert small.rotor_inertia * small.resistance / small.torque_constant**2 == pytest.approx(
        6.35e-3, rel=0.01
    )
    assert small.top_speed == pytest.approx(10_000 * math.pi / 30)


def test_drives_find_their_joints_by_name_and_else_by_order():
    drive = load_drive()
    assert [j.name for j in drive.for_arm(human()).joints][:2] == ["shoulder_flexion", "shoulder_abduction"]
    assert len(drive.for_arm(ehmcs(4)).joints) == 4
    by_order = drive.for_arm(alfaiz())
    assert by_order.joints[3].name == "elbow_flexion"
    assert by_order.joints[0].motor == drive.joints[0].motor
    with pytest.raises(DriveError, match="none called 'a'"):
        drive.for_arm(Arm("one", DHChain((DHLink("a"),)), RangeOfMotion([-1.0], [1.0])))
    slider = Arm("slider", DHChain((DHLink("lift", joint=JointType.PRISMATIC),)), RangeOfMotion([0.0], [0.1]))
    with pytest.raises(DriveError, match=r"'lift'.*slides"):
        drive.for_arm(slider)


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("rate = 1000 ", 'rate = "fast" ', r"rate is 'fast', expected a finite number"),
        ("rate = 1000 ", "rate = 0 ", r"rate is 0\.0, expected a positive number"),
        ("delay = 0.0005", "delay = -1", r"delay is -1\.0, expected a number ≥ 0"),
        ("resistance = 0.363 ", "resistence = 0.363 ", r"motor\.ec90 has unknown key 'resistence'"),
        ("resistance = 0.363 ", "", r"motor\.ec90: resistance is missing"),
        ("peak_torque = 1.161", "peak_torque = 0.1", r"motor\.ec90: .*peak_torque is 0\.1 Nm, below rated"),
        ("efficiency = 0.7", "efficiency = 1.7", r"gear\.csf25_50: .*efficiency is 1\.7"),
        ('motor = "ec90"', 'motor = "ec91"', r"joint 1: motor is 'ec91': valid are ec45, ec90"),
        ('name = "shoulder_flexion"', 'name = "shoulder_abduction"', r"'shoulder_abduction' occurs twice"),
        ("hand = 0.2", "hand = -0.2", r"moving_mass\.hand is -0\.2, expected a number ≥ 0"),
        ("hand = 0.2", "foot = 0.2", r"moving_mass has unknown key 'foot'"),
        ("viscous = 0.05", "viscous = inf", r"joint 6\.viscous is inf, expected a finite number"),
    ],
)  # fmt: skip
def test_errors_name_file_key_and_value(tmp_path, before, after, said):
    text = OWN.read_text(encoding="utf-8")
    assert before in text
    file = tmp_path / "mine.toml"
    file.write_text(text.replace(before, after), encoding="utf-8")
    with pytest.raises(DriveError, match=f"{re.escape(str(file))}: .*{said}|{re.escape(str(file))}: {said}"):
        load_drive(file)


def test_files_that_are_missing_or_empty_are_refused(tmp_path):
    with pytest.raises(DriveError, match="no such file"):
        load_drive(tmp_path / "none.toml")
    (tmp_path / "empty.toml").write_text("rate = 1000\n", encoding="utf-8")
    with pytest.raises(DriveError, match=r"no \[\[joint\]\] rows"):
        load_drive(tmp_path / "empty.toml")
    with pytest.raises(UnknownNameError, match="light_exoskeleton"):
        load_drive("heavy_exoskeleton")
    with pytest.raises(DriveError, match="has no joints"):
        Drive("none", ())
    with pytest.raises(DriveError, match="moving_mass has unknown key 'foot'"):
        replace(load_drive(), moving_mass={"foot": 1.0})
    with pytest.raises(DriveError, match="voltage is -1"):
        Motor(-1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0)
