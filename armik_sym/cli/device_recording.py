"""Recordings of a device as input of other commands: `armik convert`, `solve`, `compare`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from armik_sym.cli.console import say
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
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


def even_postures(
    source: Path, arm: Arm, calibration: Path | None = None, rate: float = 100.0, cutoff_hz: float = 6.0
) -> JointMotion:
    """Postures of an arm that a device measured, smooth and even.

    Args:
        source: The recording.
        arm: The arm; joints that are not measured stay at 0.
        calibration: Calibration of the device; None: the one in the recording.
        rate: Samples per second, in [Hz].
        cutoff_hz: Low-pass filter of the angles, in [Hz].

    Returns:
        Angles of all joints, over the longest stretch without a gap.

    Raises:
        CalibrationError: If there is no calibration, it is another device's, or a joint is none of the arm's.
        MotionFileError: If the recording cannot be read.

    Source:
        None (this package).
    """
    from armik_sym.device.angles import full_posture
    from armik_sym.device.recording import even_motion
    from armik_sym.motion.joint_motion import JointMotion

    motion = even_motion(device_motion(source, calibration), rate, cutoff_hz)
    return JointMotion(motion.time, full_posture(arm, motion.joint_names, motion.q), arm.joint_names)


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
