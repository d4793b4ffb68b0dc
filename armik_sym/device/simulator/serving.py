"""A simulated device on a pseudo-terminal or a socket, for as long as a `with` block lasts."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from armik_sym.device.simulator.line import Line
from armik_sym.device.simulator.pty_line import PtyLine
from armik_sym.device.simulator.sender import Sender
from armik_sym.device.simulator.simulated_device import SimulatedDevice
from armik_sym.device.simulator.socket_line import SocketLine
from armik_sym.device.simulator.truth import Truth
from armik_sym.errors import DeviceError

_ENDS_WITHIN = 10.0


@dataclass(frozen=True, eq=False)
class ServedDevice:
    """A simulated device that runs beside the program.

    Attributes:
        device: The device.
        port: What to open: a path, or a URL for pyserial.
    """

    device: SimulatedDevice
    port: str
    _sender: Sender

    @property
    def truth(self) -> Truth:
        """The fate of every sample so far."""
        return self._sender.truth

    @property
    def latest(self) -> float:
        """By how much a sample was late at most so far, because of the reader or a busy machine, in [s]."""
        return self._sender.latest

    @property
    def finished(self) -> bool:
        """Whether everything was sent, and on a pseudo-terminal also read, if there still is a reader."""
        return self._sender.finished.is_set()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until everything was sent, and on a pseudo-terminal also read.

        Args:
            seconds: At most this long, in [s]; None: as long as it takes.

        Returns:
            Whether it was.

        Raises:
            DeviceError: If the port failed.

        Source:
            None (this package).
        """
        done = self._sender.finished.wait(seconds)
        self.check()
        return done

    def check(self) -> None:
        """Check that the device still runs.

        Raises:
            DeviceError: If the port failed.
        """
        error = self._sender.error
        if error is not None:
            raise DeviceError(f"the simulated device at {self.port} stopped: {error}") from error


@contextmanager
def serve_pty(
    device: SimulatedDevice,
    speed: float | None = 1.0,
    seconds: float | None = None,
    link: str | os.PathLike[str] | None = None,
) -> Iterator[ServedDevice]:
    """Play a device on a pseudo-terminal: the same path a serial port has, kernel included.

    The device starts when the port is first opened. When the port is closed and opened again (a fault),
    the terminal behind the path is another one; the path stays.

    Args:
        device: The device.
        speed: Device seconds per second; None: as fast as the reader takes them.
        seconds: Device time after which nothing more is sent, in [s]; None: never.
        link: Path of the port; None: one in a temporary folder.

    Yields:
        The running device.

    Raises:
        DeviceError: If this system has no pseudo-terminals (Windows), or the path cannot be used.
        OptionError: If the speed is not positive.

    Source:
        None (this package).
    """
    folder = None if link is not None else Path(tempfile.mkdtemp(prefix="armik_device_"))
    try:
        place = folder / "port" if folder is not None else Path(os.fspath(link or ""))
        with _serving(device, PtyLine(place), speed, seconds) as served:
            yield served
    finally:
        if folder is not None:
            shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def serve_socket(
    device: SimulatedDevice,
    speed: float | None = 1.0,
    seconds: float | None = None,
    host: str = "127.0.0.1",
    port: int = 0,
) -> Iterator[ServedDevice]:
    """Play a device on a TCP port, on every system.

    The device starts when the port is first opened, a moment later, because readers empty a port when they
    open it.

    Args:
        device: The device.
        speed: Device seconds per second; None: as fast as the reader takes them.
        seconds: Device time after which nothing more is sent, in [s]; None: never.
        host: Address to listen at.
        port: Number of the port; 0 for any that is free.

    Yields:
        The running device; its port is a URL such as socket://127.0.0.1:4400.

    Raises:
        DeviceError: If the address cannot be used.
        OptionError: If the speed is not positive.

    Source:
        None (this package).
    """
    with _serving(device, SocketLine(host, port), speed, seconds) as served:
        yield served


@contextmanager
def _serving(
    device: SimulatedDevice, line: Line, speed: float | None, seconds: float | None
) -> Iterator[ServedDevice]:
    sender = Sender(device, line, speed, seconds)
    line.open()
    served = ServedDevice(device, line.port, sender)
    sender.start()
    try:
        yield served
    finally:
        sender.stop()
        sender.join(_ENDS_WITHIN)
