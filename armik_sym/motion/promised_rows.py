"""What a header promises against what the file holds."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

from armik_sym.errors import MotionFileError, MotionFileWarning

_INTEGER = re.compile(r"[+-]?\d{1,18}(\.0*)?\Z", re.ASCII)


def count_of(path: Path, line: int, name: str, text: str) -> int:
    """A count a header states.

    Args:
        path: The file, for messages.
        line: Line number.
        name: What is counted.
        text: The text.

    Returns:
        The count, at least 0.

    Raises:
        MotionFileError: If it is no such number.

    Source:
        None (bookkeeping).
    """
    if not _INTEGER.match(text) or float(text) < 0:
        raise MotionFileError(f"{path}: line {line}: {name} is {text[:40]!r}, expected a whole number")
    return int(float(text))


def compare_rows(path: Path, name: str, promised: int | None, found: int) -> str:
    """Warn if a header promises another number of rows than the file has.

    Args:
        path: The file.
        name: Name of the header field.
        promised: What it states, or None if it states nothing.
        found: Number of rows found.

    Returns:
        The finding in words, for the note of the recording; empty if there is none.

    Source:
        None (this package).
    """
    if promised is None or promised == found:
        return ""
    less = "fewer" if found < promised else "more"
    return warn(path, f"the header promises {promised} rows ({name}), the file has {found}, {less}")


def warn(path: Path, said: str) -> str:
    """Warn about something odd in a file that can be lived with.

    Args:
        path: The file.
        said: What is odd.

    Returns:
        What is odd, for the note of the recording.

    Source:
        None (this package).
    """
    warnings.warn(f"{path}: {said}", MotionFileWarning, stacklevel=4)
    return said


def joined(*notes: str) -> str:
    """Notes as one text.

    Args:
        *notes: The notes; empty ones are left out.

    Returns:
        The notes, separated by semicolons.

    Source:
        None (reporting).
    """
    return "; ".join(filter(None, notes))
