"""The best that pieces of several ways can be joined to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.global_path.row_costs import row_costs
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.global_path.smoothed import Outline, smoothed
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# What it costs to pass from one way to another, once smoothed: per squared distance, in [1/(rad²·s)].
_JOINT = 5.0


def joined(problem: SwivelProblem, outlines: Sequence[Outline], smooth: Smoothness) -> Outline:
    """The cheapest of some ways, or pieces of them joined if that is cheaper still after smoothing.

    Ways that differ in separate stretches of time are often best each in another stretch. The pieces are
    found by dynamic programming over the knots, with the way as state; passing from one to another costs by
    how far they are apart.

    Args:
        problem: The problem.
        outlines: Smoothed ways over the same knots, at least one.
        smooth: The objective over the knots.

    Returns:
        The best.

    Source:
        Bellman (1957), Dynamic programming.
    """
    best = min(outlines, key=lambda each: each.value)
    ways = [each.way for each in outlines]
    q = np.stack([way.q for way in ways])
    pick = cheapest_pieces(row_costs(q, smooth), _JOINT * _square_distances(q))
    if (pick == pick[0]).all():
        return best
    rows = pick, np.arange(len(pick))
    branch, psi = np.stack([way.branch for way in ways])[rows], np.stack([way.psi for way in ways])[rows]
    way: Way = replace(best.way, branch=branch, psi=np.unwrap(psi), q=q[rows])
    new = smoothed(problem, way, smooth)
    return new if new.value < best.value else best


def cheapest_pieces(cost: Array, passing: Array) -> Indices:
    """Which of k ways to be on at each of m rows, so that costs of rows and of passing over are least.

    Args:
        cost: Cost of each row of each way, shape (k, m).
        passing: Cost of passing from way i to way j before row l, shape (k, k, m).

    Returns:
        Shape (m,).

    Source:
        Bellman (1957), Dynamic programming.
    """
    k, m = cost.shape
    total, before = cost[:, 0], np.empty((m, k), dtype=np.int64)
    for row in range(1, m):
        ways = total[:, None] + passing[:, :, row]
        before[row] = ways.argmin(axis=0)
        total = ways.min(axis=0) + cost[:, row]
    pick = np.empty(m, dtype=np.int64)
    pick[-1] = total.argmin()
    for row in range(m - 1, 0, -1):
        pick[row - 1] = before[row, pick[row]]
    return pick


def _square_distances(q: Array) -> Array:
    """Between all pairs of ways at every row, shape (k, k, m)."""
    return np.asarray(np.square(q[:, None] - q[None]).sum(axis=3))
