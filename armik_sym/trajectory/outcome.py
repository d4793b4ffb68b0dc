"""What a search for the trajectory found, before it judges itself as a solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.solution.lower_bound import LowerBound

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Outcome:
    """One trajectory.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad].
        status: The solver's own word.
        iterations: Iterations in all.
        compile_time: Seconds the C compiler took for it.
        bound: What no feasible trajectory can cost less than, if that was asked for.
    """

    q: Array
    status: str
    iterations: int
    compile_time: float = 0.0
    bound: LowerBound | None = None
