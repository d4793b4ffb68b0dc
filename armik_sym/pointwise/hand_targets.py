"""What a pointwise method has to reach: one hand pose per sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class HandTargets:
    """Hand poses, one per sample, in the form the C loops read.

    Attributes:
        orientation: What is tracked: NONE (position only) or FULL.
        pose: Position and rotation row by row, shape (n, 12), in [m] and [1]; the rotation is the identity
            where it is not tracked.
    """

    orientation: Orientation
    pose: Array

    def __len__(self) -> int:
        return len(self.pose)


@dataclass(frozen=True, eq=False)
class PointwiseOutcome:
    """What a pointwise method returns, before it is judged.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad], never outside the range of motion.
        reached: Whether the method's own stop criterion was met, shape (n,); False means that it ran into its
            limit of iterations.
        iterations: Iterations or generations spent on each sample, shape (n,).
        evaluations: Cost or kinematics evaluations of all samples together.
    """

    q: Array
    reached: NDArray[np.bool_]
    iterations: NDArray[np.int64]
    evaluations: int
