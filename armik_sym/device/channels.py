"""What a measuring device says about itself: its sensors, its rate, its name."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from armik_sym.errors import ProtocolError

MOST_CHANNELS = 7
"""Channels a device can have: one per joint of the arm."""

HIGHEST_RATE = 0xFFFF
"""Largest rate that fits the field of an info frame, in [Hz]."""

LONGEST_FIRMWARE_NAME = 16
"""Characters of a firmware name, at most."""

WIDEST_POTENTIOMETER = 0x10000
"""Counts of a potentiometer over its full scale, at most: those of a 16-bit converter."""


class SensorKind(Enum):
    """How a joint is measured; the value is the one on the wire.

    A POTENTIOMETER gives an absolute angle as a count of the analogue-to-digital converter. An ENCODER
    gives the 16-bit register of a quadrature counter: relative, overflowing, with an index pulse each turn.
    """

    POTENTIOMETER = 0
    ENCODER = 1


@dataclass(frozen=True, slots=True)
class Channel:
    """One sensor: its kind, and the counts of its full scale or full turn.

    Attributes:
        kind: What the sensor is.
        span: Of a potentiometer, the counts of the converter over its full scale (4096 with 12 bits); of
            an encoder, the counts per turn (pulses per turn times 4), in [count].

    Raises:
        ProtocolError: If the span is below 2 or does not fit the sensor.
    """

    kind: SensorKind
    span: int

    def __post_init__(self) -> None:
        highest = WIDEST_POTENTIOMETER if self.kind is SensorKind.POTENTIOMETER else 0xFFFFFFFF
        if not 2 <= self.span <= highest:
            raise ProtocolError(
                f"a span of {self.span} counts is no {self.kind.name.lower()}'s: give 2 to {highest:,}"
            )


@dataclass(frozen=True, slots=True)
class DeviceInfo:
    """What a device sends at start-up and once a second: who it is and what it measures with.

    Attributes:
        device_id: Number of this very device, 0 to 2^32 - 1; a calibration belongs to one of them.
        rate: Samples per second it means to send, a whole number from 1 to 65,535, in [Hz].
        channels: Its sensors in the order of the counts in a sample, 1 to 7 of them.
        firmware: Name and version of its program, at most 16 printable ASCII characters.

    Raises:
        ProtocolError: If a value does not fit the frame it is sent in.
    """

    device_id: int
    rate: float
    channels: tuple[Channel, ...]
    firmware: str = ""

    def __post_init__(self) -> None:
        if not 0 <= self.device_id <= 0xFFFFFFFF:
            raise ProtocolError(f"device id {self.device_id} does not fit 32 bits: give 0 to 4294967295")
        if not 1 <= self.rate <= HIGHEST_RATE or self.rate != int(self.rate):
            raise ProtocolError(
                f"a rate of {self.rate:g} Hz cannot be sent: give a whole number from 1 to {HIGHEST_RATE}"
            )
        if not 1 <= len(self.channels) <= MOST_CHANNELS:
            raise ProtocolError(f"a device with {len(self.channels)} channels: give 1 to {MOST_CHANNELS}")
        if not is_firmware_name(self.firmware):
            raise ProtocolError(
                f"firmware name {self.firmware!r}: give at most {LONGEST_FIRMWARE_NAME} "
                "printable ASCII characters"
            )


def is_firmware_name(text: str) -> bool:
    """Whether a text can be sent as the name of a firmware.

    Args:
        text: The name.

    Returns:
        True if it is at most 16 printable ASCII characters.

    Source:
        None (this package).
    """
    return len(text) <= LONGEST_FIRMWARE_NAME and all(" " <= letter <= "~" for letter in text)
