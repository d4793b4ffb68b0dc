"""Records what a device sends, as it arrives, until it is told to stop."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable
from pathlib import Path

from armik_sym._version import __version__
from armik_sym.device.calibration import Calibration, calibration_text
from armik_sym.device.protocol import Sample
from armik_sym.device.recording.diagnosis import why_no_samples
from armik_sym.device.recording.host_frames import (
    FILE_VERSION,
    EndMark,
    EndReason,
    Header,
    Stamp,
    Topic,
    WarningMark,
    clocks,
    encode_host,
    encode_text,
)
from armik_sym.device.recording.line import Arrival, Line
from armik_sym.device.recording.port import DEFAULT_BAUD
from armik_sym.device.recording.record_file import RecordFile
from armik_sym.device.recording.status import RecorderStatus, RecordingSummary
from armik_sym.device.recording.tally import Tally
from armik_sym.errors import CalibrationError, DeviceError, MotionFileError, OptionError

WAIT_FOR_SAMPLES = 3.0
"""Time in which the first sample has to come, in [s]; boards that restart when opened need two seconds."""

_SECOND = 1_000_000_000
_STAMP_EVERY = 0.1 * _SECOND
_MOST_NOTICES = 100
_FINISH_FRAME = 0.2  # [s]
_REFUSE_WITHIN = 5.0  # [s]


class Recorder:
    """Records one device into one file.

    Bytes go to the file as they come, before anything is made of them; what is counted, marked or shown
    comes after. So a bug, a kill or a power cut costs what was on its way, and no more. A cable that is
    pulled leaves a marked gap, and the recorder tries until the device is back.

    Source:
        None (this package); docs/device.md.
    """

    def __init__(
        self,
        port: str,
        file: str | os.PathLike[str],
        *,
        baud: int = DEFAULT_BAUD,
        calibration: Calibration | None = None,
        wait: float = WAIT_FOR_SAMPLES,
        notices: Callable[[str], None] | None = None,
    ) -> None:
        """Prepare a recording; `run` begins it.

        Args:
            port: /dev/ttyUSB0, COM3, socket://HOST:PORT, rfc2217://HOST:PORT and what else pyserial takes.
            file: The recording to write, ending `.armikrec`; it must not exist.
            baud: Bits per second; USB devices without a converter ignore it.
            calibration: Written into the recording; refused if it is another device's.
            wait: Time in which the first sample has to come, in [s].
            notices: Called with a sentence when something is odd: a lost line, a restart, a stuck sensor.

        Raises:
            OptionError: If `baud` or `wait` is not positive.
        """
        if baud <= 0 or not wait > 0:
            raise OptionError(f"baud is {baud}, wait {wait:g} s: both have to be positive")
        self.path = Path(file)
        self._calibration = calibration
        self._wait = wait
        self._baud = baud
        self._listener = notices
        self._notices: list[str] = []
        self._line = Line(port, baud, self._notice)
        self._tally = Tally(self._notice)
        self._marks = b""
        self._stamped = 0
        self._stopping = False
        self._began = time.monotonic_ns()
        self._ended: int | None = None
        self._info_checked = calibration is None
        self._warned_start = False

    def stop(self) -> None:
        """End the recording soon, from a signal handler or another thread."""
        self._stopping = True

    def status(self) -> RecorderStatus:
        """How the recording stands; can be called from another thread.

        Returns:
            The counters.
        """
        tally, counts = self._tally, self._tally.parser.counts
        now = self._ended or time.monotonic_ns()
        return RecorderStatus(
            seconds=(now - self._began) / _SECOND,
            connected=self._line.connected,
            samples=counts.samples,
            rate=tally.rate(now),
            lost=tally.counter.lost,
            damaged=counts.damaged + counts.malformed,
            unknown_version=counts.unknown_version,
            gaps=self._line.gaps,
            restarts=tally.counter.restarts,
            warnings=tally.warnings,
            info=tally.info,
            sample=tally.sample,
        )

    def take_recent(self) -> list[Sample]:
        """Samples since the last call, to show them; can be called from another thread.

        Returns:
            The samples, the latest thousand at most.
        """
        recent = self._tally.recent
        return [recent.popleft() for _ in range(len(recent))]

    def run(self, seconds: float | None = None) -> RecordingSummary:
        """Record until `stop` is called, the time is over, or Ctrl-C.

        Args:
            seconds: How long, in [s]; None: without end.

        Returns:
            What the recording came to.

        Raises:
            MotionFileError: If the file exists or cannot be made, or the disk is full; what is written stays.
            DeviceError: If the port cannot be opened, or no sample comes; no file is left then.
            CalibrationError: If the calibration belongs to another device; no file is left then.
            OptionError: If `seconds` is not positive.

        Source:
            None (this package).
        """
        if seconds is not None and not seconds > 0:
            raise OptionError(f"seconds is {seconds!r}, expected a positive number")
        file = RecordFile(self.path)
        reason = EndReason.FAILED
        try:
            self._begin(file)
            self._line.open()
            self._began = self._stamped = time.monotonic_ns()
            reason = self._record(file, seconds)
        except KeyboardInterrupt:
            reason = EndReason.STOPPED
            raise
        except (DeviceError, CalibrationError):
            file.discard()
            raise
        finally:
            self._ended = time.monotonic_ns()
            self._line.close()
            self._end(file, reason)
        return RecordingSummary(self.path, self.status(), file.size, tuple(self._notices))

    def _begin(self, file: RecordFile) -> None:
        clock, steady = clocks()
        file.append(
            encode_host(Header(FILE_VERSION, clock, steady))
            + encode_text(Topic.PORT, self._line.url)
            + encode_text(Topic.PROGRAM, f"armik_sym {__version__}")
        )
        if self._calibration is not None:
            file.append(encode_text(Topic.CALIBRATION, calibration_text(self._calibration)))

    def _record(self, file: RecordFile, seconds: float | None) -> EndReason:
        end = None if seconds is None else self._began + seconds * _SECOND
        while not self._stopping and (end is None or time.monotonic_ns() < end):
            arrival = self._line.read()
            self._keep(file, arrival)
            self._understand(arrival)
        if not self._tally.samples:
            why = self._why_no_samples()
            raise DeviceError(f"{self._line.url}: ended before a sample came, nothing was recorded: {why}")
        self._finish_frame(file)
        return EndReason.STOPPED if end is None or self._stopping else EndReason.TIME_OVER

    def _keep(self, file: RecordFile, arrival: Arrival) -> None:
        """Write what came, and what is to be marked, at a boundary between frames, in one go."""
        data = arrival.data
        boundary = data.rfind(b"\0") + 1
        if boundary and arrival.steady_ns - self._stamped >= _STAMP_EVERY:
            self._stamped = arrival.steady_ns
            clock, steady = clocks()
            self._marks += encode_host(Stamp(clock - steady + arrival.steady_ns, arrival.steady_ns))
        front, behind = arrival.front, arrival.behind
        if self._tally.parser.pending:
            # A line that fell silent within a frame may yet send the rest of it: marks have to wait.
            if front and not arrival.reopened:
                self._marks, front = self._marks + front, b""
            if behind and not arrival.lost:
                self._marks, behind = self._marks + behind, b""
        if boundary and self._marks:
            data, self._marks = data[:boundary] + self._marks + data[boundary:], b""
        if front or data or behind:
            file.append(front + data + behind)

    def _understand(self, arrival: Arrival) -> None:
        """Count what came, check it, and prepare marks for what is odd."""
        if arrival.data:
            restarts = self._tally.counter.restarts
            for each in self._tally.take(arrival.data, arrival.steady_ns, arrival.gap, arrival.reopened):
                self._notice(str(each))
                self._marks += encode_host(
                    WarningMark(each.kind.value, each.channel, each.sequence, each.times, each.value)
                )
            if self._tally.counter.restarts > restarts:
                self._stamped = 0
        if not self._info_checked and self._tally.info is not None:
            self._check_calibration()
        if not self._tally.samples:
            self._check_start(arrival.steady_ns)

    def _check_calibration(self) -> None:
        self._info_checked = True
        if self._calibration is None or self._tally.info is None:
            return
        try:
            self._calibration.check_device(self._tally.info)
        except CalibrationError as error:
            if self.status().seconds < _REFUSE_WITHIN:
                raise
            self._notice(str(error))

    def _check_start(self, now: int) -> None:
        """Say after a second why nothing can be recorded, and give up after `wait`."""
        waited = (now - self._began) / _SECOND
        if waited < min(1.0, self._wait):
            return
        why = self._why_no_samples()
        if waited >= self._wait:
            raise DeviceError(f"{self._line.url}: no sample within {self._wait:g} s: {why}")
        if not self._warned_start:
            self._warned_start = True
            self._notice(
                f"{self._line.url}: no sample within a second: {why}. Waiting until {self._wait:g} s, as "
                "boards that restart when their port is opened need two"
            )

    def _why_no_samples(self) -> str:
        line = self._line
        return why_no_samples(self._tally.parser, line.received, line.first_bytes, self._baud, line.url)

    def _finish_frame(self, file: RecordFile) -> None:
        """Take the rest of the frame that is on its way, so that the recording ends between two frames."""
        until = time.monotonic() + _FINISH_FRAME
        while self._tally.parser.pending and self._line.connected and time.monotonic() < until:
            arrival = self._line.read()
            boundary = arrival.data.find(b"\0") + 1
            rest = Arrival(arrival.data[: boundary or None], arrival.steady_ns, behind=arrival.behind)
            self._keep(file, rest)
            self._understand(rest)

    def _end(self, file: RecordFile, reason: EndReason) -> None:
        if file.closed:
            return
        clock, steady = clocks()
        at = self.status()
        end = EndMark(reason.value, clock, steady, at.samples, at.lost, at.damaged)
        with contextlib.suppress(MotionFileError):
            file.append(self._marks + encode_host(end))
        file.close()

    def _notice(self, text: str) -> None:
        if len(self._notices) < _MOST_NOTICES:
            self._notices.append(text)
        if self._listener is not None:
            self._listener(text)
