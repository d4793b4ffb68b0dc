"""Recordings of a device as input of other commands: `armik convert`, `armik solve`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from armik_sym.cli.console import say
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.motion.hand_path import HandPath
    from armik_sym.motion.joint_motion import JointMotion

ENDING = ".armikrec"


def is_device_recording(file: Path) -> bool:
    """Whether a file is a recording of a device, by its ending.

    Args:
        file: The file.

    Returns:
        True for `.armikrec`.

    Source:
        None (docs/device.md).
    """
    return file.suffix.lower() == ENDING


def device_motion(source: Path, calibration: Path | None = None) -> JointMotion:
    """Joint angles of a recording, all samples.

    Args:
        source: The recording.
        calibration: Calibration of the device; None: the one in the recording.

    Returns:
        The angles.

    Raises:
        CalibrationError: If there is no calibration, or it is another device's.
        MotionFileError: If the recording cannot be read.

    Source:
        None (this package).
    """
    from armik_sym.device.calibration import load_calibration
    from armik_sym.device.recording import read_recording

    chosen = None if calibration is None else load_calibration(calibration)
    return read_recording(source).angles(chosen)


def device_hand_path(
    source: Path, arm: Arm, calibration: Path | None = None, rate: float = 100.0, cutoff_hz: float = 6.0
) -> HandPath:
    """The path of the hand that a device measured: its angles, smooth and even, through the arm.

    Args:
        source: The recording.
        arm: The arm; joints that are not measured stay at 0.
        calibration: Calibration of the device; None: the one in the recording.
        rate: Samples per second of the path, in [Hz].
        cutoff_hz: Low-pass filter of the angles, in [Hz].

    Returns:
        The path, with rotations.

    Raises:
        CalibrationError: If there is no calibration, it is another device's, or a joint is none of the arm's.
        MotionFileError: If the recording cannot be read.

    Source:
        Nguyen 2021, §2.1 (the endpoint from measured angles), eq. 2.
    """
    from armik_sym.arm.product_of_transforms import hand_pose
    from armik_sym.device.angles import full_posture
    from armik_sym.device.recording import even_motion
    from armik_sym.motion.hand_path import HandPath

    motion = even_motion(device_motion(source, calibration), rate, cutoff_hz)
    position, rotation = hand_pose(arm.chain, full_posture(arm, motion.joint_names, motion.q), arm.lengths)
    return HandPath(motion.time, position, rotation, note=f"measured by a device, {source.name}")


def hand_path(source: Path, arm: Arm, calibration: Path | None = None) -> HandPath:
    """The path of the hand in a file: a hand path, or what a device measured.

    Args:
        source: The file.
        arm: The arm that was measured.
        calibration: Calibration of the device, for recordings only; None: the one in the recording.

    Returns:
        The path.

    Raises:
        OptionError: If a calibration is given with a hand path.
        CalibrationError: If there is no calibration, it is another device's, or a joint is none of the arm's.
        PathError: If a hand path is none.
        MotionFileError: If a recording cannot be read.

    Source:
        None (command line).
    """
    if is_device_recording(source):
        return device_hand_path(source, arm, calibration)
    if calibration is not None:
        raise OptionError(f"--calibration is for recordings of a device ({ENDING}), {source} is none")
    from armik_sym.motion import read_path

    return read_path(source)


def convert_device_recording(source: Path, target: Path, calibration: Path | None = None) -> None:
    """Write the joint angles of a recording as `.csv`, `.mot` or `.sto`, and say so.

    Args:
        source: The recording.
        target: The file to write.
        calibration: Calibration of the device; None: the one in the recording.

    Raises:
        OptionError: If the target has another ending.
        CalibrationError: If there is no calibration, or it is another device's.
        MotionFileError: If a file cannot be read or written.

    Source:
        None (this package).
    """
    from armik_sym.motion.read_motion import write_motion

    if target.suffix.lower() not in (".csv", ".mot", ".sto"):
        raise OptionError(f"{target}: joint angles of a device are written as .csv, .mot or .sto")
    motion = device_motion(source, calibration)
    write_motion(target, motion)
    say(f"{target}: {motion!r}")
