"""Random numbers without a state, the same in C (`compiled/c/random_stream.h`) and NumPy.

Number `counter` of the stream `key` is SplitMix64's output at state key + (counter + 1)·golden. Every draw
has a fixed place, so results depend neither on threads nor on the order of evaluation.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Words = NDArray[np.uint64]
Array = NDArray[np.float64]

_WORD = (1 << 64) - 1
_STEP = np.uint64(0x9E3779B97F4A7C15)
_FIRST = np.uint64(0xBF58476D1CE4E5B9)
_SECOND = np.uint64(0x94D049BB133111EB)


def random_bits(key: int, counter: ArrayLike) -> Words:
    """Draws number `counter` of a stream: mix(key + (counter + 1)·golden) mod 2⁶⁴.

    Args:
        key: The stream, 0 ≤ key < 2⁶⁴.
        counter: Places in it, any shape, whole numbers ≥ 0.

    Returns:
        64 random bits each, of the same shape.

    Source:
        Steele, Lea & Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
    """
    z = np.atleast_1d(np.asarray(counter, dtype=np.uint64))
    z = np.uint64(key) + (z + np.uint64(1)) * _STEP
    z = (z ^ (z >> np.uint64(30))) * _FIRST
    z = (z ^ (z >> np.uint64(27))) * _SECOND
    return np.asarray(z ^ (z >> np.uint64(31))).reshape(np.shape(counter))


def random_branch(key: int, number: int) -> int:
    """The key of branch `number` of a stream: seed → sample → purpose.

    Args:
        key: The stream; taken modulo 2⁶⁴.
        number: Number of the branch.

    Returns:
        The key of the branch.

    Source:
        None (this package).
    """
    return int(random_bits(key & _WORD, number))


def random_unit(bits: ArrayLike) -> Array:
    """53 of 64 bits as a number in [0, 1): ⌊bits / 2¹¹⌋ / 2⁵³.

    Args:
        bits: Random bits, any shape.

    Returns:
        Numbers of the same shape.

    Source:
        Steele, Lea & Flood 2014.
    """
    return (np.asarray(bits, dtype=np.uint64) >> np.uint64(11)).astype(np.float64) * 2.0**-53


def random_below(bits: ArrayLike, n: int) -> NDArray[np.int64]:
    """Whole numbers in [0, n) from 32 bits: ⌊bits·n / 2³²⌋.

    Args:
        bits: Random numbers below 2³², any shape.
        n: Number of outcomes, 0 < n < 2³¹; their probabilities differ by less than n/2³² of themselves.

    Returns:
        Whole numbers of the same shape.

    Source:
        Lemire, "Fast random integer generation in an interval", ACM TOMACS 29 (2019).
    """
    return ((np.asarray(bits, dtype=np.uint64) * np.uint64(n)) >> np.uint64(32)).astype(np.int64)


def high_half(bits: ArrayLike) -> Words:
    """The upper 32 of 64 bits.

    Args:
        bits: Random bits, any shape.

    Returns:
        Numbers below 2³².

    Source:
        None (bookkeeping).
    """
    return np.asarray(np.asarray(bits, dtype=np.uint64) >> np.uint64(32))


def low_half(bits: ArrayLike) -> Words:
    """The lower 32 of 64 bits.

    Args:
        bits: Random bits, any shape.

    Returns:
        Numbers below 2³².

    Source:
        None (bookkeeping).
    """
    return np.asarray(np.asarray(bits, dtype=np.uint64) & np.uint64(0xFFFFFFFF))
