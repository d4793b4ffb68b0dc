"""Sensors that stop or jump: counts as they would be, made into counts as they are sent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.channels import Channel, SensorKind
from armik_sym.device.simulator.encoder import REGISTER
from armik_sym.device.simulator.faults import Faults

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


class SensorFaults:
    """Applies jumps, then stuck channels, to one block of samples after another."""

    def __init__(self, faults: Faults, channels: tuple[Channel, ...]) -> None:
        """Start before the first sample.

        Args:
            faults: What goes wrong.
            channels: The channels of the device.
        """
        self._faults = faults
        self._channels = channels
        self._held: dict[int, int] = {}

    def apply(self, time: Array, counts: Counts) -> None:
        """Change the counts of the next samples in place.

        Args:
            time: Device times, shape (n,), in [s].
            counts: Counts, shape (n, channels); changed where a sensor fails.

        Source:
            None (this package).
        """
        for jump in self._faults.jumps:
            column = counts[:, jump.channel]
            column[time >= jump.at] += jump.counts
            channel = self._channels[jump.channel]
            if channel.kind is SensorKind.ENCODER:
                column %= REGISTER
            else:
                np.clip(column, 0, channel.span - 1, out=column)
        for number, stuck in enumerate(self._faults.stuck):
            rows = np.flatnonzero((time >= stuck.start) & (time < stuck.end))
            if len(rows):
                held = self._held.setdefault(number, int(counts[rows[0], stuck.channel]))
                counts[rows, stuck.channel] = held
