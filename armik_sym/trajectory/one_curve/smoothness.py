"""The quadratic objective as a sum of squares, three weights per sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from armik_sym.trajectory.posture_cost import PostureCost
from armik_sym.trajectory.rates import objective_scale, rows_of_weights, sample_durations, smoothness_weights

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Smoothness:
    """½ Σ |speed_k (q_{k+1} - q_k)|² + |Σ_i bend_ki q_{k+i}|² + |hold_k (q_k - aim_k)|².

    Attributes:
        speed: Shape (n - 1,).
        bend: Shape (max(n - 2, 0), 3).
        hold: Shape (n,).
        aim: Where the posture is drawn to, shape (n, dof), in [rad].
        scale: Factor by which the user's objective was multiplied to get here.
        posture_cost: What single postures cost besides; None if nothing.
        share: Scaled share of time of every sample that multiplies it, shape (n,), in [s].
    """

    speed: Array
    bend: Array
    hold: Array
    aim: Array
    scale: float = 1.0
    posture_cost: PostureCost | None = None
    share: Array | None = None

    def matrix(self) -> sp.csr_array:
        """S with the objective ½ |S q - b|², where b is `hold`·`aim` in the last n rows.

        Returns:
            Sparse matrix of shape (n - 1 + max(n - 2, 0) + n, n).

        Source:
            None (bookkeeping).
        """
        return rows_of_weights(self.speed, self.bend, self.hold)


def smoothness(
    time: Array, weights: tuple[float, float, float], aim: Array, posture_cost: PostureCost | None = None
) -> Smoothness:
    """The objective of a path's samples.

    Args:
        time: Time stamps, shape (n,), in [s].
        weights: Of squared speed, of squared acceleration [s²], of the squared distance from `aim` [1/s²].
        aim: Where the posture is drawn to, shape (dof,), in [rad].
        posture_cost: What single postures cost besides.

    Returns:
        The objective, scaled.

    Source:
        None (`rates.smoothness_weights`).
    """
    n = len(time)
    speed, bend, hold = smoothness_weights(time, *weights)
    diagonal = np.square(hold)
    diagonal[:-1] += np.square(speed)
    diagonal[1:] += np.square(speed)
    for i in range(3):
        diagonal[i : n - 2 + i] += np.square(bend[:, i])
    scale = objective_scale(float(diagonal.max()))
    r = np.sqrt(scale)
    share = None if posture_cost is None else scale * sample_durations(time)
    return Smoothness(r * speed, r * bend, r * hold, np.tile(aim, (n, 1)), scale, posture_cost, share)
