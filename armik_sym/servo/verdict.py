"""What speaks against a drive, joint by joint, in words and numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import OptionError
from armik_sym.servo.given_number import is_number
from armik_sym.servo.margins import LoopMargins
from armik_sym.servo.tracking import Tracking

Array = NDArray[np.float64]

_SLACK = 1e-9


@dataclass(frozen=True)
class Tolerances:
    """What a drive must keep.

    Attributes:
        joint: Largest tracking error of a joint, in [rad].
        hand: Largest distance of the hand from where it should be, in [m].
        phase_margin: Least phase margin, in [rad].
        gain_margin: Least gain margin, a factor.
        sensitivity: Largest peak of the sensitivity.

    Raises:
        OptionError: If a value is not positive.

    Source:
        Åström & Murray 2008, §9.3 (margins: 30° to 60°, a factor of 2 to 5; sensitivity 1.2 to 2). Joint and
        hand: our choice; set them for your device.
    """

    joint: float = math.radians(2.0)
    hand: float = 0.010
    phase_margin: float = math.radians(30.0)
    gain_margin: float = 2.0
    sensitivity: float = 2.0

    def __post_init__(self) -> None:
        for key in ("joint", "hand", "phase_margin", "gain_margin", "sensitivity"):
            value = getattr(self, key)
            if not is_number(value, infinite_ok=True) or value <= 0:
                raise OptionError(f"tolerance {key} is {value!r}, expected a positive number")


@dataclass(frozen=True)
class JointVerdict:
    """One joint: what the motion asks, what the drive can do, what the loop did.

    Attributes:
        name: The joint.
        reasons: What speaks against the drive, one sentence each; empty if nothing does.
        speed: Largest speed wanted, in [rad/s].
        speed_limit: Of the drive, in [rad/s].
        torque: Largest torque wanted at the joint, in [Nm].
        torque_limit: What the drive has for a moment, in [Nm].
        torque_rms: Root mean square of the torque wanted, in [Nm].
        torque_rated: What the drive has all day, in [Nm].
        error_rms: Root mean square of the tracking error, in [rad].
        error_peak: Largest tracking error, in [rad].
        margins: Of the loop cut at the torque.
    """

    name: str
    reasons: tuple[str, ...]
    speed: float
    speed_limit: float
    torque: float
    torque_limit: float
    torque_rms: float
    torque_rated: float
    error_rms: float
    error_peak: float
    margins: LoopMargins

    @property
    def ok(self) -> bool:
        """True if nothing speaks against the drive."""
        return not self.reasons


def joint_verdicts(
    tracking: Tracking, margins: tuple[LoopMargins, ...], tolerances: Tolerances
) -> tuple[JointVerdict, ...]:
    """Judge every joint.

    Args:
        tracking: What happened.
        margins: Of the loops, one per joint.
        tolerances: What must be kept.

    Returns:
        One verdict per joint.

    Source:
        None (this package).
    """
    reference, setup = tracking.reference, tracking.setup
    needed = setup.torque_needed(reference.q, reference.speed, reference.acceleration)
    error = tracking.joint_error
    found = []
    for j, drive in enumerate(setup.drive.joints):
        facts = JointVerdict(
            drive.name,
            (),
            float(np.abs(reference.speed[:, j]).max()),
            drive.top_speed,
            float(np.abs(needed[:, j]).max()),
            drive.peak_torque,
            float(np.sqrt(np.mean(needed[:, j] ** 2))),
            drive.rated_torque,
            float(np.sqrt(np.mean(error[:, j] ** 2))),
            float(np.abs(error[:, j]).max()),
            margins[j],
        )
        when = (
            float(tracking.time[int(np.argmax(np.abs(values[:, j])))])
            for values in (reference.speed, needed, error)
        )
        found.append(replace(facts, reasons=_reasons(facts, tolerances, *when)))
    return tuple(found)


def _reasons(
    v: JointVerdict, tolerances: Tolerances, fast: float, strong: float, far: float
) -> tuple[str, ...]:
    """Every sentence names the joint, the number, the limit and when."""
    said = []
    if v.speed > v.speed_limit * (1 + _SLACK):
        said.append(
            f"{v.name} is asked for {math.degrees(v.speed):.4g}°/s at {fast:.3g} s, its drive turns at most "
            f"{math.degrees(v.speed_limit):.4g}°/s"
        )
    if v.torque > v.torque_limit * (1 + _SLACK):
        said.append(
            f"{v.name} needs {v.torque:.3g} Nm at {strong:.3g} s, its drive has {v.torque_limit:.3g} Nm"
        )
    if v.torque_rms > v.torque_rated * (1 + _SLACK):
        said.append(
            f"{v.name} needs {v.torque_rms:.3g} Nm RMS, its drive has {v.torque_rated:.3g} Nm all day: it "
            "gets too hot if the motion goes on"
        )
    if v.error_peak > tolerances.joint:
        said.append(
            f"{v.name} is {math.degrees(v.error_peak):.3g}° off at {far:.3g} s, allowed are "
            f"{math.degrees(tolerances.joint):.3g}°"
        )
    return (*said, *loop_reasons(v, tolerances))


def loop_reasons(v: JointVerdict, tolerances: Tolerances) -> tuple[str, ...]:
    """What speaks against the loop of a joint, however slow the motion is.

    Args:
        v: The joint.
        tolerances: What must be kept.

    Returns:
        One sentence each; empty if the loop is safe.

    Source:
        Åström & Murray 2008, §9.3.
    """
    m = v.margins
    if not m.stable:
        return (f"the loop of {v.name} is not stable",)
    said = []
    if m.phase < tolerances.phase_margin:
        said.append(
            f"the loop of {v.name} has a phase margin of {math.degrees(m.phase):.3g}°, wanted are "
            f"{math.degrees(tolerances.phase_margin):.3g}°"
        )
    if m.gain < tolerances.gain_margin:
        said.append(
            f"the loop of {v.name} has a gain margin of {m.gain:.3g}, wanted are {tolerances.gain_margin:.3g}"
        )
    if m.sensitivity > tolerances.sensitivity:
        said.append(
            f"the loop of {v.name} amplifies disturbances by {m.sensitivity:.3g} at the worst frequency, "
            f"allowed are {tolerances.sensitivity:.3g}"
        )
    return tuple(said)
