"""Counts what comes through the line, sample by sample, in memory that does not grow."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from armik_sym.device.channels import DeviceInfo
from armik_sym.device.protocol import Frame, FrameParser, Sample
from armik_sym.device.protocol.frames import VERSION
from armik_sym.device.recording.health import SensorHealth
from armik_sym.device.recording.sensor_warning import SensorWarning
from armik_sym.device.recording.sequence import SequenceCounter

_SECOND = 1_000_000_000
_ROUND = 1 << 32
_RECENT = 1000


class Tally:
    """Samples, losses, damage, restarts and warnings of a line.

    Attributes:
        parser: Makes frames of the bytes.
        counter: Knows which samples are missing.
        info: What the device said about itself last.
        sample: The latest sample.
        recent: The latest samples that nobody took yet, at most 1,000.
        warnings: How many warnings about sensors there were.
        notices: Called with a sentence when the device does something unexpected.
    """

    def __init__(self, notices: Callable[[str], None]) -> None:
        """Start at zero.

        Args:
            notices: Called with a sentence when the device does something unexpected.
        """
        self.parser = FrameParser()
        self.counter = SequenceCounter()
        self.info: DeviceInfo | None = None
        self.sample: Sample | None = None
        self.warnings = 0
        self.notices = notices
        self._health: SensorHealth | None = None
        self._odd_lengths = 0
        self._versions: set[int] = set()
        self.recent: deque[Sample] = deque(maxlen=_RECENT)
        self._seconds: deque[tuple[int, int]] = deque(maxlen=64)

    @property
    def samples(self) -> int:
        """Samples so far."""
        return self.parser.counts.samples

    def rate(self, steady_ns: int) -> float:
        """Samples per second over the latest second.

        Args:
            steady_ns: The steady clock now, in [ns].

        Returns:
            The rate, in [Hz].

        Source:
            None (bookkeeping).
        """
        points = list(self._seconds)
        recent = next((each for each in points if steady_ns - each[0] <= 1.2 * _SECOND), None)
        if recent is None or steady_ns <= recent[0]:
            return 0.0
        return (self.samples - recent[1]) * _SECOND / (steady_ns - recent[0])

    def take(
        self, data: bytes, steady_ns: int, gap: float = 0.0, reopened: bool = False
    ) -> list[SensorWarning]:
        """Count the next bytes.

        Args:
            data: The bytes.
            steady_ns: The steady clock when they had come, in [ns].
            gap: How long nothing had come before them, if that is worth speaking of, in [s].
            reopened: Whether the port was lost before them.

        Returns:
            What is odd about the sensors.

        Source:
            None (bookkeeping).
        """
        if not self._seconds or steady_ns - self._seconds[-1][0] >= 0.1 * _SECOND:
            self._seconds.append((steady_ns, self.samples))
        found: list[SensorWarning] = []
        if reopened:
            # The mark of the gap in the file ends what the end of the line cut off; so it is counted here.
            for frame in self.parser.feed(b"\0"):
                found += self._frame(frame, 0.0, False)
        for frame in self.parser.feed(data):
            found += self._frame(frame, gap, reopened)
            if isinstance(frame, Sample):
                gap, reopened = 0.0, False
        if self.parser.versions_seen - self._versions:
            self._new_versions()
        self.warnings += len(found)
        return found

    def _frame(self, frame: Frame, gap: float, reopened: bool) -> list[SensorWarning]:
        if isinstance(frame, Sample):
            return self._sample(frame, gap, reopened)
        if isinstance(frame, DeviceInfo) and frame != self.info:
            self._new_info(frame)
        return []

    def _sample(self, sample: Sample, gap: float, reopened: bool) -> list[SensorWarning]:
        before, self.sample = self.sample, sample
        self.recent.append(sample)
        restarted = self.counter.step(sample.sequence, sample.time_us, gap, reopened)
        if restarted:
            self.notices("the device restarted: its numbers and its clock began anew")
        if self.info is not None and len(sample.counts) != len(self.info.channels):
            self._odd_lengths += 1
            if self._odd_lengths == 1:
                self.notices(
                    f"samples have {len(sample.counts)} counts, but the device says it has "
                    f"{len(self.info.channels)} channels: the firmware contradicts itself"
                )
        if self._health is None:
            return []
        if gap or restarted or before is None:
            self._health.interrupted()
        elapsed = 0.0 if before is None else (sample.time_us - before.time_us) % _ROUND * 1e-6
        return self._health.look(sample, 0.0 if restarted else elapsed)

    def _new_info(self, info: DeviceInfo) -> None:
        if self.info is not None:
            other = (
                "another device"
                if info.device_id != self.info.device_id
                else "the device with other settings"
            )
            self.notices(f"{other} answers now: id {info.device_id}, {info.rate:g} Hz, {info.firmware!r}")
        self.info = info
        self.counter.rate = info.rate
        self._health = SensorHealth(info)

    def _new_versions(self) -> None:
        others = sorted(self.parser.versions_seen - self._versions - {VERSION})
        self._versions |= self.parser.versions_seen
        if others:
            self.notices(
                f"frames of protocol version {', '.join(map(str, others))} come, this package speaks version "
                f"{VERSION}: they are not understood"
            )
