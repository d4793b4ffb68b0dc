"""The watch for Ctrl-C: notes it, gives the handler back, leaves other threads alone."""

from __future__ import annotations

import os
import signal
import threading

import pytest

from armik_sym.trajectory.interrupt import InterruptWatch, interrupts_come_out

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


@pytest.fixture
def pythons_own():
    """The handler Python begins with, which raises KeyboardInterrupt."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield signal.default_int_handler
    signal.signal(signal.SIGINT, before)


def pressed_and(ending):
    """Code that is interrupted and makes something else of it, as converters between languages do."""
    try:
        press()
        for _ in range(1000):  # the handler runs between two instructions
            pass
    except KeyboardInterrupt:
        if ending == "other error":
            raise RuntimeError("Error calling Callback") from None
        if ending == "itself":
            raise


@pytest.mark.parametrize("ending", ["itself", "other error", "lost"])
def test_an_interruption_comes_out_whatever_becomes_of_it(pythons_own, ending):
    with pytest.raises(KeyboardInterrupt), interrupts_come_out():
        pressed_and(ending)
    assert signal.getsignal(signal.SIGINT) is pythons_own


def test_other_errors_and_good_ends_are_left_alone(pythons_own):
    with pytest.raises(ValueError, match="mine"), interrupts_come_out():
        raise ValueError("mine")
    with interrupts_come_out():
        pass
    assert signal.getsignal(signal.SIGINT) is pythons_own


def test_a_handler_that_does_not_raise_ends_nothing(handler):
    with interrupts_come_out():
        pressed_and("itself")
    assert handler.calls == [signal.SIGINT]
    assert signal.getsignal(signal.SIGINT) is handler


def test_a_watch_inside_still_only_notes(pythons_own):
    with interrupts_come_out(), InterruptWatch() as watch:
        pressed_and("itself")
    assert watch.requested
    assert signal.getsignal(signal.SIGINT) is pythons_own


@pytest.mark.parametrize("ignored", [signal.SIG_IGN, signal.SIG_DFL])
def test_no_python_handler_to_chain_to(ignored):
    before = signal.signal(signal.SIGINT, ignored)
    try:
        with interrupts_come_out():
            assert signal.getsignal(signal.SIGINT) is ignored
    finally:
        signal.signal(signal.SIGINT, before)


def test_other_threads_leave_handlers_alone_here_too(handler):
    seen = []

    def work():
        with interrupts_come_out():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [handler]
