"""Device time against the wall clock, or free of it."""

from __future__ import annotations

import threading
import time

from armik_sym.errors import OptionError

_BATCH = 0.004
_FREE_STEP = 0.25
_SHORTEST_PAUSE = 0.1
_LONGEST_SLEEP = 0.05


class Clock:
    """Device time: t = speed (wall time - start); free of the wall clock, a step further each time.

    Attributes:
        free: Whether it does not wait for the wall clock.
    """

    def __init__(self, speed: float | None) -> None:
        """Set the clock to 0, not yet started.

        Args:
            speed: Device seconds per second; None: free.

        Raises:
            OptionError: If the speed is not positive.
        """
        if speed is not None and not 0 < speed < float("inf"):
            raise OptionError(f"speed is {speed!r}, expected a positive number, or None: as fast as possible")
        self.free = speed is None
        self._speed = speed or 1.0
        self._start = 0.0
        self._position = 0.0

    def start(self) -> None:
        """Start now."""
        self._start = time.monotonic()

    def now(self) -> float:
        """Device time, in [s]."""
        return self._position if self.free else (time.monotonic() - self._start) * self._speed

    def late(self, time_due: float) -> float:
        """By how much something is late that is done now.

        Args:
            time_due: Device time at which it was due, in [s].

        Returns:
            Seconds of the wall clock; 0 for a clock that is free of it.

        Source:
            None (definition).
        """
        return 0.0 if self.free else (self.now() - time_due) / self._speed

    def next(self, stopping: threading.Event) -> float:
        """Wait for the time of the next batch.

        Args:
            stopping: Ends the wait early.

        Returns:
            Device time up to which everything is due, in [s].

        Source:
            None (this package).
        """
        if self.free:
            self._position += _FREE_STEP
            return self._position
        # A sleep from now on, not to a fixed grid: late once is not late for ever, and never in a hurry.
        stopping.wait(_BATCH)
        return self.now()

    def sleep_until(self, position: float, stopping: threading.Event) -> bool:
        """Wait a little, at most until a device time.

        Args:
            position: Device time to wait for, in [s].
            stopping: Ends the wait early.

        Returns:
            Whether that time has come, or the wait was ended.

        Source:
            None (this package).
        """
        if self.free:
            self._position = max(self._position, position)
            stopping.wait(_SHORTEST_PAUSE)
            return True
        left = (position - self.now()) / self._speed
        return left <= 0 or stopping.wait(min(left, _LONGEST_SLEEP))
