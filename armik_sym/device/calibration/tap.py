"""A device that is listened to all the time, so that what is collected is fresh."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from armik_sym.device.channels import DeviceInfo
from armik_sym.device.protocol import FrameParser, Sample
from armik_sym.device.recording.diagnosis import why_no_samples
from armik_sym.device.recording.port import DEFAULT_BAUD, Port
from armik_sym.errors import DeviceError

WAIT_FOR_FRAMES = 3.0
"""Longest time without what is waited for, in [s]: an info comes once a second."""

_FIRST_BYTES = 256  # enough to see whether they are text

SETTLE = 0.2
"""Time after a key was pressed that is left out: the hand moves the arm, in [s]."""


class Tap:
    """Reads a port beside the program: samples only while somebody collects, info and index pulses always.

    Attributes:
        url: The port.
    """

    def __init__(self, port: Port) -> None:
        """Start to listen.

        Args:
            port: An open port; it is closed by `close`.
        """
        self.url = port.url
        self._port, self._parser = port, FrameParser()
        self._changed = threading.Condition()
        self._info: DeviceInfo | None = None
        self._pulses: dict[int, int] = {}
        self._collected: list[Sample] | None = None
        self._failure: DeviceError | None = None
        self._first_bytes = b""
        self._closing = False
        self._thread = threading.Thread(target=self._listen, name="armik calibrate", daemon=True)
        self._thread.start()

    def info(self) -> DeviceInfo:
        """What the device says about itself.

        Returns:
            The info.

        Raises:
            DeviceError: If it says nothing, or the line is lost.

        Source:
            None (this package).
        """
        with self._changed:
            if not self._changed.wait_for(lambda: self._info or self._failure, WAIT_FOR_FRAMES):
                raise DeviceError(f"{self.url}: {self._why_nothing()}")
            if self._info is None:
                raise self._failure or DeviceError(f"{self.url}: the line was lost")
            return self._info

    def collect(self, seconds: float) -> list[Sample]:
        """Collect samples from now on, less a moment for the hand to come to rest.

        Args:
            seconds: How long, in [s].

        Returns:
            The samples.

        Raises:
            DeviceError: If none come, or the line is lost.

        Source:
            None (this package).
        """
        rate = self.info().rate
        time.sleep(SETTLE)
        wanted = max(1, round(seconds * rate))
        with self._changed:
            self._collected = []
            complete = self._changed.wait_for(
                lambda: self._failure or len(self._collected or ()) >= wanted, seconds + WAIT_FOR_FRAMES
            )
            samples, self._collected = self._collected, None
            if self._failure is not None:
                raise self._failure
            if not complete:
                raise DeviceError(
                    f"{self.url}: {len(samples)} samples came in {seconds + WAIT_FOR_FRAMES:g} s, expected "
                    f"{wanted}: {self._why_nothing()}"
                )
        return samples[:wanted]

    def pulses(self) -> dict[int, int]:
        """Registers at the latest index pulses, by channel.

        Returns:
            Registers, in [count].

        Source:
            None (this package).
        """
        with self._changed:
            return dict(self._pulses)

    def close(self) -> None:
        """Stop listening and close the port."""
        self._closing = True
        self._thread.join(timeout=5.0)
        self._port.close()

    def _listen(self) -> None:
        while not self._closing:
            try:
                data = self._port.read()
            except DeviceError as error:
                with self._changed:
                    self._failure = error
                    self._changed.notify_all()
                return
            if len(self._first_bytes) < _FIRST_BYTES:
                self._first_bytes += data[:_FIRST_BYTES]
            frames = self._parser.feed(data)
            if frames:
                with self._changed:
                    for frame in frames:
                        self._take(frame)
                    self._changed.notify_all()

    def _take(self, frame: object) -> None:
        if isinstance(frame, DeviceInfo):
            self._info = frame
        elif isinstance(frame, Sample):
            flagged = [channel for channel in range(len(frame.counts)) if frame.index >> channel & 1]
            self._pulses.update(zip(flagged, frame.index_counts, strict=True))
            if self._collected is not None:
                self._collected.append(frame)

    def _why_nothing(self) -> str:
        counts = self._parser.counts
        if counts.samples:
            return "the device sends too little, or does not say what it is: look at its firmware"
        return why_no_samples(self._parser, counts.bytes_read, self._first_bytes, self._port.baud, self.url)


@contextmanager
def open_tap(url: str, baud: int = DEFAULT_BAUD) -> Iterator[Tap]:
    """Listen to a device for as long as a `with` block lasts.

    Args:
        url: The port.
        baud: Bits per second.

    Yields:
        The tap.

    Raises:
        DeviceError: If the port cannot be opened.

    Source:
        None (this package).
    """
    tap = Tap(Port(url, baud))
    try:
        yield tap
    finally:
        tap.close()
