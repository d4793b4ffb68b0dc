"""Watches the counts for sensors that are stuck, jump, or leave their scale."""

from __future__ import annotations

import math
from collections import deque

from armik_sym.device.channels import DeviceInfo, SensorKind
from armik_sym.device.protocol import Sample
from armik_sym.device.recording.sensor_warning import SensorWarning, WarningKind

FASTEST = math.radians(2000.0)
"""Speed of a joint beyond which a step is a jump, in [rad/s]: more than daily life and ball games need."""

STUCK_AFTER = 5.0
"""Time without one count of change after which a sensor is suspected, if another moved meanwhile, in [s]."""

MOVED = math.radians(10.0)
"""Movement of another sensor that makes a still one suspicious, in [rad]."""

_NOISE = 0.002  # of the span: what the converter's noise may add to a step
_LOOK_EVERY = 0.5  # [s], for stuck sensors
_SAY_EVERY = 1.0  # [s], for warnings of one kind and channel
_REGISTER = 1 << 16
_LONGEST_STEP = 0.5  # [s]; after a longer pause a step says nothing


class SensorHealth:
    """Looks at every sample of a device, in memory that does not grow.

    The first warning of a kind and channel is handed out at once, further ones at most once a second, with
    their number.
    """

    def __init__(self, info: DeviceInfo) -> None:
        """Start with a device.

        Args:
            info: Its channels and rate.
        """
        n = len(info.channels)
        self._spans = [channel.span for channel in info.channels]
        self._is_encoder = [channel.kind is SensorKind.ENCODER for channel in info.channels]
        per_turn = [span / math.tau for span in self._spans]
        self._per_second = [FASTEST * each for each in per_turn]
        self._noise = [2 + _NOISE * span for span in self._spans]
        self._moved = [MOVED * each for each in per_turn]
        self._time, self._next_look = 0.0, _LOOK_EVERY
        self._last: tuple[int, ...] | None = None
        self._changed = [0.0] * n
        self._stuck = [False] * n
        self._snapshots: deque[tuple[int, ...]] = deque(maxlen=round(STUCK_AFTER / _LOOK_EVERY) + 1)
        self._said: dict[tuple[WarningKind, int], float] = {}
        self._unsaid: dict[tuple[WarningKind, int], int] = {}

    def interrupted(self) -> None:
        """Forget the sample before: the line was lost, or the device restarted."""
        self._last = None
        self._snapshots.clear()
        self._changed = [self._time] * len(self._changed)

    def look(self, sample: Sample, elapsed: float) -> list[SensorWarning]:
        """Look at the next sample.

        Args:
            sample: The sample.
            elapsed: Time since the sample before by the device's clock, in [s].

        Returns:
            What is odd about it, mostly nothing.

        Source:
            None (this package).
        """
        counts = sample.counts
        if len(counts) != len(self._spans):
            return []
        self._time += elapsed
        found: list[SensorWarning] = []
        last = self._last
        if counts != last:
            for k, count in enumerate(counts):
                if last is not None and count != last[k]:
                    self._changed[k], self._stuck[k] = self._time, False
                    step = self._step(k, count - last[k])
                    if abs(step) > self._per_second[k] * elapsed + self._noise[k] and elapsed < _LONGEST_STEP:
                        self._find(found, WarningKind.JUMP, k, sample, step)
        for k, count in enumerate(counts):
            if not self._is_encoder[k] and not 0 < count < self._spans[k] - 1:
                outside = count >= self._spans[k]
                kind = WarningKind.OUT_OF_RANGE if outside else WarningKind.AT_END
                self._find(found, kind, k, sample, count)
        self._last = counts
        if self._time >= self._next_look:
            self._look_for_stuck(found, sample)
        return found

    def _step(self, channel: int, difference: int) -> int:
        """A difference of counts; that of a register may have gone over its end."""
        if not self._is_encoder[channel]:
            return difference
        return (difference + _REGISTER // 2) % _REGISTER - _REGISTER // 2

    def _look_for_stuck(self, found: list[SensorWarning], sample: Sample) -> None:
        self._next_look = self._time + _LOOK_EVERY
        self._snapshots.append(sample.counts)
        moving = [k for k in range(len(self._spans)) if self._travel(k) > self._moved[k]]
        for k, changed in enumerate(self._changed):
            still = self._time - changed
            if still >= STUCK_AFTER and not self._stuck[k] and any(other != k for other in moving):
                self._stuck[k] = True
                self._find(found, WarningKind.STUCK, k, sample, still)

    def _travel(self, channel: int) -> int:
        """How far a channel got from where it was at the first snapshot, in [count]."""
        first = self._snapshots[0][channel]
        return max(abs(self._step(channel, each[channel] - first)) for each in self._snapshots)

    def _find(
        self, found: list[SensorWarning], kind: WarningKind, channel: int, sample: Sample, value: float
    ) -> None:
        key = (kind, channel)
        times = self._unsaid.get(key, 0) + 1
        if self._time - self._said.get(key, -math.inf) < _SAY_EVERY:
            self._unsaid[key] = times
            return
        self._said[key], self._unsaid[key] = self._time, 0
        found.append(SensorWarning(kind, channel, sample.sequence, value, times))
