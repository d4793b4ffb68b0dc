"""From a recording to an arm, the path of its hand, and the measured angles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

from armik_sym.cli.device_recording import even_postures, is_device_recording
from armik_sym.cli.marker_points import check_points, own_names
from armik_sym.cli.option_checks import number_or_word, only
from armik_sym.cli.recording_options import RecordingOptions
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.fitting import FittedArm
    from armik_sym.motion.file_kind import Kind
    from armik_sym.motion.hand_path import HandPath
    from armik_sym.motion.joint_motion import JointMotion

DEVICE_ARM = "ehmcs"
_ENOUGH_FOR_POSES = 6
# In the torso a shoulder moves by up to about 0.02 m (standard deviation): more is a person who moves along.
_MOVED_ALONG = 0.03


class Recorded(NamedTuple):
    """What a person did, as motion of an arm.

    Attributes:
        name: Name of the recording.
        arm: The arm.
        path: What the hand did.
        measured: What the joints did, as it is: limits do not bend it.
        fitted: The fit to markers; None where the joint angles were recorded.
    """

    name: str
    arm: Arm
    path: HandPath
    measured: JointMotion
    fitted: FittedArm | None = None

    @property
    def report(self) -> str:
        """How good the fit is, in lines of text; empty if nothing was fitted."""
        return "" if self.fitted is None else str(self.fitted)

    @property
    def notes(self) -> tuple[str, ...]:
        """What to know of the recording, one sentence each."""
        if self.fitted is None or self.fitted.base == "moving":
            return ()
        moved = float(self.fitted.shoulder_sd.max())
        if moved < _MOVED_ALONG:
            return ()
        return (
            f"the shoulder moved (sd {1000 * moved:.0f} mm), the arm stands still: --base moving follows it",
        )


def kind_of(file: Path) -> Kind | Literal["device"]:
    """What a file holds; one whose ending says nothing is read as a hand path.

    Args:
        file: The file.

    Returns:
        "markers", "motion" (joint angles), "device" (what a device sent) or "path" (of the hand).

    Raises:
        MotionFileError: If it is missing or has no header.

    Source:
        None (command line).
    """
    from armik_sym.motion.file_kind import file_kind
    from armik_sym.motion.read_markers import MARKER_FILES
    from armik_sym.motion.read_motion import MOTION_FILES

    if is_device_recording(file):
        return "device"
    return file_kind(file) if file.suffix.lower() in (*MARKER_FILES, *MOTION_FILES) else "path"


def read_recorded(
    file: Path,
    kind: Kind | Literal["device"],
    arm: str | None,
    options: RecordingOptions,
    calibration: Path | None = None,
) -> Recorded:
    """What a person did, from markers, joint angles or what a device sent.

    Args:
        file: The recording.
        kind: "markers", "motion" or "device".
        arm: Name or file of the arm; of markers the kind of arm to fit, human if None; of a device ehmcs.
        options: What was typed about markers.
        calibration: Calibration of the device, if typed.

    Returns:
        Arm, path and measured angles.

    Raises:
        OptionError: If options do not go with the file, or one that it needs is missing.

    Source:
        None (command line).
    """
    if kind != "device" and calibration is not None:
        raise OptionError(f"--calibration is for recordings of a device, {file} is none")
    if kind == "markers":
        return from_markers(file, arm, options)
    only(f"{file}: it holds joint angles, and the option is about markers", options.typed)
    if kind == "device":
        return from_device(file, arm or DEVICE_ARM, calibration)
    if arm is None:
        raise OptionError(
            f"{file} holds joint angles: say of which arm, as in --arm ehmcs or --arm my_arm.toml, to know "
            "what the hand did"
        )
    return from_angles(file, arm)


def from_markers(file: Path, arm: str | None, options: RecordingOptions) -> Recorded:
    """Fit an arm to recorded markers.

    Args:
        file: The recording.
        arm: Name or file of the kind of arm to fit; human if None.
        options: What was typed about markers.

    Returns:
        Arm, path and measured angles; arm and path say whose they are, and if they are mirrored.

    Raises:
        OptionError: If an option has another value, or no markers have the names of the points.

    Source:
        None (command line).
    """
    import armik_sym as ak

    if options.rom not in (None, "model", "widened"):
        raise OptionError(f"--rom is {options.rom!r}: valid are model, widened")
    kind = None if arm is None else ak.load_arm(arm)
    if options.points is not None:
        check_points(options.points)
    recording = ak.read_markers(file, number_or_word(options.unit))
    fitted = ak.fit_arm(
        recording,
        own_names(recording) if options.points is None else options.points,
        options.side,
        options.frame,
        base=options.base or "fixed",
        arm=kind,
        rom="widened" if options.rom == "widened" else None,
        cutoff_hz=options.cutoff,
        fill_gaps=options.fill,
        start=options.begin,
        end=options.end,
    )
    mirrored = ", mirrored to a left arm" if fitted.mirrored else ""
    whose = f"fitted to the {fitted.side} arm of {file.name}{mirrored}"
    model = replace(fitted.arm, description=f"{whose}; {fitted.arm.description}")
    path = replace(fitted.path, note=f"{fitted.path.note}{mirrored}")
    return Recorded(file.name, model, path, fitted.unlimited, fitted)


def from_angles(file: Path, arm: str) -> Recorded:
    """Take recorded joint angles of a known arm, as of an exoskeleton; the hand path follows from them.

    Args:
        file: The recording.
        arm: Name of the arm, or its file.

    Returns:
        Arm, path and measured angles; of arms with fewer than six joints the position of the hand alone.

    Raises:
        OptionError: If joints of the arm were not recorded.

    Source:
        Nguyen 2021, §4 (measured angles and end points of an exoskeleton).
    """
    import armik_sym as ak

    model, motion = ak.load_arm(arm), ak.read_motion(file)
    missing = [name for name in model.joint_names if name not in motion.joint_names]
    if missing:
        raise OptionError(
            f"{file} has no joint {', '.join(missing)}: to know what the hand of arm {model.name!r} did, all "
            f"its joints are needed: {', '.join(model.joint_names)}"
        )
    q = motion.q[:, [motion.joint_names.index(name) for name in model.joint_names]]
    return _by_kinematics(file, model, ak.JointMotion(motion.time, q, model.joint_names))


def from_device(file: Path, arm: str, calibration: Path | None) -> Recorded:
    """Take what a device sent as the motion of an arm, filtered and at even times.

    Args:
        file: The recording.
        arm: Name of the arm the device was calibrated as, or its file.
        calibration: Calibration of the device; None: the one in the recording.

    Returns:
        Arm, path and measured angles; joints that are not measured stay at 0.

    Raises:
        CalibrationError: If there is no calibration, it is another device's, or a joint is none of the arm's.
        MotionFileError: If the recording cannot be read.

    Source:
        Nguyen 2021, §2.1 (the endpoint from measured angles), eq. 2.
    """
    import armik_sym as ak

    model = ak.load_arm(arm)
    return _by_kinematics(file, model, even_postures(file, model, calibration))


def _by_kinematics(file: Path, arm: Arm, motion: JointMotion) -> Recorded:
    """The hand went where the joints took it; of arms with fewer than six joints its position alone."""
    from armik_sym.arm.product_of_transforms import hand_pose
    from armik_sym.motion.hand_path import HandPath

    position, rotation = hand_pose(arm.chain, motion.q, arm.lengths)
    turned = rotation if arm.dof >= _ENOUGH_FOR_POSES else None
    path = HandPath(motion.time, position, turned, f"hand of arm {arm.name} in {file.name}")
    return Recorded(file.name, arm, path, motion)
