"""Numbers of samples over wraps, losses, gaps and restarts."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.device.recording.sequence import SequenceCounter

ROUND = 1 << 32


@given(
    first=st.integers(0, ROUND - 1),
    clock=st.integers(0, ROUND - 1),
    steps=st.lists(st.integers(1, 5000), min_size=1, max_size=50),
)
def test_losses_are_counted_over_wraps(first: int, clock: int, steps: list[int]) -> None:
    counter, number = SequenceCounter(rate=500.0), 0
    counter.step(first, clock)
    for step in steps:
        number += step
        assert not counter.step((first + number) % ROUND, (clock + 2000 * number) % ROUND)
        assert counter.number == number
    assert counter.lost == number - len(steps)
    assert counter.wraps == (clock + 2000 * number) // ROUND


@given(
    before=st.integers(1, 10**6),
    since=st.integers(0, 500),
    gap=st.one_of(st.just(0.0), st.floats(0.1, 10.0)),
)
def test_a_step_back_is_a_restart(before: int, since: int, gap: float) -> None:
    counter = SequenceCounter(rate=500.0)
    counter.step(before - 1, 2000 * (before - 1))
    counter.step(before, 2000 * before)
    restarted = counter.step(since, 2000 * since, gap, reopened=gap > 0)
    if since <= before:
        assert restarted
        assert (counter.restarts, counter.lost, counter.number) == (1, since, 2 + since)


def test_a_device_switched_off_with_its_cable_is_found_out_by_the_clock_of_the_host() -> None:
    counter = SequenceCounter(rate=500.0)
    counter.step(999, 1_998_000)
    counter.step(1000, 2_000_000)
    # 2 s after it was switched on; the port came back; 10 s had passed, then 12 s since switched on.
    assert counter.step(1500, 3_000_000, gap=10.0, reopened=True)
    assert counter.lost == 1500
    assert not counter.step(7500, 15_000_000, gap=12.0, reopened=True)
    assert counter.lost == 1500 + 5999


@pytest.mark.parametrize("hours", [1.0, 3.0, 30.0])
def test_long_gaps_are_placed_by_the_clock_of_the_host(hours: float) -> None:
    counter = SequenceCounter(rate=100.0)
    counter.step(0, 0)
    missing = int(hours * 3600 * 100)
    passed = missing * 10_000
    assert not counter.step(missing, passed % ROUND, gap=hours * 3600 * 1.0001, reopened=True)
    assert counter.number == missing
    assert counter.wraps == passed // ROUND


def test_a_stalled_host_is_no_restart() -> None:
    counter = SequenceCounter(rate=500.0)
    counter.step(7, 14_000)
    assert not counter.step(8, 16_000, gap=2.5)
    assert not counter.step(9, 18_000, gap=2.5, reopened=True)
    assert (counter.lost, counter.restarts) == (0, 0)


def test_numbers_that_do_not_begin_at_zero_are_no_losses() -> None:
    counter = SequenceCounter(rate=500.0)
    counter.step(10**6, 1_000_000)
    assert counter.step(5 * 10**5, 2000)
    assert counter.lost == 0
