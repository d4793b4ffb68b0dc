"""What the postures say about one joint, gathered and checked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.calibration.encoder import INDEX_TOLERANCE, signed_step
from armik_sym.device.calibration.joint import REGISTER, usual_track
from armik_sym.device.calibration.posture import Posture, Reading
from armik_sym.device.calibration.setup import JointSetup, datasheet_scale
from armik_sym.device.channels import Channel, SensorKind
from armik_sym.errors import CalibrationError

Array = NDArray[np.float64]

MOST_SPREAD = math.radians(10.0)
"""How far the counts of a joint may spread in a posture, at the scale of the datasheet, in [rad]."""


@dataclass(frozen=True, slots=True, eq=False)
class JointData:
    """Known angles of one joint and the counts that belong to them.

    Attributes:
        setup: The joint.
        channel: Its sensor.
        names: Names of the postures.
        angles: Known angles, shape (n,), in [rad].
        counts: Mean counts, overflows counted, shape (n,), in [count].
        errors: Their standard errors, shape (n,), in [count].
        samples: Readings in all postures.
        index: Register at the index pulse, if one came, in [count].
    """

    setup: JointSetup
    channel: Channel
    names: tuple[str, ...]
    angles: Array
    counts: Array
    errors: Array
    samples: int
    index: float | None

    @property
    def moved(self) -> float:
        """Largest difference of two known angles, in [rad]."""
        return float(np.ptp(self.angles))


def joint_data(setup: JointSetup, channel: Channel, postures: Sequence[Posture]) -> JointData:
    """Gather what postures say about a joint.

    Args:
        setup: The joint.
        channel: Its sensor.
        postures: The postures, in the order in which they were taken.

    Returns:
        The data.

    Raises:
        CalibrationError: If no posture says the joint's angle, the wiper was off its track in one, or the
            index pulses of an encoder contradict each other.

    Source:
        None (bookkeeping).
    """
    known = [posture for posture in postures if setup.joint in posture.angles]
    if not known:
        raise CalibrationError(
            f"joint {setup.joint!r}: no posture says its angle: hold it at a known angle, such as 0° in the "
            "zero pose"
        )
    readings = [posture.reading(setup.channel, channel.kind) for posture in known]
    for posture, reading in zip(known, readings, strict=True):
        _still(setup.joint, channel, posture, reading)
    index = None
    if channel.kind is SensorKind.POTENTIOMETER:
        for posture, reading in zip(known, readings, strict=True):
            _on_track(setup.joint, channel, posture, reading)
    else:
        readings = _unwrapped(readings)
        index = _index(setup, channel, known, readings)
    return JointData(
        setup,
        channel,
        tuple(posture.name for posture in known),
        np.array([posture.angles[setup.joint] for posture in known], dtype=np.float64),
        np.array([reading.mean for reading in readings]),
        np.array([reading.error for reading in readings]),
        sum(reading.n for reading in readings),
        index,
    )


def _on_track(joint: str, channel: Channel, posture: Posture, reading: Reading) -> None:
    lowest, highest = usual_track(channel.span)
    if reading.lowest < lowest or reading.highest > highest:
        raise CalibrationError(
            f"posture {posture.name!r}: the potentiometer of joint {joint!r} reads {reading.lowest:.0f} to "
            f"{reading.highest:.0f} counts at {math.degrees(posture.angles[joint]):.1f}°, in its electrical "
            f"dead zone (it is on its track from {lowest:.0f} to {highest:.0f}): loosen it, turn its shaft "
            "by a quarter turn, and calibrate again"
        )


def _still(joint: str, channel: Channel, posture: Posture, reading: Reading) -> None:
    spread = reading.spread * datasheet_scale(channel)
    # A coarse encoder next to an edge toggles by a count.
    if spread > MOST_SPREAD + datasheet_scale(channel):
        raise CalibrationError(
            f"posture {posture.name!r}: the counts of joint {joint!r} spread over about "
            f"{math.degrees(spread):.0f}° (allowed: {math.degrees(MOST_SPREAD):.0f}°): it was not held "
            "still, or the wiper of its potentiometer is off its track; hold it again"
        )


def _unwrapped(readings: list[Reading]) -> list[Reading]:
    """Means of encoder registers, none further than half a register from the first."""
    first = readings[0].mean
    return [
        replace(reading, mean=reading.mean - REGISTER * round((reading.mean - first) / REGISTER))
        for reading in readings
    ]


def _index(
    setup: JointSetup, channel: Channel, known: list[Posture], readings: list[Reading]
) -> float | None:
    """Position of the index pulse, the same modulo a turn in every posture that knows it."""
    found: float | None = None
    for posture, reading in zip(known, readings, strict=True):
        register = (posture.index or {}).get(setup.channel)
        if register is None:
            continue
        # From the register of this posture it is less than half a register away.
        near = round(reading.mean)
        pulse = float(near + signed_step(register - near))
        if found is None:
            found = pulse
            continue
        off = (pulse - found + channel.span / 2) % channel.span - channel.span / 2
        if abs(off) > INDEX_TOLERANCE:
            raise CalibrationError(
                f"posture {posture.name!r}: the index pulse of joint {setup.joint!r} came {off:.0f} counts "
                f"off whole turns of {channel.span}: counts were lost, or its counts per turn are wrong: "
                "check the cable and the encoder, and calibrate again"
            )
    return found
