"""A pseudo-terminal as a serial port: a symbolic link that stays, to a terminal that may be replaced."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from armik_sym.device.simulator.line import ReaderGoneError
from armik_sym.errors import DeviceError

# A reader that opens a port throws away what is in it. The system tells when it does; one that has not done
# so after this time will not, in [s].
_SETTLED_AFTER = 1.0
_MOST_UNREAD = 0x11000
_LOOKS = 3
_BETWEEN_LOOKS = 0.004


class PtyLine:
    """The master's side of a pseudo-terminal in raw mode.

    The reader's side is not held open here: so the system tells when a reader opened or closed it. In packet
    mode it also tells when the reader threw away what was there, which serial libraries do when they
    open a port; from then on everything arrives.
    """

    def __init__(self, link: Path) -> None:
        """Prepare a port.

        Args:
            link: Symbolic link to make; readers open it.

        Raises:
            DeviceError: If this system has no pseudo-terminals, or something else is at the link.
        """
        if sys.platform == "win32":
            raise DeviceError(
                "Windows has no pseudo-terminals: serve a socket instead (--socket 127.0.0.1:4400, or "
                "serve_socket), and open socket://127.0.0.1:4400"
            )
        if link.is_symlink() and not link.exists():
            link.unlink()  # Left behind by a simulator that was killed.
        if link.is_symlink() or link.exists():
            raise DeviceError(f"{link}: exists already: choose another name for the port")
        self._link = link
        self._terminal = ""
        self._linked = False
        self._master = -1
        self._settled_at = 0.0
        self._present = False

    @property
    def port(self) -> str:
        """Path of the link."""
        return str(self._link)

    def open(self) -> None:
        """Make a pseudo-terminal and link to it.

        Raises:
            DeviceError: If the system does not give one, or the link cannot be made.
        """
        import fcntl
        import pty
        import termios

        if self._master >= 0:
            return
        try:
            self._master, slave = pty.openpty()
        except OSError as error:
            raise DeviceError(f"no pseudo-terminal: {error.strerror}: serve a socket instead") from error
        self._present = False
        try:
            self._terminal = os.ttyname(slave)
            os.set_blocking(self._master, False)
            fcntl.ioctl(self._master, termios.TIOCPKT, (1).to_bytes(4, sys.byteorder))
            self._link.symlink_to(self._terminal)
            self._linked = True
        except OSError as error:
            self.close()
            raise DeviceError(f"{self._link}: cannot be made: {error.strerror}") from error
        finally:
            os.close(slave)

    def ready(self) -> bool:
        """Whether a reader has opened the port and thrown away what was there."""
        if self._master < 0:
            return False
        flushed = False
        while (news := self._news()) is not None:
            if not self._present:
                self._present = True
                self._settled_at = time.monotonic() + _SETTLED_AFTER
                self._make_raw()
            if not news:
                break
            # A packet of one byte is news about the terminal, a longer one is what the reader wrote.
            flushed = flushed or (len(news) == 1 and bool(news[0] & _flush_read()))
        else:
            self._present = False
            return False
        if flushed:
            self._settled_at = 0.0
        return time.monotonic() >= self._settled_at

    def write(self, data: memoryview) -> int:
        """Write what fits at once.

        Args:
            data: Bytes.

        Returns:
            How many of them were taken.

        Raises:
            ReaderGoneError: If the reader closed the port.

        Source:
            None (this package).
        """
        try:
            return os.write(self._master, data)
        except BlockingIOError:
            if self._news() is None:
                raise ReaderGoneError from None
            return 0
        except OSError:
            raise ReaderGoneError from None

    def wait(self, seconds: float) -> None:
        """Wait until there may be room.

        Args:
            seconds: At most this long, in [s].

        Source:
            None (this package).
        """
        select.select([], [self._master], [], seconds)

    def unread(self) -> int:
        """How many bytes written are still unread, at most; 0 only if that was so several times running."""
        for look in range(_LOOKS):
            if self._has_waiting_bytes():
                return _MOST_UNREAD
            if look < _LOOKS - 1:
                # The kernel hands bytes on in pieces, a moment after the ones before were read.
                time.sleep(_BETWEEN_LOOKS)
        return 0

    def close(self) -> None:
        """Remove the link and hang up."""
        if self._master < 0:
            return
        if self._linked:
            with contextlib.suppress(OSError):
                self._link.unlink()
            self._linked = False
        os.close(self._master)
        self._master = -1
        self._present = False

    def _news(self) -> bytes | None:
        """What the reader's side has to say; None if nobody has it open."""
        try:
            return os.read(self._master, 4096) or None
        except BlockingIOError:
            return b""
        except OSError:
            return None

    def _make_raw(self) -> None:
        """Take echo and line editing off, also for readers that do not do it themselves."""
        import termios

        # A reader that wants the port for itself alone may refuse; then it sets its modes itself.
        with contextlib.suppress(OSError), self._slave() as slave:
            mode = termios.tcgetattr(slave)
            mode[0] &= ~(termios.IXON | termios.ICRNL | termios.INLCR | termios.IGNCR | termios.ISTRIP)
            mode[1] &= ~termios.OPOST
            mode[3] &= ~(termios.ECHO | termios.ICANON | termios.ISIG | termios.IEXTEN)
            # Now, and without a flush: that would look like the reader's.
            termios.tcsetattr(slave, termios.TCSANOW, mode)

    def _has_waiting_bytes(self) -> bool:
        import fcntl
        import termios

        try:
            with self._slave() as slave:
                return any(fcntl.ioctl(slave, termios.FIONREAD, bytes(4)))
        except OSError:
            return True

    @contextlib.contextmanager
    def _slave(self) -> Iterator[int]:
        slave = os.open(self._terminal, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        try:
            yield slave
        finally:
            os.close(slave)


def _flush_read() -> int:
    import termios

    return int(termios.TIOCPKT_FLUSHREAD)
