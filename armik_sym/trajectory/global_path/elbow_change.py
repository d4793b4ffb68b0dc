"""What the acceleration of the elbow costs between two knots, with and without a change of its side.

Where a path touches full stretch, |θ| of the elbow goes down to zero and up again: bending on to the same
side stops and reverses the elbow at once, passing through to the other side (if the range of motion allows
it) does not. The elbow angle is known at every sample, so both can be told exactly.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.equivalent_angles import nearest_in_range
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.rates import smoothness_weights

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

ELBOW = 3


def elbow_angles(intervals: FeasibleIntervals) -> Array:
    """Angle of the elbow on both sides.

    Args:
        intervals: The feasible intervals, with their curves.

    Returns:
        Shape (2, n), in [rad].

    Source:
        None (law of cosines, `SwivelCurve.elbow`).
    """
    rom = intervals.curves[0].spherical.arm.rom
    part = slice(ELBOW, ELBOW + 1)
    lower, upper, middle = rom.lower[part], rom.upper[part], rom.middle[None, part]
    return np.array(
        [nearest_in_range(c.elbow[:, None], lower, upper, middle)[:, 0] for c in intervals.curves]
    )


def elbow_change_costs(theta: Array, time: Array, knots: Indices, weight: float) -> Array:
    """½·weight·∫θ̈² from knot to knot, by the side of the elbow before and after.

    Args:
        theta: Angle of the elbow on both sides, shape (2, n), in [rad].
        time: Time stamps, shape (n,), in [s].
        knots: Samples, increasing, the first and the last among them, shape (m,).
        weight: Weight of squared acceleration, in [s²].

    Returns:
        Shape (m - 1, 2, 2): side before, side after; a change happens at the sample where it costs least.

    Source:
        None (this package).
    """
    n = len(time)
    costs = np.zeros((len(knots) - 1, 2, 2))
    if weight == 0 or n < 3:
        return costs
    bands = smoothness_weights(time, 0.0, weight, 0.0)[1].T
    kept = np.zeros((2, n))
    kept[:, 1:-1] = 0.5 * np.square(
        bands[0] * theta[:, :-2] + bands[1] * theta[:, 1:-1] + bands[2] * theta[:, 2:]
    )
    total = np.cumsum(kept, axis=1)  # up to and including a sample
    first, last = knots[:-1], knots[1:]
    for a in (0, 1):
        costs[:, a, a] = total[a][last] - total[a][first]
        b = 1 - a
        # The change happens after sample j: samples up to j are on side a, the others on side b.
        mixed = np.zeros((2, n))
        early = bands[0] * theta[a, :-2] + bands[1] * theta[a, 1:-1] + bands[2] * theta[b, 2:]
        late = bands[0] * theta[a, :-2] + bands[1] * theta[b, 1:-1] + bands[2] * theta[b, 2:]
        mixed[0, 1:-1] = 0.5 * np.square(early)
        mixed[1, 1:-1] = 0.5 * np.square(late)
        j = np.arange(n - 1)
        change = total[a][j] - kept[a][j] + mixed[0][j] + mixed[1][j + 1] - total[b][j + 1]
        change[first] += kept[a][first]  # belongs to the step before: nothing is to be taken back from it
        least = np.minimum.reduceat(change, first)
        costs[:, a, b] = least + total[b][last] - total[a][first]
    return costs
