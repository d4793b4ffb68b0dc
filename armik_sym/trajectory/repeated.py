"""Rows that stand for several things each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]


def repeated(count: Indices) -> tuple[Indices, Indices]:
    """Every index as often as its count says, and the number of each among its equals.

    Counts 2, 0, 1 give the indices 0, 0, 2 and the numbers 0, 1, 0.

    Args:
        count: Counts, not negative, shape (m,).

    Returns:
        Indices and numbers, shape (total of the counts,) each.

    Source:
        None (bookkeeping).
    """
    row = np.arange(len(count)).repeat(count)
    return row, np.arange(len(row)) - (np.cumsum(count) - count)[row]
