"""Where the loops put their answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Found:
    """Answers for n samples.

    Attributes:
        q: Joint angles, shape (n, 7), in [rad].
        reached: Whether the sample was reached inside the range of motion, shape (n,).
        evaluations: Postures looked at, shape (n,).
    """

    q: Array
    reached: NDArray[np.bool_]
    evaluations: NDArray[np.int64]

    @classmethod
    def empty(cls, n: int) -> Found:
        """Room for n samples.

        Args:
            n: Number of samples.

        Returns:
            Arrays of that length.

        Source:
            None (bookkeeping).
        """
        return cls(np.zeros((n, 7)), np.zeros(n, dtype=np.bool_), np.zeros(n, dtype=np.int64))


# Solves the samples of a slice: (slice, targets, starts or None, chain, found).
Loop = Callable[[slice, Array, Array | None, bool, Found], None]
