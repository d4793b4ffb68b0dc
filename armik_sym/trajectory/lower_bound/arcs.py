"""Stretches of the feasible intervals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.lower_bound.triple_rates import least_sine
from armik_sym.trajectory.repeated import repeated

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

ANYWHERE = -1

# |sin b| below which a posture is next to a pole.
_NEAR_POLE = 5e-3


@dataclass(frozen=True, eq=False)
class Arcs:
    """Swivel angles between `low` and `high` of one sample and branch.

    Attributes:
        sample: Shape (m,), in increasing order.
        branch: Index into the branches of the intervals; `ANYWHERE` if the sample has no interval of its own
            and its posture may be anything in a box, shape (m,).
        low: Shape (m,), in [rad].
        high: Shape (m,), in [rad].
    """

    sample: Indices
    branch: Indices
    low: Array
    high: Array

    def __len__(self) -> int:
        return len(self.sample)

    def rows(self, chosen: Mask | Indices) -> Arcs:
        """Some of the arcs.

        Args:
            chosen: A mask or indices.

        Returns:
            Those arcs.

        Source:
            None (bookkeeping).
        """
        return Arcs(self.sample[chosen], self.branch[chosen], self.low[chosen], self.high[chosen])

    def followed_by(self, others: Arcs) -> Arcs:
        """These arcs and then others.

        Args:
            others: The others.

        Returns:
            All of them.

        Source:
            None (bookkeeping).
        """
        return Arcs(
            np.concatenate([self.sample, others.sample]),
            np.concatenate([self.branch, others.branch]),
            np.concatenate([self.low, others.low]),
            np.concatenate([self.high, others.high]),
        )

    def halved(self, chosen: Mask) -> tuple[Arcs, Indices]:
        """Some arcs cut in the middle, the others as they are.

        Args:
            chosen: Which to cut, shape (m,).

        Returns:
            The arcs, and for each the index of the arc it came from.

        Source:
            None (bookkeeping).
        """
        parent = np.arange(len(self)).repeat(np.where(chosen, 2, 1))
        first = np.diff(parent, prepend=-1) > 0
        middle = 0.5 * (self.low + self.high)
        some, cut = self.rows(parent), chosen[parent]
        low = np.where(cut & ~first, middle[parent], some.low)
        high = np.where(cut & first, middle[parent], some.high)
        return Arcs(some.sample, some.branch, low, high), parent


def arcs_of(intervals: FeasibleIntervals, samples: Indices, width: float) -> Arcs:
    """The feasible intervals of some samples, cut into arcs of at most a given width.

    A sample without intervals gets one arc that stands for any posture in its box.

    Args:
        intervals: The feasible intervals.
        samples: Increasing samples.
        width: Largest width, in [rad].

    Returns:
        The arcs, sorted by sample.

    Source:
        None (bookkeeping).
    """
    rows = np.flatnonzero(np.isin(intervals.sample, samples))
    start, end = intervals.start[rows], intervals.end[rows]
    count = np.maximum(np.ceil((end - start) / width), 1).astype(np.int64)
    row, number = repeated(count)
    step = ((end - start) / count)[row]
    low = start[row] + step * number
    high = np.where(number + 1 == count[row], end[row], start[row] + step * (number + 1))
    found = Arcs(intervals.sample[rows][row], intervals.branch[rows][row], low, high)
    both = found.followed_by(anywhere(np.setdiff1d(samples, intervals.sample)))
    return both.rows(np.argsort(both.sample, kind="stable"))


def near_pole(intervals: FeasibleIntervals) -> Mask:
    """Samples where a feasible posture is next to a pole of shoulder or wrist.

    Two angles can then be nearly anything, and a cell says little about the posture.

    Args:
        intervals: The feasible intervals.

    Returns:
        Shape (n,).

    Source:
        None (this package).
    """
    near = np.zeros(len(intervals.curves[0].elbow), dtype=np.bool_)
    middle, half = 0.5 * (intervals.start + intervals.end), 0.5 * (intervals.end - intervals.start)
    for side, curve in zip((1, -1), intervals.curves, strict=True):
        rows = intervals.branches[intervals.branch, 0] == side
        sample = intervals.sample[rows]
        for i in range(len(curve.triples)):
            sine, _ = least_sine(curve.parts[sample, i, :, 8], middle[rows], half[rows])
            near[sample[sine < _NEAR_POLE]] = True
    return near


def anywhere(samples: Indices) -> Arcs:
    """Arcs that stand for any posture in the box of a sample.

    Args:
        samples: The samples.

    Returns:
        One arc for each.

    Source:
        None (bookkeeping).
    """
    nothing = np.zeros(len(samples))
    return Arcs(samples, np.full(len(samples), ANYWHERE), nothing, nothing)
