"""The program of a simulated device: frames at their time, in small batches, through a line that fails."""

from __future__ import annotations

import threading
from collections import deque

from armik_sym.device.simulator.clock import Clock
from armik_sym.device.simulator.frame_queue import FrameQueue
from armik_sym.device.simulator.line import Line, ReaderGoneError
from armik_sym.device.simulator.simulated_device import SimulatedDevice, WireFrame
from armik_sym.device.simulator.truth import Fate, Truth

_POLL = 0.01
_ROOM = 0.05
_DRAINED_WITHIN = 2.0
_SHORTEST_SAMPLE = 21


class Sender(threading.Thread):
    """Plays a device on a line until it is told to stop.

    The device starts when a reader first opens the port. In real time it then goes on whatever happens to
    the port, and samples that nobody could receive are not sent; as fast as the reader takes them
    (`speed=None`) it pauses instead.

    Attributes:
        truth: The fate of every sample so far.
        finished: Set when everything was sent, and on a pseudo-terminal also read, or nobody reads it.
        latest: By how much a sample was late at most, in [s].
        error: What ended the thread early, if anything did.
    """

    def __init__(
        self, device: SimulatedDevice, line: Line, speed: float | None, seconds: float | None
    ) -> None:
        """Prepare; the line is open already.

        Args:
            device: The device.
            line: Its port.
            speed: Device seconds per second; None: as fast as the reader takes them.
            seconds: Device time after which nothing more is sent, in [s]; None: never.
        """
        super().__init__(name="armik simulated device", daemon=True)
        self.truth = Truth(device.first_sequence)
        self.finished = threading.Event()
        self.latest = 0.0
        self.error: Exception | None = None
        self._faults = device.faults
        self._line = line
        self._queue = FrameQueue(device)
        self._clock = Clock(speed)
        self._end = float("inf") if seconds is None else seconds
        self._closures = deque(sorted(at for at in device.faults.close_at if at < self._end))
        self._stopping = threading.Event()

    def stop(self) -> None:
        """Ask the thread to end soon."""
        self._stopping.set()

    def run(self) -> None:
        """Send until stopped; called by the thread."""
        try:
            self._play()
            self._drain()
            self.finished.set()
            # The port stays open, silent: closing it is a fault of its own, or the end of the whole.
            self._stopping.wait()
        except Exception as error:  # noqa: BLE001 - handed to the thread that serves the port
            self.error = error
        finally:
            self.finished.set()
            self._line.close()

    def _play(self) -> None:
        if not self._reader_came():
            return
        self._clock.start()
        while not self._stopping.is_set():
            if self._clock.free and not self._reader_came():
                return
            until = min(self._clock.next(self._stopping), self._end)
            if self._closures and until >= self._closures[0]:
                until = self._closures.popleft()
                self._send(self._queue.due(until))
                self._hang_up(until)
            else:
                self._send(self._queue.due(until))
            if until >= self._end:
                return

    def _reader_came(self) -> bool:
        """Wait for a reader; False if stopped before one came."""
        while not self._line.ready():
            if self._stopping.wait(_POLL):
                return False
        return True

    def _send(self, frames: list[WireFrame]) -> None:
        """Send frames that are due, and note what became of each."""
        if self._faults.silent:
            frames = [frame for frame in frames if not self._skipped_in_silence(frame)]
        sent = 0
        if frames and self._line.ready():
            sent = self._write(b"".join([frame.data for frame in frames]))
            self.latest = max(self.latest, self._clock.late(frames[0].time))
        for frame in frames:
            sent -= len(frame.data)
            if frame.number is not None:
                fate = Fate.NOT_SENT if sent < 0 else Fate.WHOLE if frame.whole else Fate.TOUCHED
                self.truth.set(frame.number, fate)

    def _skipped_in_silence(self, frame: WireFrame) -> bool:
        silent = self._faults.is_silent(frame.time)
        if silent and frame.number is not None:
            self.truth.set(frame.number, Fate.NOT_SENT)
        return silent

    def _write(self, data: bytes) -> int:
        """Write all, waiting for room; how many bytes were taken before the reader left."""
        rest = memoryview(data)
        try:
            while rest and not self._stopping.is_set():
                taken = self._line.write(rest)
                rest = rest[taken:]
                if not taken:
                    self._line.wait(_ROOM)
        except ReaderGoneError:
            pass
        return len(data) - len(rest)

    def _hang_up(self, at: float) -> None:
        """Close the port in the middle of a frame, and open it again later."""
        torn = self._queue.take()
        if self._line.ready():
            half = self._write(torn.data[: len(torn.data) // 2])
            if torn.number is not None:
                self.truth.set(torn.number, Fate.TOUCHED if half else Fate.NOT_SENT)
            self._drain()
            self.truth.forget_latest(self._line.unread() // _SHORTEST_SAMPLE)
        self._line.close()
        back = at + self._faults.closed_for
        while not self._clock.sleep_until(min(back, self._end), self._stopping):
            pass
        for frame in self._queue.due(min(back, self._end)):
            if frame.number is not None:
                self.truth.set(frame.number, Fate.NOT_SENT)
        if not self._stopping.is_set():
            self._line.open()

    def _drain(self) -> None:
        """Wait until the reader has read everything, though not for ever."""
        waited = 0.0
        while waited < _DRAINED_WITHIN and self._line.ready() and self._line.unread():
            if self._stopping.wait(_POLL):
                return
            waited += _POLL
