"""Checks that every table of a recording passes: names, times, and the rate a header declares."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import HandPathError, MotionFileError, RecordingError
from armik_sym.motion.checks import check_increasing
from armik_sym.motion.promised_rows import warn

Array = NDArray[np.float64]

_RATE_TOLERANCE = 0.01


def check_table_names(
    path: Path, names: Sequence[str], line: int | None = None, forbidden: str = "", what: str = "marker"
) -> None:
    """Refuse names that are blank, occur twice or cannot be written.

    Args:
        path: The file, for messages.
        names: The names.
        line: Line number, if they were read.
        forbidden: Characters that would be read as something else, if they are to be written.
        what: What the names name.

    Raises:
        MotionFileError: If a name is wrong.

    Source:
        None (bookkeeping).
    """
    where = f"{path}: line {line}:" if line else f"{path}:"
    seen: set[str] = set()
    for i, name in enumerate(names):
        if not name.strip():
            raise MotionFileError(f"{where} {what} {i + 1} has no name")
        if name in seen:
            raise MotionFileError(f"{where} {what} {name!r} occurs twice: every {what} needs its own name")
        seen.add(name)
        # Halves of characters (surrogates) cannot be encoded.
        bad = [mark for mark in name if mark in f"{forbidden}\n\r\0" or "\ud800" <= mark <= "\udfff"]
        if forbidden and (bad or name != name.strip()):
            said = repr(bad[0]) if bad else "blanks at its ends"
            raise MotionFileError(f"{where} {what} {name!r} cannot be written in this form: it has {said}")


@contextmanager
def errors_of_file(path: Path) -> Iterator[None]:
    """Turn the errors of what a file holds into errors of the file, which name it.

    Args:
        path: The file.

    Raises:
        MotionFileError: In place of a `RecordingError`.

    Source:
        None (reporting).
    """
    try:
        yield
    except RecordingError as error:
        raise MotionFileError(f"{path}: {error}") from None


def check_times(path: Path, time: Array, lines: NDArray[np.int64]) -> None:
    """Refuse times that do not increase: t_i > t_{i-1}.

    Args:
        path: The file, for messages.
        time: Times, shape (n,), in [s].
        lines: Line number of every sample, shape (n,).

    Raises:
        MotionFileError: If they do not; names the line.

    Source:
        None (definition).
    """
    try:
        check_increasing(time, lambda i: f"line {lines[i]} (sample {i})")
    except HandPathError as error:
        raise MotionFileError(f"{path}: {error}") from None


def agreed_rate(path: Path, declared: float | None, time: Array) -> tuple[float | None, str]:
    """The declared rate, unless the times contradict it by more than 1 %: |rate·Δt - 1| > 0.01.

    Args:
        path: The file.
        declared: The rate the file declares, in [Hz], or None.
        time: Times, shape (n,), in [s].

    Returns:
        The rate to go by, in [Hz], None if only the times tell; and the contradiction in words, or "".

    Source:
        None (this package).
    """
    measured = None if declared is None else contradicting_rate(declared, time)
    if measured is None:
        return declared, ""
    said = f"the header declares {declared:g} Hz, the times have {measured:.6g} samples per second"
    return None, warn(path, f"{said}; the times are used")


def contradicting_rate(declared: float, time: Array) -> float | None:
    """The rate the times have, if it contradicts a declared one by more than 1 %: |rate·Δt - 1| > 0.01.

    Args:
        declared: The declared rate, in [Hz].
        time: Times, shape (n,), in [s].

    Returns:
        Samples per second by the times, in [Hz]; None if they agree, or a single sample tells nothing.

    Source:
        None (this package).
    """
    if len(time) < 2:
        return None
    measured = (len(time) - 1) / float(time[-1] - time[0])
    return measured if abs(measured - declared) > _RATE_TOLERANCE * declared else None
