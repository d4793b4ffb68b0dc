"""A joint trajectory to start a solver from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Guess:
    """A joint trajectory to start from.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad].
        errors: Error left at each sample, shape (n,), in [m].
        origin: How it was made, for logs.
    """

    q: Array
    errors: Array
    origin: str
