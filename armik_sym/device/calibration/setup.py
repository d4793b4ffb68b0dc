"""What is known of a joint before it is calibrated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from armik_sym.arm.model import Arm
from armik_sym.device.calibration.joint import FULL_TURN
from armik_sym.device.channels import Channel, DeviceInfo, SensorKind
from armik_sym.errors import CalibrationError

ELECTRICAL_ANGLE = math.radians(345.0)
"""Angle over the track of a potentiometer where the user asks for the usual one, in [rad].

An assumption for the CPP-35B of Nguyen 2021, which prints no datasheet value.
"""

SMALLEST_MOVE = math.radians(30.0)
"""Angle between two postures that a scale is determined from, at least, in [rad]."""


@dataclass(frozen=True, slots=True)
class JointSetup:
    """A joint to calibrate.

    Attributes:
        joint: Its name.
        channel: Column of its counts, from 0.
        middle: Middle of its range, in [rad].
        scale: Angle per count, if it is known and shall not be fitted, in [rad/count].
        direction: 1 if the angle grows with the counts, -1 if it falls, None if the postures shall tell.
        full_scale: What the angle over all counts of a potentiometer, or over one turn of an encoder's
            counts, can be, lowest and highest: a fit outside betrays a wrong angle, or a dead zone between
            two postures. None: 200° to 365°, and 270° to 450°; say more for a sensor behind gears, in [rad].

    Raises:
        CalibrationError: If a value cannot be.
    """

    joint: str
    channel: int
    middle: float = 0.0
    scale: float | None = None
    direction: int | None = None
    full_scale: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if self.scale is not None and not 0 < self.scale < math.inf:
            raise CalibrationError(
                f"joint {self.joint!r}: scale {self.scale!r}, expected a positive number of radians per count"
            )
        if self.direction not in (None, 1, -1):
            raise CalibrationError(f"joint {self.joint!r}: direction {self.direction!r}, expected 1 or -1")
        if self.full_scale is not None and not 0 <= self.full_scale[0] < self.full_scale[1]:
            raise CalibrationError(
                f"joint {self.joint!r}: full_scale {self.full_scale!r}, expected lowest < highest"
            )

    def plausible(self, kind: SensorKind) -> tuple[float, float]:
        """What the angle over all counts, or over one turn, can be.

        Args:
            kind: The sensor.

        Returns:
            Lowest and highest, in [rad].

        Source:
            None (assumption of this package).
        """
        if self.full_scale is not None:
            return self.full_scale
        degrees = (200.0, 365.0) if kind is SensorKind.POTENTIOMETER else (270.0, 450.0)
        return math.radians(degrees[0]), math.radians(degrees[1])


def datasheet_scale(channel: Channel, electrical_angle: float = ELECTRICAL_ANGLE) -> float:
    """Angle per count as in a datasheet: electrical angle over full scale, or a turn over counts per turn.

    Args:
        channel: The sensor.
        electrical_angle: Angle over the track of a potentiometer, in [rad].

    Returns:
        The scale, in [rad/count].

    Source:
        None (definition).
    """
    if channel.kind is SensorKind.ENCODER:
        return FULL_TURN / channel.span
    return electrical_angle / channel.span


def arm_setup(arm: Arm, info: DeviceInfo, channels: Sequence[int] | None = None) -> tuple[JointSetup, ...]:
    """The joints of an arm on the channels of a device.

    Args:
        arm: The arm the device measures, base to hand.
        info: The device.
        channels: Channel of each joint, from 0; None: in their order.

    Returns:
        One setup for each joint that has a channel; the joints beyond are not measured.

    Raises:
        CalibrationError: If a channel does not exist or has two joints, or there are more channels than
            joints.

    Source:
        None (bookkeeping).
    """
    count = len(info.channels)
    chosen = list(range(count)) if channels is None else list(channels)
    if len(chosen) > arm.dof:
        raise CalibrationError(
            f"device {info.device_id} has {len(chosen)} channels to use, but arm {arm.name!r} has {arm.dof} "
            "joints: choose another arm, or say which channels belong to its joints"
        )
    if len(set(chosen)) != len(chosen) or any(not 0 <= channel < count for channel in chosen):
        raise CalibrationError(
            f"channels {', '.join(map(str, chosen))}: expected different ones of 0 to {count - 1}, one per "
            "joint"
        )
    middles = (arm.rom.lower + arm.rom.upper) / 2
    return tuple(
        JointSetup(joint, channel, float(middle))
        for joint, channel, middle in zip(arm.joint_names, chosen, middles, strict=False)
    )
