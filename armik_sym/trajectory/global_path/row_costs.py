"""What each row of a motion adds to the objective."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.one_curve.smoothness import Smoothness

Array = NDArray[np.float64]


def row_costs(q: Array, smooth: Smoothness) -> Array:
    """The objective, row by row: the step to each row, the acceleration at it, what its posture costs.

    Args:
        q: Motions of the same samples, shape (…, m, dof), in [rad].
        smooth: The objective over these samples.

    Returns:
        Shape (…, m), not scaled; the sum over m is the objective.

    Source:
        None (definition).
    """
    m = q.shape[-2]
    costs = 0.5 * np.square(smooth.hold[:, None] * (q - smooth.aim)).sum(axis=-1)
    costs[..., 1:] += 0.5 * np.square(smooth.speed[:, None] * np.diff(q, axis=-2)).sum(axis=-1)
    if m >= 3:
        bent = sum(smooth.bend[:, i, None] * q[..., i : m - 2 + i, :] for i in range(3))
        costs[..., 1:-1] += 0.5 * np.square(bent).sum(axis=-1)
    if smooth.posture_cost is not None:
        costs += smooth.share * smooth.posture_cost.evaluate(q.reshape(-1, q.shape[-1])).reshape(costs.shape)
    return np.asarray(costs / smooth.scale)


def part_of(smooth: Smoothness, part: slice) -> Smoothness:
    """The objective over a stretch of the samples; what reaches over its ends is left out.

    Args:
        smooth: The objective.
        part: The samples of the stretch, first and last given.

    Returns:
        The objective over them.

    Source:
        None (bookkeeping).
    """
    first, stop = part.start, part.stop
    return replace(
        smooth,
        speed=smooth.speed[first : stop - 1],
        bend=smooth.bend[first : max(first, stop - 2)],
        hold=smooth.hold[part],
        aim=smooth.aim[part],
        share=None if smooth.share is None else smooth.share[part],
    )
