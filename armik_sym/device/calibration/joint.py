"""One calibrated joint: which sensor measures it, and how its counts become an angle."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.device.channels import MOST_CHANNELS, SensorKind
from armik_sym.errors import CalibrationError

Array = NDArray[np.float64]

FULL_TURN = 2 * math.pi
REGISTER = 0x10000
"""Counts after which the register of an encoder starts again."""


class ScaleSource(Enum):
    """Where the scale of a joint comes from; the value is the word in the file.

    FITTED from postures at different angles, or GIVEN by the user, such as from a datasheet.
    """

    FITTED = "fitted"
    GIVEN = "given"


@dataclass(frozen=True, slots=True)
class JointQuality:
    """What a fit is worth.

    Attributes:
        postures: Postures in which the angle was known.
        samples: Readings in these postures.
        residual_rms: Root mean square of known minus calibrated angle over the postures, in [rad].
        residual_max: The largest of them, in [rad].
        scale_error: Standard error of the scale, 0 if it was given, in [rad/count].
        zero_error: Standard error of the zero, in [count].
    """

    postures: int = 0
    samples: int = 0
    residual_rms: float = 0.0
    residual_max: float = 0.0
    scale_error: float = 0.0
    zero_error: float = 0.0


@dataclass(frozen=True, slots=True)
class JointCalibration:
    """How counts become the angle of one joint: angle = direction · scale · (counts - zero).

    Attributes:
        joint: Name of the joint.
        channel: Column of its counts, from 0.
        kind: Potentiometer or encoder.
        span: Counts of the converter over its full scale, or counts per turn of the encoder, in [count].
        scale: Angle per count, positive, in [rad/count].
        direction: 1 if the angle grows with the counts, else -1.
        zero: Counts at angle 0. Of an encoder the register since the power-up of the calibration, in [count].
        middle: Middle of the joint's range. Of all angles full turns apart the nearest to it is meant, so
            that neither the wrap of a potentiometer nor the overflow of a register counts as motion, in
            [rad].
        valid: Lowest and highest counts a wiper gives on its track; below and above it is in the electrical
            dead zone and has no angle, in [count]. None for encoders.
        largest_step: How far the angle of a potentiometer can move from one sample to the next; a larger step
            is a wiper off its track. Infinite: any step is believed, in [rad].
        index: Register at the index pulse of the encoder, at the power-up of the calibration; None if it was
            never passed, in [count].
        scale_source: Where the scale comes from.
        quality: What the fit is worth.

    Raises:
        CalibrationError: If a value cannot be.
    """

    joint: str
    channel: int
    kind: SensorKind
    span: int
    scale: float
    direction: int
    zero: float
    middle: float = 0.0
    valid: tuple[float, float] | None = None
    largest_step: float = math.inf
    index: float | None = None
    scale_source: ScaleSource = ScaleSource.GIVEN
    quality: JointQuality = JointQuality()

    def __post_init__(self) -> None:
        wrong = self._wrong()
        if wrong is not None:
            name, value, expected = wrong
            raise CalibrationError(f"joint {self.joint!r}: {name} is {value!r}, expected {expected}")

    def _wrong(self) -> tuple[str, object, str] | None:
        """The first value that cannot be: its name, itself, and what was expected."""
        if not 0 <= self.channel < MOST_CHANNELS:
            return "channel", self.channel, f"0 to {MOST_CHANNELS - 1}"
        if self.span < 2:
            return "span", self.span, "2 counts or more"
        if not 0 < self.scale < math.inf:
            return "scale", self.scale, "a positive number of radians per count"
        if self.direction not in (1, -1):
            return "direction", self.direction, "1 or -1"
        if not math.isfinite(self.zero):
            return "zero", self.zero, "a finite number of counts"
        if not math.isfinite(self.middle):
            return "middle", self.middle, "a finite angle"
        if not self.largest_step > 0:
            return "largest_step", self.largest_step, "a positive angle"
        potentiometer = self.kind is SensorKind.POTENTIOMETER
        if self.valid is not None and (not potentiometer or not self.valid[0] < self.valid[1]):
            return "valid", self.valid, "lowest < highest counts, of a potentiometer"
        if self.index is not None and (potentiometer or not math.isfinite(self.index)):
            return "index", self.index, "a finite number of counts, of an encoder"
        return None

    @property
    def track(self) -> tuple[float, float]:
        """Lowest and highest counts that have an angle, in [count]."""
        return self.valid if self.valid is not None else (-math.inf, math.inf)

    @property
    def period(self) -> float:
        """Angle of one turn of the sensor, after which an encoder's index comes again, in [rad]."""
        return FULL_TURN if self.kind is SensorKind.POTENTIOMETER else self.scale * self.span

    def position(self, angle: ArrayLike) -> Array:
        """Counts at an angle, before rounding, overflow and dead zone: zero + direction · angle / scale.

        Args:
            angle: Angles, any shape, in [rad].

        Returns:
            Counts, same shape, in [count].

        Source:
            None (this package).
        """
        return np.asarray(self.zero + self.direction * np.asarray(angle, dtype=np.float64) / self.scale)


def usual_track(span: int) -> tuple[float, float]:
    """Counts between which the wiper of a potentiometer is trusted to be on its track.

    1 % off either end of the converter: over the gap of the track a pulled-up or pulled-down input reads
    one of the ends.

    Args:
        span: Counts of the converter over its full scale, in [count].

    Returns:
        Lowest and highest counts, in [count].

    Source:
        None (assumption of this package; the datasheet of the build at hand decides).
    """
    margin = 0.01 * (span - 1)
    return margin, span - 1 - margin


def steps_between(counts: NDArray[np.int64], before: int) -> NDArray[np.int64]:
    """Differences of consecutive counts, the first to the count before them.

    Args:
        counts: Counts, shape (n,), n ≥ 1, in [count].
        before: The count before them, in [count].

    Returns:
        Shape (n,), in [count].

    Source:
        None (np.diff, without what it costs for a single sample).
    """
    steps = np.empty_like(counts)
    steps[0] = counts[0] - before
    np.subtract(counts[1:], counts[:-1], out=steps[1:])
    return steps
