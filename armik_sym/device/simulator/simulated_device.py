"""A measuring device that is not there: a motion, sensors, a program that sends frames, and faults."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.device.channels import DeviceInfo
from armik_sym.device.protocol.encode import encode_info, encode_sample
from armik_sym.device.protocol.frames import Sample
from armik_sym.device.simulator.byte_damage import ByteDamage
from armik_sym.device.simulator.faults import Faults
from armik_sym.device.simulator.measuring import measured_blocks, power_ups
from armik_sym.device.simulator.playback import AtEnd, Playback
from armik_sym.device.simulator.sensor import Sensor
from armik_sym.device.simulator.versions import with_version
from armik_sym.errors import OptionError
from armik_sym.motion.joint_motion import JointMotion

Array = NDArray[np.float64]


class WireFrame(NamedTuple):
    """One frame as it goes on the line.

    Attributes:
        number: Number of its sample from 0; None for an info frame.
        time: Device time since the start at which it is sent, in [s].
        data: Its bytes, damage and garbage behind it included.
        whole: Whether all its bytes are as they were made.
    """

    number: int | None
    time: float
    data: bytes
    whole: bool


@dataclass(frozen=True)
class SimulatedDevice:
    """A device that plays a motion: sample k is measured at k / rate and sent at once.

    The same device gives the same bytes every time: all that is random comes from its seed.

    Attributes:
        motion: True joint angles; its first columns belong to the sensors in order.
        sensors: One per channel.
        device_id: Number of the device.
        rate: Samples per second, a whole number, in [Hz].
        seed: Of noise, register starts, lost counts and damaged bytes.
        faults: What goes wrong.
        at_end: What follows when the motion has been played.
        first_sequence: Sequence number of the first sample; it wraps at 2^32 on the line.
        first_time_us: Device clock at the first sample; it wraps at 2^32 on the line, in [µs].
        firmware: Name of its program.

    Raises:
        OptionError: If there are more sensors than joints in the motion, or a fault does not fit.
        ProtocolError: If a value does not fit an info frame.

    Source:
        Nguyen 2021, §2.1 (the instrument); docs/device_protocol.md (the frames).
    """

    motion: JointMotion
    sensors: tuple[Sensor, ...]
    device_id: int = 1
    rate: float = 500.0
    seed: int = 0
    faults: Faults = field(default_factory=Faults)
    at_end: AtEnd = AtEnd.SWING
    first_sequence: int = 0
    first_time_us: int = 0
    firmware: str = "armik simulator"

    def __post_init__(self) -> None:
        if len(self.sensors) > self.motion.dof:
            raise OptionError(
                f"{len(self.sensors)} sensors for a motion of {self.motion.dof} joints "
                f"({', '.join(self.motion.joint_names)}): give a motion with a column for each"
            )
        if self.first_sequence < 0 or self.first_time_us < 0:
            raise OptionError("first_sequence and first_time_us must not be negative")
        self.faults.check_channels(len(self.sensors))
        _ = self.info

    @property
    def info(self) -> DeviceInfo:
        """What the device says about itself."""
        channels = tuple(sensor.channel for sensor in self.sensors)
        return DeviceInfo(self.device_id, self.rate, channels, self.firmware)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints measured, one per channel."""
        return self.motion.joint_names[: len(self.sensors)]

    def time_of(self, sequence: ArrayLike) -> Array:
        """Device time of samples: (s - s_0) / rate.

        Args:
            sequence: Sequence numbers, not wrapped and numbered through restarts as in `Truth`, shape (k,).

        Returns:
            Times since the first sample, shape (k,), in [s].

        Source:
            None (definition).
        """
        return (np.asarray(sequence, dtype=np.float64) - self.first_sequence) / self.rate

    def true_angles(self, sequence: ArrayLike) -> Array:
        """True joint angles at samples, before any sensor saw them.

        Args:
            sequence: Sequence numbers, not wrapped and numbered through restarts as in `Truth`, shape (k,).

        Returns:
            Angles of the joints measured, shape (k, channels), in [rad].

        Source:
            None (definition).
        """
        angles = Playback(self.motion, self.at_end).angles(self.time_of(sequence))
        return angles[:, : len(self.sensors)]

    def samples(self) -> Iterator[Sample]:
        """All samples from the first on, as the device measures them, without end.

        Yields:
            Samples, sensor faults included.

        Source:
            None (this package).
        """
        for block in measured_blocks(self):
            yield from block

    def frames(self) -> Iterator[WireFrame]:
        """All that the device puts on the line, without end: an info frame every second, and its samples.

        Yields:
            Frames in the order they are sent, faults of the bytes included.

        Source:
            None (this package).
        """
        damage = ByteDamage(self.faults, np.random.SeedSequence([self.seed, len(self.sensors)]))
        info, rate = self._bytes(encode_info(self.info)), int(self.rate)
        starts = set(power_ups(self))
        number = 0
        for block in measured_blocks(self):
            planned: list[tuple[int | None, float, bytes]] = []
            for sample in block:
                if number % rate == 0 or number in starts:
                    planned.append((None, number / rate, info))
                planned.append((number, number / rate, self._bytes(encode_sample(sample))))
                number += 1
            arrived = damage.carry([data for _, _, data in planned])
            for (which, time, _), (data, whole) in zip(planned, arrived, strict=True):
                yield WireFrame(which, time, data, whole)

    def _bytes(self, frame: bytes) -> bytes:
        version = self.faults.version
        return frame if version is None else with_version(frame, version)
