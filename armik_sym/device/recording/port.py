"""A serial port to read from: a device node, COM3, socket://, rfc2217://, loop://."""

from __future__ import annotations

import contextlib
import os
import select
from typing import Any

import serial

from armik_sym.device.recording.port_trouble import port_error
from armik_sym.errors import DeviceError

DEFAULT_BAUD = 500_000
"""Bits per second; 1,000 frames of seven channels take 330,000 (docs/device_protocol.md)."""

WAIT = 0.05
"""Longest time a read waits for the first byte, in [s]."""

_BLOCK = 65_536


class Port:
    """An open port that is read in blocks: wait for a byte, then take all that is there.

    The time-out of pyserial is set when the port is opened and never again: changing it configures the
    adapter anew, which damages bytes on the way (pyserial issue 394). Where the system can wait for a port or
    socket itself, pyserial reads without waiting: its own loop would drop what it holds when the line breaks.

    Attributes:
        url: What was asked for.
        baud: Bits per second.
        device: What was opened; another name than the URL if the device was plugged in elsewhere.

    Raises:
        DeviceError: If the port cannot be opened; the message says why and what to do.

    Source:
        pyserial 3.5 (`serial_for_url`).
    """

    def __init__(self, url: str, baud: int = DEFAULT_BAUD, device: str | None = None) -> None:
        self.url = url
        self.baud = baud
        self.device = device or url
        self._waits = _can_be_waited_for(self.device)
        try:
            self._port: Any = serial.serial_for_url(
                self.device,
                do_not_open=True,
                baudrate=baud,
                timeout=0 if self._waits else WAIT,
                exclusive=None if "://" in self.device else True,
            )
            if "://" in self.device:
                # What a server has sent since it took the connection is no stale data of somebody else.
                self._port.reset_input_buffer = _keep
            self._port.open()
        except (OSError, ValueError) as error:
            raise port_error(self.device, error, baud) from error

    def read(self) -> bytes:
        """Read what has come, after waiting for at most 0.05 s.

        Returns:
            The bytes; none if none came.

        Raises:
            DeviceError: If the line is lost.

        Source:
            None (pyserial).
        """
        try:
            if self._waits:
                ready, _, _ = select.select([self._port.fileno()], [], [], WAIT)
                return bytes(self._port.read(_BLOCK)) if ready else b""
            first = bytes(self._port.read(max(1, self._port.in_waiting)))
            return first + bytes(self._port.read(self._port.in_waiting)) if first else b""
        except (OSError, TypeError, ValueError) as error:
            # pyserial answers with a TypeError where its handle has vanished.
            raise DeviceError(f"{self.device}: the line was lost ({error})") from error

    def rest(self) -> bytes:
        """What a lost line had delivered before, where pyserial's reader thread still holds it.

        Returns:
            The bytes.
        """
        queue = getattr(self._port, "_read_buffer", None)
        data = b""
        while queue is not None and not queue.empty():
            data += queue.get_nowait() or b""
        return data

    def close(self) -> None:
        """Close the port; errors of a line that is gone are of no interest."""
        socket = getattr(self._port, "_socket", None)
        with contextlib.suppress(OSError, TypeError, ValueError):
            self._port.close()
        if socket is not None:
            # pyserial leaves it open if the other side hung up first.
            socket.close()


def _can_be_waited_for(device: str) -> bool:
    """Whether the system can wait for bytes of this port: sockets anywhere, device nodes where Unix is."""
    return device.lower().startswith("socket://") or ("://" not in device and os.name == "posix")


def _keep() -> None:
    """Leave the input buffer as it is."""
