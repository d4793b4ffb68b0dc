"""Ctrl-C while compiled code runs: noted at once, acted on between two iterations, never lost."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any


class InterruptWatch:
    """Context in which Ctrl-C sets `requested` instead of raising inside somebody's C++ code.

    Outside the main thread, where Python allows no signal handlers, it does nothing.
    """

    def __init__(self) -> None:
        self.requested = False
        self._previous: Any = None

    def __enter__(self) -> InterruptWatch:
        if threading.current_thread() is threading.main_thread():
            self._previous = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._previous is not None:
            signal.signal(signal.SIGINT, self._previous)

    def _note(self, number: int, frame: FrameType | None) -> None:
        del number, frame
        self.requested = True


@contextmanager
def interrupts_come_out() -> Iterator[None]:
    """Context that ends with what the handler of Ctrl-C raised, whatever code in between made of it.

    CasADi calls Python while it converts arguments and builds functions; an exception raised there comes
    back as another one, or not at all.

    Yields:
        Nothing.

    Raises:
        KeyboardInterrupt: If Ctrl-C was pressed and the handler in place raises it, as Python's own does.

    Source:
        None (this package).
    """
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield
        return
    raised: list[BaseException] = []

    def note(number: int, frame: FrameType | None) -> None:
        try:
            before(number, frame)
        except BaseException as interruption:
            raised.append(interruption)
            raise

    signal.signal(signal.SIGINT, note)
    try:
        yield
    except Exception:
        if not raised:
            raise
    finally:
        signal.signal(signal.SIGINT, before)
    if raised:
        raise raised[0]
