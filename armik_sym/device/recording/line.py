"""A line that comes back: reads a port, notices when it is lost or silent, and opens it again."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from armik_sym.device.recording.host_frames import GapMark, GapReason, clocks, encode_host
from armik_sym.device.recording.port import WAIT, Port
from armik_sym.device.recording.port_again import UsbIdentity, find_again, identity_of
from armik_sym.errors import DeviceError

SILENT_AFTER = 1.0
"""Time without a byte after which the line counts as silent, in [s]."""

GIVE_UP_AFTER = 5.0
"""Time without a byte after which a network connection is opened anew, in [s]: it may be half open."""

_TRY_EVERY, _TRY_SLOWLY, _SOON = 0.2, 1.0, 10.0  # [s]
_FIRST_BYTES = 256
_SECOND = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Arrival:
    """What one look at the line gave.

    Attributes:
        data: Bytes of the device; after an opening from the first delimiter on, as what is in front of it
            can be no frame.
        steady_ns: The steady clock when they had come, in [ns].
        front: Bytes for the recording in front of them: the line is back.
        behind: Bytes for the recording behind them: the line is lost, or silent.
        gap: How long nothing had come before, in [s]; 0 if that was no gap.
        reopened: Whether the port was opened anew before these bytes.
        lost: Whether the port was lost behind them.
    """

    data: bytes
    steady_ns: int
    front: bytes = b""
    behind: bytes = b""
    gap: float = 0.0
    reopened: bool = False
    lost: bool = False


class Line:
    """A port that is opened again when it was lost, until it is closed.

    Attributes:
        url: The port.
        gaps: How often it was lost or silent.
        connected: Whether bytes come.
        received: Bytes that came, those of no use included.
        first_bytes: The first of them, to find out what they are.
    """

    def __init__(self, url: str, baud: int, notices: Callable[[str], None]) -> None:
        """Prepare a line; `open` opens it.

        Args:
            url: Port, as `Port` takes it.
            baud: Bits per second.
            notices: Called with a sentence when the line is lost, silent, or back.
        """
        self.url = url
        self.gaps = 0
        self.received = 0
        self.first_bytes = b""
        self.connected = False
        self._baud = baud
        self._notices = notices
        self._port: Port | None = None
        self._identity: UsbIdentity | None = None
        self._aligned = False
        self._reason: GapReason | None = None
        self._last_ns = 0
        self._next_try = 0.0

    def open(self) -> None:
        """Open the port for the first time.

        Raises:
            DeviceError: If it cannot be opened.
        """
        self._port = Port(self.url, self._baud)
        self._identity = identity_of(self.url) if "://" not in self.url else None
        self._last_ns = time.monotonic_ns()
        self.connected = True

    def close(self) -> None:
        """Close the port for good."""
        if self._port is not None:
            self._port.close()
            self._port = None
        self.connected = False

    def read(self) -> Arrival:
        """Look once, for at most 0.05 s; a lost line is no error, it is waited for.

        Returns:
            What came, mostly a few bytes or nothing.

        Source:
            None (this package).
        """
        if self._port is None and not self._open_again():
            return Arrival(b"", time.monotonic_ns())
        data, why = self._look()
        now = time.monotonic_ns()
        if data:
            self._heard(data, now)
            data = self._whole_pieces(data)
        arrival = self._arrived(data, now) if data else Arrival(b"", now)
        if why:
            behind = self._lose(GapReason.PORT_LOST, why)
        elif self.received and now - self._last_ns >= SILENT_AFTER * _SECOND:
            behind = self._silent(now)
        else:
            return arrival
        return replace(arrival, behind=behind, lost=self._port is None)

    def _look(self) -> tuple[bytes, str]:
        """What the port has, and why it is lost if it is."""
        port = self._port
        if port is None:
            return b"", ""
        try:
            return port.read(), ""
        except DeviceError as error:
            return port.rest(), str(error)

    def _heard(self, data: bytes, now: int) -> None:
        """Bytes came, whatever they are worth."""
        self.received += len(data)
        if len(self.first_bytes) < _FIRST_BYTES:
            self.first_bytes += data[:_FIRST_BYTES]
        if self._reason is None:
            self._last_ns = now

    def _whole_pieces(self, data: bytes) -> bytes:
        """After an opening what is in front of the first delimiter is the rest of a frame that is gone."""
        if self._aligned:
            return data
        start = data.find(b"\0")
        self._aligned = start >= 0
        return data[start:] if self._aligned else b""

    def _arrived(self, data: bytes, now: int) -> Arrival:
        gap, front, reopened = 0.0, b"", False
        if self._reason is not None:
            gap = (now - self._last_ns) / _SECOND
            reopened = self._reason is GapReason.PORT_LOST
            front = _mark(GapReason.BACK, now)
            self._notices(f"{self.url}: back after {gap:.1f} s")
            self._reason = None
        self._last_ns = now
        self.connected = True
        return Arrival(data, now, front, gap=gap, reopened=reopened)

    def _silent(self, now: int) -> bytes:
        """The line says nothing: a gap; and after a while, perhaps it is gone."""
        silence = (now - self._last_ns) / _SECOND
        mark = b""
        if self._reason is None:
            self.gaps += 1
            self.connected = False
            self._reason = GapReason.SILENCE
            mark = _mark(GapReason.SILENCE, self._last_ns)
            self._notices(f"{self.url}: no byte for {silence:.0f} s: waiting; is the device switched on?")
        vanished = "://" not in self.url and os.name == "posix" and not os.path.exists(self._device)  # noqa: PTH110
        stale = "://" in self.url and silence >= GIVE_UP_AFTER
        if vanished or stale:
            mark += self._lose(GapReason.PORT_LOST, f"{self.url}: the line is gone")
        return mark

    @property
    def _device(self) -> str:
        return self.url if self._port is None else self._port.device

    def _lose(self, reason: GapReason, why: str) -> bytes:
        """Close the port, to be opened again; the mark of the gap for the recording."""
        if self._reason is None:
            self.gaps += 1
        if self._reason is not reason:
            self._notices(f"{why}; trying to open it again")
        self._reason = reason
        self.connected = False
        if self._port is not None:
            self._port.close()
            self._port = None
        self._next_try = time.monotonic() + _TRY_EVERY
        return _mark(reason, self._last_ns)

    def _open_again(self) -> bool:
        now = time.monotonic()
        if now < self._next_try:
            time.sleep(min(WAIT, self._next_try - now))
            return False
        try:
            self._port = Port(self.url, self._baud, find_again(self.url, self._identity))
        except DeviceError:
            waited = now - self._last_ns / _SECOND
            self._next_try = time.monotonic() + (_TRY_EVERY if waited < _SOON else _TRY_SLOWLY)
            return False
        self._aligned = False
        return True


def _mark(reason: GapReason, steady_ns: int) -> bytes:
    """A mark that says when, by both clocks."""
    clock, steady = clocks()
    return encode_host(GapMark(reason.value, clock - steady + steady_ns, steady_ns))
