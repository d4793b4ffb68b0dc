"""From a file to what `armik solve` solves: an arm and the path of its hand."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from armik_sym.cli.arguments import posture
from armik_sym.cli.option_checks import only
from armik_sym.cli.recorded import DEVICE_ARM, Recorded, kind_of, read_recorded
from armik_sym.cli.recording_options import RecordingOptions
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.motion.hand_path import HandPath

RECORDED = "recorded"


class Job(NamedTuple):
    """What is to be solved.

    Attributes:
        arm: The arm.
        path: The path of its hand.
        recorded: The recording it comes from; None for a hand path.
        own_lengths: Whether a fitted arm keeps the segment lengths it came with.
    """

    arm: Arm
    path: HandPath
    recorded: Recorded | None = None
    own_lengths: bool = False

    @property
    def fits(self) -> bool:
        """Whether the arm was fitted to markers, so that nobody has it yet."""
        return self.from_markers and not self.own_lengths

    @property
    def from_markers(self) -> bool:
        """Whether the path comes from markers, with their noise."""
        return self.recorded is not None and self.recorded.fitted is not None


def read_job(
    file: Path,
    arm: str | None,
    lengths: str | None,
    options: RecordingOptions,
    calibration: Path | None = None,
) -> Job:
    """Read what is to be solved: a hand path, markers, joint angles or what a device sent.

    Args:
        file: The file.
        arm: Name or file of the arm, if one was typed.
        lengths: "fitted" or "arm", if typed.
        options: What was typed about markers.
        calibration: Calibration of a device, if typed.

    Returns:
        Arm, path and where they come from.

    Raises:
        OptionError: If options do not go with what the file holds, or one that it needs is missing.

    Source:
        None (command line).
    """
    import armik_sym as ak

    kind = kind_of(file)
    typed = {**options.typed, "--lengths": lengths}
    if kind == "path" and calibration is not None:
        raise OptionError(f"--calibration is for recordings of a device, {file} is none")
    if kind == "path":
        only(f"{file}: it holds a hand path, and the option is about markers", typed)
        return Job(ak.load_arm(arm or DEVICE_ARM), ak.read_path(file))
    if kind in ("motion", "device"):
        only(f"{file}: it holds joint angles, and the option is about markers", typed)
    own = _own_lengths(lengths, arm)
    recorded = read_recorded(file, kind, arm, options, calibration)
    if recorded.fitted is None:
        return Job(recorded.arm, recorded.path, recorded)
    model = recorded.arm
    if own and arm is not None:
        asked = ak.load_arm(arm)
        # With --rom widened the limits are those of the fit.
        model = asked.with_rom(model.rom.lower, model.rom.upper)
    return Job(model, recorded.path, recorded, own)


def _own_lengths(lengths: str | None, arm: str | None) -> bool:
    if lengths not in (None, "fitted", "arm"):
        raise OptionError(f"--lengths is {lengths!r}: valid are fitted, arm")
    if lengths == "arm" and arm is None:
        raise OptionError("--lengths arm needs --arm, the arm whose segment lengths are to be kept")
    return lengths == "arm"


def first_posture(typed: str | None, job: Job) -> list[float] | None:
    """The posture at the beginning, if one is known.

    Args:
        typed: Angles, or "recorded" for those at the first recorded sample.
        job: What is to be solved.

    Returns:
        Joint angles, shape (dof,), in [rad]; None if nothing was typed.

    Raises:
        OptionError: If nothing was recorded, or the angles cannot be read.

    Source:
        None (command line).
    """
    from armik_sym.comparison.predicting import first_inside

    if typed is None:
        return None
    if typed.strip() != RECORDED:
        return posture(typed, job.arm)
    if job.recorded is None:
        raise OptionError("--start recorded: a hand path has no recorded posture: give angles")
    return [float(angle) for angle in first_inside(job.arm, job.recorded.measured.q[0])[0]]
