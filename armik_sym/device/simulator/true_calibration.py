"""The calibration a simulated device was built with: what a fit should find, and what needs no fit."""

from __future__ import annotations

from datetime import datetime, timezone

import numpy as np

from armik_sym.arm.model import Arm
from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.joint import JointCalibration, usual_track
from armik_sym.device.simulator.encoder import Encoder, EncoderReader
from armik_sym.device.simulator.measuring import switched_on
from armik_sym.device.simulator.potentiometer import Potentiometer
from armik_sym.device.simulator.simulated_device import SimulatedDevice
from armik_sym.errors import OptionError


def true_calibration(device: SimulatedDevice, arm: Arm | None = None, date: str | None = None) -> Calibration:
    """The calibration of a simulated device, exact but for noise, non-linearity and lost counts.

    Of an encoder the zero is r_0 - N_0 + K φ_0 / 2π - ½ and the register at the index r_0 - N_0, with N_0
    its edge at the first sample: they hold for this power-up, so for
    this device with this seed, up to a restart.

    Args:
        device: The device.
        arm: Its range of motion says around which angle each joint moves; None: the motion says it.
        date: When it was made, ISO 8601; None: now.

    Returns:
        The calibration, one joint per channel.

    Raises:
        OptionError: If the arm has fewer joints than the device, or a sensor is of another kind.

    Source:
        None (this package).
    """
    n = len(device.sensors)
    lower, upper = device.motion.q.min(axis=0), device.motion.q.max(axis=0)
    if arm is not None:
        if arm.dof < n:
            raise OptionError(f"arm {arm.name!r} has {arm.dof} joints, the device measures {n}")
        lower, upper = arm.rom.lower, arm.rom.upper
    middles = ((lower + upper) / 2).tolist()
    made = date or datetime.now(timezone.utc).isoformat(timespec="seconds")
    joints = tuple(_joint(device, channel, middles[channel]) for channel in range(n))
    return Calibration(device.device_id, made, joints, notes=("true values of a simulated device",))


def _joint(device: SimulatedDevice, channel: int, middle: float) -> JointCalibration:
    sensor, name = device.sensors[channel], device.joint_names[channel]
    kind, span = sensor.channel.kind, sensor.channel.span
    if isinstance(sensor, Potentiometer):
        return JointCalibration(
            name,
            channel,
            kind,
            span,
            sensor.scale,
            sensor.direction,
            sensor.zero,
            middle,
            valid=usual_track(span),
        )
    reader = switched_on(device)[channel]
    if not isinstance(sensor, Encoder) or not isinstance(reader, EncoderReader):
        raise OptionError(f"channel {channel}: a sensor of type {type(sensor).__name__} has no known truth")
    start = float(device.true_angles([device.first_sequence])[0, channel])
    index = float(reader.start - sensor.edges(np.array([start]))[0])
    return JointCalibration(
        name,
        channel,
        kind,
        span,
        sensor.scale,
        sensor.direction,
        index + sensor.index_to_zero,
        middle,
        index=index,
    )
