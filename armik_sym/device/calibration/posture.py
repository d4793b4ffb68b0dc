"""A posture held still in front of the sensors, with the joint angles that are known in it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.device.calibration.encoder import signed_step
from armik_sym.device.channels import SensorKind
from armik_sym.errors import CalibrationError, ShapeError

Counts = NDArray[np.int64]

_LARGEST_ANGLE = 4 * math.pi
_TOGGLING = 0.3


@dataclass(frozen=True, slots=True, eq=False)
class Posture:
    """Readings of all channels in one posture.

    Attributes:
        name: What to call it in messages.
        angles: The joint angles that are known, by joint name; joints left out may be anywhere, in [rad].
        counts: Raw counts of all channels, shape (n, channels) or (channels,), kept as (n, channels), in
            [count]. Registers of encoders run on from posture to posture: the device stays switched on.
        index: Register at the latest index pulse up to this posture, by channel, if one came, in [count].

    Raises:
        ShapeError: If the counts are no whole numbers from 0 to 65535, or there are none.
        CalibrationError: If an angle is no finite number, or more than two turns.
    """

    name: str
    angles: Mapping[str, float]
    counts: ArrayLike
    index: Mapping[int, int] | None = None

    def __post_init__(self) -> None:
        counts = np.asarray(self.counts)
        whole = counts.dtype.kind in "iu" and counts.ndim in (1, 2) and counts.size > 0
        if not whole or counts.min() < 0 or counts.max() > 0xFFFF:
            raise ShapeError(
                f"posture {self.name!r}: counts of shape {counts.shape}, expected whole numbers from 0 to "
                "65535, shape (n, channels)"
            )
        object.__setattr__(self, "counts", counts.astype(np.int64).reshape(-1, counts.shape[-1]))
        for joint, angle in self.angles.items():
            if not (isinstance(angle, (int, float)) and abs(angle) <= _LARGEST_ANGLE):
                raise CalibrationError(
                    f"posture {self.name!r}: angle of {joint!r} is {angle!r}, expected a finite angle in "
                    "[rad], at most two turns"
                )

    @property
    def table(self) -> Counts:
        """The counts, shape (n, channels), in [count]."""
        return np.asarray(self.counts, dtype=np.int64)

    def reading(self, channel: int, kind: SensorKind) -> Reading:
        """What one channel read.

        Args:
            channel: The channel, from 0.
            kind: Its sensor.

        Returns:
            The reading.

        Raises:
            CalibrationError: If there is no such channel.

        Source:
            None (statistics).
        """
        if not 0 <= channel < self.table.shape[1]:
            raise CalibrationError(
                f"posture {self.name!r} has counts of {self.table.shape[1]} channels, but a joint is said to "
                f"be on channel {channel}"
            )
        counts = self.table[:, channel]
        if kind is SensorKind.ENCODER:
            counts = counts[0] + signed_step(counts - counts[0])
        return Reading.of(counts)


@dataclass(frozen=True, slots=True)
class Reading:
    """Counts of one channel in one posture.

    Attributes:
        mean: Their mean, in [count].
        error: Standard error of it as a measure of where the joint was held, in [count].
        lowest: The lowest, in [count].
        highest: The highest, in [count].
        spread: Range of all but the 5 % furthest out, which noise of a still joint makes wider and wider the
            longer it is held, in [count].
        n: How many.
    """

    mean: float
    error: float
    lowest: float
    highest: float
    spread: float
    n: int

    @staticmethod
    def of(counts: Counts) -> Reading:
        """Mean and standard error of counts, rounding included.

        error² = s² / n + r² with r² = exp(-4π² (s² - 1/12)) / 12. Rounding moves the mean of quiet counts by
        up to half a count however many there are; noise averages it away. Counts that toggle between two
        values (s² ≤ 0.3) may still be quiet ones next to an edge: r² = 1/12.

        Args:
            counts: Counts, shape (n,), in [count].

        Returns:
            The reading.

        Source:
            Widrow, B.; Kollár, I. (2008), Quantization Noise, ch. 4 (rounding of a noisy signal).
        """
        n = len(counts)
        variance = float(counts.var(ddof=1)) if n > 1 else 0.0
        noisy = variance > _TOGGLING
        rounding = math.exp(-4 * math.pi**2 * (variance - 1 / 12)) / 12 if noisy else 1 / 12
        error = math.sqrt(variance / n + rounding)
        low, high = np.quantile(counts, (0.025, 0.975))
        lowest, highest = float(counts.min()), float(counts.max())
        return Reading(float(counts.mean()), error, lowest, highest, float(high - low), n)
