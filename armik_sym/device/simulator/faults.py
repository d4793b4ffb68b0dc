"""What goes wrong, and when: bytes, sensors and the port."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from armik_sym.errors import OptionError


@dataclass(frozen=True, slots=True)
class Stuck:
    """A channel keeps the count it has.

    Attributes:
        channel: Which one, from 0.
        start: From this device time on, in [s].
        end: Up to this device time, in [s].
    """

    channel: int
    start: float
    end: float = math.inf


@dataclass(frozen=True, slots=True)
class Jump:
    """A channel is off by some counts from a moment on, as after a blow to its mounting.

    Attributes:
        channel: Which one, from 0.
        at: Device time, in [s].
        counts: What is added, in [count].
    """

    channel: int
    at: float
    counts: int


@dataclass(frozen=True, slots=True)
class Silence:
    """Nothing is sent for a while, though the port stays open.

    Attributes:
        start: From this device time on, in [s].
        end: Up to this device time, in [s].
    """

    start: float
    end: float = math.inf


@dataclass(frozen=True)
class Faults:
    """Everything that goes wrong; by default nothing does.

    Attributes:
        damaged_bytes: Share of the bytes that arrive with another value.
        lost_bytes: Share of the bytes that do not arrive.
        inserted_bytes: Share of the bytes behind which 1 to 8 bytes of garbage arrive.
        close_at: Device times at which the port is closed in the middle of a frame, in [s].
        closed_for: How long it stays closed, in [s].
        silent: When nothing is sent.
        stuck: Channels that stop.
        jumps: Channels that jump.
        restart_at: Device times at which its program starts again: sequence and clock from 0, encoders from
            anything, in [s].
        version: Version of the protocol in every frame; None: the one of this package.

    Raises:
        OptionError: If a value is out of range.

    Source:
        None (this package).
    """

    damaged_bytes: float = 0.0
    lost_bytes: float = 0.0
    inserted_bytes: float = 0.0
    close_at: tuple[float, ...] = ()
    closed_for: float = 1.0
    silent: tuple[Silence, ...] = ()
    stuck: tuple[Stuck, ...] = ()
    jumps: tuple[Jump, ...] = ()
    restart_at: tuple[float, ...] = ()
    version: int | None = None

    def __post_init__(self) -> None:
        for name in ("damaged_bytes", "lost_bytes", "inserted_bytes"):
            share = getattr(self, name)
            if not 0 <= share <= 1:
                raise OptionError(f"{name} is {share!r}, expected a share of the bytes from 0 to 1")
        if not 0 < self.closed_for < math.inf:
            raise OptionError(f"closed_for is {self.closed_for!r} s, expected a positive number")
        for name, times in (("close_at", self.close_at), ("restart_at", self.restart_at)):
            for at in times:
                if not 0 <= at < math.inf:
                    raise OptionError(f"{name} holds {at!r} s, expected times that are not negative")
        _check_spans(self.silent)
        _check_spans(self.stuck)
        if self.version is not None and not 0 <= self.version <= 0xFF:
            raise OptionError(f"version is {self.version!r}, expected 0 to 255")

    @property
    def touch_bytes(self) -> bool:
        """Whether bytes are damaged, lost or inserted at all."""
        return bool(self.damaged_bytes or self.lost_bytes or self.inserted_bytes)

    def is_silent(self, time: float) -> bool:
        """Whether nothing is sent.

        Args:
            time: Device time, in [s].

        Returns:
            True within one of `silent`.

        Source:
            None (this package).
        """
        return any(silence.start <= time < silence.end for silence in self.silent)

    def check_channels(self, channels: int) -> None:
        """Check that a device has the channels that fail.

        Args:
            channels: How many it has.

        Raises:
            OptionError: If a channel is not there.

        Source:
            None (bookkeeping).
        """
        for channel in [fault.channel for fault in self.stuck] + [fault.channel for fault in self.jumps]:
            if not 0 <= channel < channels:
                raise OptionError(f"a fault of channel {channel}: the device has 0 to {channels - 1}")


def _check_spans(faults: Iterable[Stuck | Silence]) -> None:
    for fault in faults:
        if not 0 <= fault.start < fault.end:
            raise OptionError(f"{fault}: expected 0 <= start < end")
