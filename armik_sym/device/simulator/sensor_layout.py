"""Which sensor sits on which joint, and how it was built in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armik_sym.arm.model import Arm
from armik_sym.device.channels import MOST_CHANNELS
from armik_sym.device.simulator.encoder import Encoder
from armik_sym.device.simulator.potentiometer import ELECTRICAL_ANGLE, Potentiometer
from armik_sym.device.simulator.sensor import Sensor
from armik_sym.errors import OptionError

ENCODERS = 2
"""Encoders of the E-HMCS; all other joints have potentiometers."""

_OFF_CENTRE = 0.15


def sensors_of(
    arm: Arm,
    joints: int | None = None,
    seed: int = 0,
    noise: float = 0.5,
    linearity: float = 0.0,
    lost: float = 0.0,
    encoders: Sequence[str] | None = None,
) -> tuple[Sensor, ...]:
    """Sensors for the joints of an arm, mounted as no two devices are: direction and zero from the seed.

    The paper counts its sensors (3 potentiometers and 2 encoders for 5 joints, 5 and 2 for 7), and a picture
    shows where they are. Here the encoders go to the joints with the widest range of motion, which need
    most of a turn; the track of a potentiometer is centred on its joint's range up to ±15 % of a turn, or
    as much as leaves the range on the track.

    Args:
        arm: The arm.
        joints: How many joints are measured, from the base on; None: all, at most 7.
        seed: Decides directions and mountings.
        noise: Of every potentiometer, before rounding, standard deviation in [count].
        linearity: Of every potentiometer, as a fraction of full scale.
        lost: Of every encoder, share of the edges.
        encoders: Names of the joints with encoders; None: the two with the widest range of motion.

    Returns:
        One sensor per measured joint, base to hand.

    Raises:
        OptionError: If there are not that many joints, or one of `encoders` is not among them.

    Source:
        Nguyen 2021, Table 3 (how many of each); which joint has which is this package's choice.
    """
    most = min(arm.dof, MOST_CHANNELS)
    n = most if joints is None else joints
    if not 1 <= n <= most:
        raise OptionError(f"{n} joints are to be measured: {arm.name} has {arm.dof}, a device 1 to {most}")
    names = arm.joint_names[:n]
    width = arm.rom.upper[:n] - arm.rom.lower[:n]
    if encoders is None:
        encoders = [names[i] for i in np.argsort(-width, kind="stable")[: ENCODERS if n > ENCODERS else 0]]
    unknown = sorted(set(encoders) - set(names))
    if unknown:
        raise OptionError(f"encoder on {unknown[0]!r}: the measured joints are {', '.join(names)}")
    random = np.random.default_rng(seed)
    sensors: list[Sensor] = []
    for i, name in enumerate(names):
        direction = 1 if random.random() < 0.5 else -1
        shift = float(random.uniform(-1.0, 1.0))
        if name in encoders:
            sensors.append(Encoder(direction, np.pi * shift, lost=lost))
        else:
            mounting = _on_track(float(arm.rom.lower[i]), float(arm.rom.upper[i]), direction, shift)
            sensors.append(Potentiometer(direction, mounting, noise=noise, linearity=linearity))
    return tuple(sensors)


def _on_track(lower: float, upper: float, direction: int, shift: float) -> float:
    """Mounting of a potentiometer whose track covers a range of motion, off its centre as far as fits."""
    slack = max(0.0, (ELECTRICAL_ANGLE - (upper - lower)) / 2)
    centred = ELECTRICAL_ANGLE / 2 - direction * (lower + upper) / 2
    return centred + shift * min(slack, _OFF_CENTRE * 2 * np.pi)
