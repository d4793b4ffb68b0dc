"""What every simulated sensor can do: turn joint angles into raw counts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.channels import Channel

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Readings:
    """What one sensor gave at some samples.

    Attributes:
        counts: Raw counts as in a frame, shape (n,).
        index: Whether the index pulse came since the sample before, shape (n,).
        index_counts: Register at that pulse, shape (n,); 0 where there was none.
    """

    counts: Counts
    index: NDArray[np.bool_]
    index_counts: Counts


class Reader(Protocol):
    """A sensor that is switched on: it remembers what came before."""

    def read(self, angle: Array) -> Readings:
        """Read the sensor at the next samples.

        Args:
            angle: True joint angles, shape (n,), in [rad].

        Returns:
            Counts and index pulses.

        Source:
            None (definition).
        """
        ...


class Sensor(Protocol):
    """A sensor as it was built in; its true parameters are what a calibration should find."""

    @property
    def channel(self) -> Channel:
        """What the device says about it."""
        ...

    @property
    def direction(self) -> int:
        """1 if counts rise with the joint angle, -1 if they fall."""
        ...

    @property
    def scale(self) -> float:
        """Joint angle per count, positive, in [rad]."""
        ...

    def switched_on(self, random: np.random.SeedSequence) -> Reader:
        """Switch the sensor on.

        Args:
            random: Where its noise comes from.

        Returns:
            Its reader.

        Source:
            None (definition).
        """
        ...
