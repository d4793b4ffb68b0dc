"""Puts the frames of a recording in order: which sample came when, and what happened in between."""

from __future__ import annotations

import math
from array import array
from pathlib import Path

import numpy as np

from armik_sym.device.channels import DeviceInfo
from armik_sym.device.protocol import Frame, OtherFrame, Sample
from armik_sym.device.recording.device_recording import NO_INDEX, DeviceRecording
from armik_sym.device.recording.gap import Gap
from armik_sym.device.recording.host_frames import (
    EndMark,
    GapMark,
    GapReason,
    Header,
    Stamp,
    TextPiece,
    Topic,
    WarningMark,
    decode_host,
)
from armik_sym.device.recording.sample_times import DeviceClock
from armik_sym.device.recording.sensor_warning import SensorWarning, WarningKind
from armik_sym.device.recording.sequence import SequenceCounter

_SECOND = 1_000_000_000


class Collector:
    """Takes the frames of a recording in their order.

    Attributes:
        header: The first frame the recorder wrote, if it is there.
    """

    def __init__(self) -> None:
        """Start in front of the first frame."""
        self.header: Header | None = None
        self._infos: list[DeviceInfo] = []
        self._counter = SequenceCounter()
        self._clock = DeviceClock()
        self._channels = 0
        self._strange = 0
        self._numbers, self._counts, self._index = array("q"), array("H"), array("B")
        self._pulses: list[tuple[int, int, int]] = []
        self._restarts: list[int] = []
        self._gaps: list[Gap] = []
        self._open_gap: GapMark | None = None
        self._silence = (0.0, False)
        self._texts: dict[Topic, dict[int, bytes]] = {}
        self._lengths: dict[Topic, int] = {}
        self._warnings: list[SensorWarning] = []
        self._end: EndMark | None = None

    def take(self, frame: Frame) -> None:
        """Take the next frame.

        Args:
            frame: A frame of the device or of the recorder.

        Source:
            None (bookkeeping).
        """
        if isinstance(frame, Sample):
            self._sample(frame)
        elif isinstance(frame, DeviceInfo):
            self._counter.rate = frame.rate
            if frame not in self._infos:
                self._infos.append(frame)
        else:
            self._host(frame)

    def _sample(self, sample: Sample) -> None:
        self._channels = self._channels or len(sample.counts)
        if len(sample.counts) != self._channels:
            self._strange += 1
            return
        row, lost = len(self._numbers), self._counter.lost
        gap, reopened = self._silence
        if self._counter.step(sample.sequence, sample.time_us, gap, reopened):
            self._restarts.append(row)
        if gap:
            last = self._gaps[-1]
            self._gaps[-1] = Gap(row, last.reason, last.seconds, self._counter.lost - lost)
            self._silence = (0.0, False)
        self._numbers.append(self._counter.number)
        self._clock.sample(self._counter.wraps, sample.time_us)
        self._counts.extend(sample.counts)
        self._index.append(sample.index)
        if sample.index:
            flagged = [channel for channel in range(self._channels) if sample.index >> channel & 1]
            self._pulses += [(row, *pair) for pair in zip(flagged, sample.index_counts, strict=True)]

    def _host(self, frame: OtherFrame) -> None:
        found = decode_host(frame)
        if isinstance(found, Stamp):
            self._clock.stamp(found.clock_ns, found.steady_ns)
        elif isinstance(found, GapMark):
            self._gap(found)
        elif isinstance(found, WarningMark):
            self._warning(found)
        elif isinstance(found, TextPiece) and found.topic in {topic.value for topic in Topic}:
            topic = Topic(found.topic)
            self._lengths[topic] = found.pieces
            self._texts.setdefault(topic, {})[found.piece] = found.text
        elif isinstance(found, Header):
            self.header = self.header or found
        elif isinstance(found, EndMark):
            self._end = found

    def _gap(self, mark: GapMark) -> None:
        if mark.reason != GapReason.BACK.value:
            reason = GapReason(mark.reason) if mark.reason in (1, 2) else GapReason.SILENCE
            if self._open_gap is None:
                self._open_gap = mark
                self._gaps.append(Gap(len(self._numbers), reason, math.nan, 0))
            elif self._gaps[-1].reason is not reason:
                # First silence, then the port was lost.
                self._gaps[-1] = Gap(len(self._numbers), GapReason.PORT_LOST, math.nan, 0)
        elif self._open_gap is not None:
            seconds = (mark.steady_ns - self._open_gap.steady_ns) / _SECOND
            last = self._gaps[-1]
            self._gaps[-1] = Gap(last.sample, last.reason, seconds, 0)
            self._silence = (seconds, last.reason is GapReason.PORT_LOST)
            self._open_gap = None

    def _warning(self, mark: WarningMark) -> None:
        if mark.warning in {kind.value for kind in WarningKind}:
            kind = WarningKind(mark.warning)
            self._warnings.append(SensorWarning(kind, mark.channel, mark.sequence, mark.value, mark.times))

    def _text(self, topic: Topic) -> str | None:
        """A text, if all its pieces came through."""
        pieces = self._texts.get(topic, {})
        if not pieces or set(pieces) != set(range(self._lengths[topic])):
            return None
        return b"".join(pieces[number] for number in sorted(pieces)).decode("utf-8", "replace")

    def recording(self, path: Path, damaged: int, unknown_version: int, torn: bool) -> DeviceRecording:
        """All that was taken, as one recording.

        Args:
            path: The file.
            damaged: Pieces of it that are no frame.
            unknown_version: Frames of other versions of the protocol.
            torn: Whether it ends within a frame.

        Returns:
            The recording.

        Source:
            None (bookkeeping).
        """
        n = len(self._numbers)
        channels = self._channels or (len(self._infos[0].channels) if self._infos else 0)
        counts = np.array(self._counts, dtype=np.int64).reshape(n, channels)
        at_index = np.full_like(counts, NO_INDEX)
        for row, channel, count in self._pulses:
            at_index[row, channel] = count
        period = 1.0 / self._counter.rate if self._counter.rate else 0.0
        time, start = self._clock.times(self._restarts, self._gaps, period)
        return DeviceRecording(
            path=path,
            infos=tuple(self._infos),
            sequence=np.array(self._numbers, dtype=np.int64),
            time=time,
            counts=counts,
            at_index=at_index,
            gaps=tuple(self._gaps),
            restarts=tuple(self._restarts),
            lost=self._counter.lost,
            damaged=damaged,
            strange=self._strange,
            unknown_version=unknown_version,
            warnings=tuple(self._warnings),
            port=self._text(Topic.PORT),
            start=start,
            calibration_text=self._text(Topic.CALIBRATION),
            complete=self._end is not None and self._end.reason != 2,
            torn=torn,
        )
