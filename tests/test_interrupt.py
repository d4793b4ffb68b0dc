"""The watch for Ctrl-C: notes it, gives the handler back, leaves other threads alone."""

from __future__ import annotations

import os
import signal
import threading

import pytest

from armik_sym.trajectory.interrupt import InterruptWatch

pytestmark = pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")


@pytest.fixture
def handler():
    """A handler of the caller's own, so that giving back the default would not do."""
    calls = []
    mine = lambda number, frame: calls.append(number)  # noqa: E731
    mine.calls = calls
    before = signal.signal(signal.SIGINT, mine)
    yield mine
    signal.signal(signal.SIGINT, before)


def press():
    os.kill(os.getpid(), signal.SIGINT)


def test_ctrl_c_is_noted_inside_and_handled_as_before_outside(handler):
    watch = InterruptWatch()
    with watch:
        assert not watch.requested
        press()
        assert watch.requested
        assert handler.calls == []
    assert signal.getsignal(signal.SIGINT) is handler
    press()
    assert handler.calls == [signal.SIGINT]


def test_the_handler_comes_back_after_an_exception(handler):
    with pytest.raises(ValueError, match="inside"), InterruptWatch():
        raise ValueError("inside")
    assert signal.getsignal(signal.SIGINT) is handler


def test_nested_watches(handler):
    outer, inner = InterruptWatch(), InterruptWatch()
    with outer:
        with inner:
            press()
        assert (inner.requested, outer.requested) == (True, False)
        press()
    assert outer.requested
    assert signal.getsignal(signal.SIGINT) is handler


def test_another_thread_touches_no_handler(handler):
    seen = []

    def work():
        with InterruptWatch() as watch:
            seen.append((watch.requested, signal.getsignal(signal.SIGINT)))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [(False, handler)]
    assert signal.getsignal(signal.SIGINT) is handler
