"""Whether a posture was held as it was meant: still, on the track, nothing else moved."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from armik_sym.device.calibration.data import joint_data
from armik_sym.device.calibration.encoder import signed_step
from armik_sym.device.calibration.joint import FULL_TURN
from armik_sym.device.calibration.posture import Posture
from armik_sym.device.calibration.setup import JointSetup, datasheet_scale
from armik_sym.device.channels import DeviceInfo, SensorKind
from armik_sym.errors import CalibrationError

STILL = math.radians(3.0)
"""How far a joint may move while a posture is recorded, in [rad]."""

OTHERS_MOVE = math.radians(15.0)
"""How far the other joints may move on the way into a posture, in [rad]."""


def complaint(
    info: DeviceInfo,
    setups: Sequence[JointSetup],
    posture: Posture,
    start: Posture | None,
    joint: str | None,
    *,
    still: float = STILL,
    others_move: float = OTHERS_MOVE,
) -> str | None:
    """What is wrong with a posture just held.

    Angles are by the scale of datasheets, as there is no better one yet.

    Args:
        info: The device.
        setups: The joints.
        posture: The posture.
        start: The posture it started from; None for the first.
        joint: The joint that was to move; None if all are at a known angle.
        still: How far a joint may move during the posture, in [rad].
        others_move: How far other joints may move on the way, in [rad].

    Returns:
        A sentence; None if all is well.

    Source:
        None (this package).
    """
    for setup in setups:
        channel = info.channels[setup.channel]
        if setup.joint in posture.angles:
            try:
                joint_data(setup, channel, [posture])
            except CalibrationError as error:
                return str(error)
        reading = posture.reading(setup.channel, channel.kind)
        spread = reading.spread * datasheet_scale(channel)
        # A coarse encoder next to an edge toggles by a count.
        if spread > still + datasheet_scale(channel):
            return (
                f"{setup.joint} was not still: it moved over about {math.degrees(spread):.1f}° (allowed: "
                f"{math.degrees(still):.1f}°). Support the arm and hold it again."
            )
    if start is None:
        return None
    for setup in setups:
        moved = abs(_moved(info, setup, start, posture))
        if setup.joint != joint and moved > others_move:
            return (
                f"{setup.joint} moved by about {math.degrees(moved):.0f}° as well since posture "
                f"{start.name!r} (allowed: {math.degrees(others_move):.0f}°). Move {joint} alone."
            )
        if setup.joint == joint:
            asked = abs(posture.angles[joint] - start.angles.get(joint, 0.0))
            if moved < asked / 2:
                return (
                    f"{joint} was to move by {math.degrees(asked):.0f}°, but the sensor on channel "
                    f"{setup.channel} moved by about {math.degrees(moved):.0f}°. If the posture was right, "
                    "the joint is on another channel (--channels) or its cable is loose."
                )
    return None


def _moved(info: DeviceInfo, setup: JointSetup, start: Posture, posture: Posture) -> float:
    """How far a joint moved between two postures, by the scale of the datasheet, in [rad]."""
    channel = info.channels[setup.channel]
    before, after = (each.reading(setup.channel, channel.kind).mean for each in (start, posture))
    if channel.kind is SensorKind.ENCODER:
        return float(signed_step(round(after - before))) * datasheet_scale(channel)
    angle = (after - before) * datasheet_scale(channel)
    return float(angle - FULL_TURN * np.rint(angle / FULL_TURN))
