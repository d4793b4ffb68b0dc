"""The random stream is SplitMix64, the same in C and NumPy, and its draws have fair odds."""

from __future__ import annotations

import ctypes

import numpy as np
import pytest
from compiled_helpers import build_strictly, needs_cc
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.compiled.hand_written import loop_text
from armik_sym.compiled.library_source import PRELUDE
from armik_sym.pointwise.random_stream import (
    high_half,
    low_half,
    random_below,
    random_bits,
    random_branch,
    random_unit,
)

WORDS = st.integers(0, 2**64 - 1)


def splitmix64(state: int) -> tuple[int, int]:
    """One step of the generator, in Python's own integers: the next state and the output."""
    mask = (1 << 64) - 1
    state = (state + 0x9E3779B97F4A7C15) & mask
    z = state
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
    return state, z ^ (z >> 31)


def test_first_outputs_are_the_published_ones():
    # Of the reference implementation, state 1234567.
    assert random_bits(1234567, np.arange(3)).tolist() == [
        6457827717110365317, 3203168211198807973, 9817491932198370423,
    ]  # fmt: skip


@given(key=WORDS)
def test_counter_k_is_step_k_of_the_generator(key):
    state, expected = key, []
    for _ in range(5):
        state, out = splitmix64(state)
        expected.append(out)
    assert random_bits(key, np.arange(5)).tolist() == expected
    assert random_branch(key, 3) == expected[3]


@given(bits=WORDS, n=st.integers(1, 1000))
def test_derived_numbers(bits, n):
    assert float(random_unit(bits)) == (bits >> 11) / 2**53
    assert 0 <= float(random_unit(bits)) < 1
    high, low = int(high_half(bits)), int(low_half(bits))
    assert (high << 32) + low == bits
    assert int(random_below(high, n)) == high * n // 2**32 < n


def test_shapes_are_kept():
    assert random_bits(1, 5).shape == ()
    assert random_bits(1, np.zeros((2, 3), int)).shape == (2, 3)


@pytest.mark.parametrize("n", [3, 5, 49])
def test_odds_are_even(n):
    count = np.bincount(random_below(high_half(random_bits(7, np.arange(60_000))), n), minlength=n)
    expected = 60_000 / n
    assert np.sum((count - expected) ** 2 / expected) < n + 5 * np.sqrt(2 * n)
    unit = random_unit(random_bits(7, np.arange(60_000)))
    assert abs(unit.mean() - 0.5) < 5 / np.sqrt(12 * 60_000)


@needs_cc
def test_c_draws_the_same(tmp_path):
    handle = build_strictly(PRELUDE + loop_text("random_stream.h") + C_CALLS, tmp_path)
    rng = np.random.default_rng(0)
    for key, counter in rng.integers(0, 2**63, (50, 2)).tolist():
        handle.bits.restype = ctypes.c_uint64
        handle.unit.restype = ctypes.c_double
        handle.bits.argtypes = handle.unit.argtypes = [ctypes.c_uint64, ctypes.c_uint64]
        handle.below.argtypes = [ctypes.c_uint64, ctypes.c_uint64, ctypes.c_int]
        bits = random_bits(key, counter)
        assert handle.bits(key, counter) == int(bits)
        assert handle.unit(key, counter) == float(random_unit(bits))
        assert handle.below(key, counter, 47) == int(random_below(low_half(bits), 47))


C_CALLS = """
EXPORT uint64_t bits(uint64_t key, uint64_t counter);
EXPORT double unit(uint64_t key, uint64_t counter);
EXPORT int below(uint64_t key, uint64_t counter, int n);
uint64_t bits(uint64_t key, uint64_t counter) { return random_branch(key, counter); }
double unit(uint64_t key, uint64_t counter) { return random_unit(random_bits(key, counter)); }
int below(uint64_t key, uint64_t counter, int n) {
  return random_below((uint32_t)random_bits(key, counter), n);
}
"""
