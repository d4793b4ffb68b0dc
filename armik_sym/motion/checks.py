"""Checks every motion passes, in memory or from a file, each with its own message."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import HandPathError, ShapeError

Array = NDArray[np.float64]
Place = Callable[[int], str]


def sample_place(index: int) -> str:
    """Where a sample is, for messages: "sample 3". Readers of files put the line in its place.

    Args:
        index: Index of the sample, from 0.

    Returns:
        The words.

    Source:
        None (bookkeeping).
    """
    return f"sample {index}"


def float_copy(values: ArrayLike, what: str) -> Array:
    """A read-only float64 copy; masked values become NaN, so that they are not taken for numbers.

    Args:
        values: Anything NumPy can turn into numbers.
        what: The quantity, for the message.

    Returns:
        The copy, same shape.

    Raises:
        HandPathError: If the values are not numbers.

    Source:
        None (bookkeeping).
    """
    try:
        if isinstance(values, np.ma.MaskedArray):
            values = np.ma.filled(values.astype(np.float64), np.nan)
        copy = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise HandPathError(f"{what} is not an array of numbers: {_short(values)}") from None
    copy.flags.writeable = False
    return copy


def check_shape(values: Array, what: str, expected: tuple[int | None, ...], wanted: str) -> None:
    """Refuse an array of another shape.

    Args:
        values: The array.
        what: The quantity, for the message.
        expected: Its shape; None stands for any length.
        wanted: The shape in words, for the message, for example "(n, 3)".

    Raises:
        ShapeError: If the shape differs.

    Source:
        None (bookkeeping).
    """
    fits = values.ndim == len(expected) and all(
        want is None or have == want for have, want in zip(values.shape, expected, strict=True)
    )
    if not fits:
        raise ShapeError(f"{what} has shape {values.shape}, expected {wanted}")


def check_finite(values: Array, what: str, place: Place = sample_place) -> None:
    """Refuse NaN and infinity.

    Args:
        values: Array with samples on axis 0.
        what: The quantity, for the message.
        place: Words for where a sample is.

    Raises:
        HandPathError: If a value is not finite; names the first sample and counts the others.

    Source:
        None (bookkeeping).
    """
    bad = np.flatnonzero(~np.isfinite(values.reshape(len(values), -1)).all(axis=1))
    if bad.size:
        i = int(bad[0])
        further = f" (and of {bad.size - 1} further samples)" if bad.size > 1 else ""
        raise HandPathError(
            f"{what} of {place(i)}{further} is {_short(values[i].tolist())}, expected finite numbers: fill "
            "the gap or leave these samples out"
        )


def check_increasing(time: Array, place: Place = sample_place) -> None:
    """Refuse times that do not strictly increase: t_i > t_{i-1}.

    Args:
        time: Times, shape (n,), in [s].
        place: Words for where a sample is.

    Raises:
        HandPathError: If two neighbours have equal times or time runs backwards.

    Source:
        None (bookkeeping).
    """
    bad = np.flatnonzero(time[1:] <= time[:-1])
    if not bad.size:
        return
    i = int(bad[0]) + 1
    before, now = float(time[i - 1]), float(time[i])
    if before == now:
        raise HandPathError(
            f"time of {place(i)} is {now!r} s, equal to the one before it: every sample needs a later time "
            "than its neighbour; leave repeated samples out"
        )
    raise HandPathError(
        f"time runs backwards at {place(i)}: {now!r} s after {before!r} s; sort the samples, or cut the "
        "recording where its clock starts again"
    )


def _short(values: object) -> str:
    text = repr(values)
    return text if len(text) <= 120 else f"{text[:117]}..."
