"""When each sample was measured: the clock of the device, tied to that of the host where it broke off."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from datetime import datetime, timezone

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.recording.gap import Gap

Array = NDArray[np.float64]

_WRAP = 1 << 32
_MICROSECOND = 1e-6
_NANOSECOND = 1e-9


class DeviceClock:
    """Times of samples by the device, and of the moments at which the host looked at its own clocks.

    The device's clock has the samples' true distances; the host's has delays of the line in it. So within one
    run of the device its own clock counts. A run that began anew is placed by the host's clock: a stamp of
    the host lies behind the sample in front of it by the delay, so the smallest difference of both clocks is
    the one with the least delay.
    """

    def __init__(self) -> None:
        """Start in front of the first sample."""
        self._device = array("q")
        self._stamps: list[tuple[int, int, int]] = []

    def sample(self, wraps: int, time_us: int) -> None:
        """Note the next sample.

        Args:
            wraps: How often the device's clock wrapped since it began.
            time_us: What it says, modulo 2^32, in [µs].

        Source:
            None (bookkeeping).
        """
        self._device.append(wraps * _WRAP + time_us)

    def stamp(self, clock_ns: int, steady_ns: int) -> None:
        """Note both clocks of the host after the latest sample.

        Args:
            clock_ns: Time since 1970, in [ns].
            steady_ns: The clock that is never set, in [ns].

        Source:
            None (bookkeeping).
        """
        self._stamps.append((len(self._device) - 1, clock_ns, steady_ns))

    def times(
        self, restarts: Sequence[int], gaps: Sequence[Gap], period: float
    ) -> tuple[Array, datetime | None]:
        """Times of all samples from the first one on.

        Args:
            restarts: Rows of the first samples of each further run of the device.
            gaps: Where nothing came, for runs without a stamp.
            period: Time between two samples, in [s].

        Returns:
            Times, shape (n,), in [s], and when the first sample was measured, if the host stamped it.

        Source:
            None (this package).
        """
        time = np.array(self._device, dtype=np.float64) * _MICROSECOND
        if not len(time):
            return time, None
        time -= time[0]
        offsets = [self._offset(time, *run) for run in self._runs(restarts)]
        for (begin, end), offset in list(zip(self._runs(restarts), offsets, strict=True))[1:]:
            pause = next((gap.seconds for gap in gaps if gap.sample == begin), period)
            earliest = time[begin - 1] + (period or _MICROSECOND)
            if offset is not None and offsets[0] is not None:
                target = time[begin] + offset - offsets[0]
            else:
                target = time[begin - 1] + pause
            time[begin:end] += max(target, earliest) - time[begin]
        return time, self._start(offsets[0])

    def _runs(self, restarts: Sequence[int]) -> list[tuple[int, int]]:
        edges = [0, *restarts, len(self._device)]
        return [(edges[k], edges[k + 1]) for k in range(len(edges) - 1)]

    def _offset(self, time: Array, begin: int, end: int) -> float | None:
        """Host's steady clock minus device's over one run, with the least delay, in [s]."""
        differences = [
            steady * _NANOSECOND - time[row] for row, _, steady in self._stamps if begin <= row < end
        ]
        return min(differences) if differences else None

    def _start(self, offset: float | None) -> datetime | None:
        """When the first sample was measured, by the calendar."""
        if offset is None:
            return None
        _, clock, steady = self._stamps[0]
        return datetime.fromtimestamp(clock * _NANOSECOND + offset - steady * _NANOSECOND, timezone.utc)
