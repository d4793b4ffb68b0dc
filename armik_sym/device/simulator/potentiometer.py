"""A potentiometer on an analogue-to-digital converter: noise, non-linearity, and a gap without a wiper."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from armik_sym.device.channels import WIDEST_POTENTIOMETER, Channel, SensorKind
from armik_sym.device.simulator.sensor import Array, Counts, Readings
from armik_sym.errors import OptionError

ELECTRICAL_ANGLE = math.radians(345.0)
"""Angle over the track of a one-turn potentiometer; an assumption, the paper gives none, in [rad]."""

_TURN = 2 * math.pi


class OpenWiper(Enum):
    """What the converter reads where the wiper touches no track.

    FLOATING: anything. LOW or HIGH: one of its ends, where a resistor pulls the input there.
    """

    FLOATING = "floating"
    LOW = "low"
    HIGH = "high"


@dataclass(frozen=True, slots=True)
class Potentiometer:
    """A potentiometer without end stops: c = floor(N (φ/E + λ sin(2π φ/E)) + noise), φ = φ_0 + s q mod 2π.

    N is the span and E the electrical angle. From E to a full turn the wiper touches no track, and the
    counts mean nothing.

    Attributes:
        direction: s; 1 if counts rise with the joint angle, -1 if they fall.
        mounting: φ_0, angle of the shaft from the beginning of the track at joint angle 0, in [rad].
        span: N, counts of the converter over its full scale, in [count].
        electrical_angle: E, in [rad].
        noise: Standard deviation of what is added before rounding, in [count].
        linearity: λ, largest deviation from a straight line as a fraction of full scale.
        open_wiper: What is read beyond the track.

    Raises:
        OptionError: If a value is out of range.

    Source:
        Nguyen 2021, §2.1 and Table 3 (potentiometers CPP-35B); the model and its numbers are this package's.
    """

    direction: int = 1
    mounting: float = ELECTRICAL_ANGLE / 2
    span: int = 4096
    electrical_angle: float = ELECTRICAL_ANGLE
    noise: float = 0.5
    linearity: float = 0.0
    open_wiper: OpenWiper = OpenWiper.FLOATING

    def __post_init__(self) -> None:
        check_direction(self.direction)
        if not 2 <= self.span <= WIDEST_POTENTIOMETER:
            raise OptionError(f"span is {self.span!r} counts, expected 2 to {WIDEST_POTENTIOMETER}")
        if not 0 < self.electrical_angle <= _TURN:
            raise OptionError(
                f"electrical_angle is {math.degrees(self.electrical_angle):g}°, expected more than 0 and at "
                "most 360"
            )
        for name, value in (("noise", self.noise), ("linearity", abs(self.linearity))):
            if not 0 <= value < math.inf:
                raise OptionError(f"{name} is {value!r}, expected a finite number, not negative")

    @property
    def channel(self) -> Channel:
        """What the device says about it."""
        return Channel(SensorKind.POTENTIOMETER, self.span)

    @property
    def scale(self) -> float:
        """Joint angle per count: E / N, in [rad]."""
        return self.electrical_angle / self.span

    @property
    def zero(self) -> float:
        """Count at joint angle 0, in the middle between the edges it is rounded from, in [count]."""
        return self.mounting / self.scale - 0.5

    def switched_on(self, random: np.random.SeedSequence) -> PotentiometerReader:
        """Switch the sensor on.

        Args:
            random: Where its noise comes from.

        Returns:
            Its reader.

        Source:
            None (this package).
        """
        return PotentiometerReader(self, random)


class PotentiometerReader:
    """A potentiometer that is switched on."""

    def __init__(self, sensor: Potentiometer, random: np.random.SeedSequence) -> None:
        self._sensor = sensor
        self._random = np.random.default_rng(random)

    def read(self, angle: Array) -> Readings:
        """Read the sensor at the next samples.

        Args:
            angle: True joint angles, shape (n,), in [rad].

        Returns:
            Counts; a potentiometer has no index pulse.

        Source:
            None (this package).
        """
        sensor, n = self._sensor, len(angle)
        share = np.mod(sensor.mounting + sensor.direction * angle, _TURN) / sensor.electrical_angle
        noise = sensor.noise * self._random.standard_normal(n)
        floating = self._random.integers(0, sensor.span, n)
        bent = share + sensor.linearity * np.sin(_TURN * share)
        on_track = np.clip(np.floor(sensor.span * bent + noise), 0, sensor.span - 1).astype(np.int64)
        counts = np.where(share <= 1.0, on_track, _beyond(sensor, floating))
        return Readings(counts, np.zeros(n, dtype=np.bool_), np.zeros(n, dtype=np.int64))


def _beyond(sensor: Potentiometer, floating: Counts) -> Counts:
    """Counts beyond the track."""
    if sensor.open_wiper is OpenWiper.FLOATING:
        return floating
    return np.full_like(floating, 0 if sensor.open_wiper is OpenWiper.LOW else sensor.span - 1)


def check_direction(direction: int) -> None:
    """Check the sense of rotation of a sensor.

    Args:
        direction: What was given.

    Raises:
        OptionError: If it is neither 1 nor -1.

    Source:
        None (bookkeeping).
    """
    if direction not in (1, -1):
        raise OptionError(f"direction is {direction!r}, expected 1 (counts rise with the angle) or -1")
