"""A TCP port as a serial port, for every system: what `socket://HOST:PORT` of pyserial opens."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import time

from armik_sym.device.simulator.line import ReaderGoneError
from armik_sym.errors import DeviceError

# A reader that opens a port throws away what is in it, and nobody tells when; after this time it has, in [s].
_SETTLED_AFTER = 0.2


class SocketLine:
    """A listening socket that serves one reader at a time, and refuses all while it is closed."""

    def __init__(self, host: str = "127.0.0.1", port: int = 0) -> None:
        """Prepare a port.

        Args:
            host: Address to listen at; 127.0.0.1 is reached from this machine only.
            port: Number of the port; 0 for any that is free.
        """
        self._host = host
        self._number = port
        self._listener: socket.socket | None = None
        self._reader: socket.socket | None = None
        self._settled_at = 0.0

    @property
    def port(self) -> str:
        """URL as pyserial takes it."""
        host = f"[{self._host}]" if ":" in self._host else self._host
        return f"socket://{host}:{self._number}"

    def open(self) -> None:
        """Listen.

        Raises:
            DeviceError: If the address cannot be used.
        """
        if self._listener is not None:
            return
        family = socket.AF_INET6 if ":" in self._host else socket.AF_INET
        listener = socket.socket(family, socket.SOCK_STREAM)
        try:
            if os.name == "posix":  # Elsewhere it would let two programs listen at one port.
                listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind((self._host, self._number))
            listener.listen(1)
            listener.setblocking(False)
        except (OSError, OverflowError) as error:
            listener.close()
            raise DeviceError(
                f"cannot listen at {self._host}:{self._number}: {error}: "
                "choose another port, or 0 for a free one"
            ) from error
        self._listener = listener
        self._number = int(listener.getsockname()[1])

    def ready(self) -> bool:
        """Whether a reader is connected and has thrown away what was there."""
        if self._reader is not None:
            self._listen_to_reader()
        if self._reader is None and self._listener is not None:
            try:
                self._reader, _ = self._listener.accept()
            except OSError:
                return False
            self._reader.setblocking(False)
            self._reader.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._settled_at = time.monotonic() + _SETTLED_AFTER
        return self._reader is not None and time.monotonic() >= self._settled_at

    def write(self, data: memoryview) -> int:
        """Write what fits at once.

        Args:
            data: Bytes.

        Returns:
            How many of them were taken.

        Raises:
            ReaderGoneError: If the reader closed the connection.

        Source:
            None (this package).
        """
        if self._reader is None:
            raise ReaderGoneError
        try:
            return self._reader.send(data)
        except BlockingIOError:
            return 0
        except OSError:
            self._drop_reader()
            raise ReaderGoneError from None

    def wait(self, seconds: float) -> None:
        """Wait until there may be room.

        Args:
            seconds: At most this long, in [s].

        Source:
            None (this package).
        """
        if self._reader is not None:
            select.select([], [self._reader], [], seconds)

    def unread(self) -> int:
        """Always 0: TCP delivers what was sent before an orderly end, as long as the reader reads."""
        return 0

    def close(self) -> None:
        """Drop the connection and stop listening."""
        if self._listener is not None:
            self._listener.close()
            self._listener = None
        self._drop_reader()

    def _listen_to_reader(self) -> None:
        """Throw away what the reader says, and notice when it is gone."""
        try:
            while self._reader is not None:
                if not self._reader.recv(4096):
                    self._drop_reader()
        except BlockingIOError:
            pass
        except OSError:
            self._drop_reader()

    def _drop_reader(self) -> None:
        if self._reader is None:
            return
        # Unread bytes on this side would turn the orderly end into a reset, which loses bytes on the way.
        with contextlib.suppress(OSError):
            self._reader.shutdown(socket.SHUT_WR)
        self._reader.close()
        self._reader = None
