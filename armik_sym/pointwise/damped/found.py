"""What the loops of the damped methods write."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Found:
    """What the damped methods found; rows are filled block by block.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad].
        error: |e| that is left, shape (n,), in [m].
        iterations: Steps tried, shape (n,).
        evaluations: Poses computed, shape (n,).
    """

    q: Array
    error: Array
    iterations: NDArray[np.int64]
    evaluations: NDArray[np.int64]

    @classmethod
    def empty(cls, n: int, dof: int) -> Found:
        """Room for n samples.

        Args:
            n: Number of samples.
            dof: Number of joints.

        Returns:
            Arrays without content.

        Source:
            None (bookkeeping).
        """
        counts = np.zeros((2, n), dtype=np.int64)
        return cls(np.empty((n, dof)), np.empty(n), counts[0], counts[1])
