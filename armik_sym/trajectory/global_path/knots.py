"""Which samples the global search looks at."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.intervals import FeasibleIntervals

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Between two knots the hand turns and shifts, relative to the arm's length, by this much at most …
_HAND_MOTION = 0.15
# … and this much time passes, in [s].
_TIME = 0.15
_FEWEST = 12
# Short paths can afford that; of what goes beyond so many knots a long path gets this share.
_SHORT = 60
_SHARE = 0.7
# Bend of the elbow below which a motion may change its side there, in [rad] …
_STRAIGHT = 0.3
# … and how many samples before and after the least bend become knots.
_AROUND = 2


def knots(path: HandPath, reach: float) -> Indices:
    """Samples spread so that the hand moves about as far between any two neighbours.

    Args:
        path: The hand path, with rotations.
        reach: Length of the arm, in [m].

    Returns:
        Increasing indices, the first and the last sample among them, shape (m,).

    Source:
        None (this package).
    """
    n = len(path)
    shift = np.linalg.norm(np.diff(path.position, axis=0), axis=1) / reach
    turn = np.zeros(n - 1)
    if path.rotation is not None:
        away = np.linalg.norm(np.diff(path.rotation, axis=0), axis=(1, 2))  # 2·√2·sin(angle/2)
        turn = 2 * np.arcsin(np.minimum(away / np.sqrt(8), 1.0))
    effort = np.maximum((shift + turn) / _HAND_MOTION, np.diff(path.time) / _TIME)
    covered = np.concatenate([[0.0], np.cumsum(effort)])
    wanted = min(covered[-1], _SHORT) + _SHARE * max(covered[-1] - _SHORT, 0.0)
    count = int(min(n - 1, max(np.ceil(wanted), _FEWEST)))
    even = np.linspace(0.0, covered[-1], count + 1)
    return np.unique(np.concatenate([[0], np.searchsorted(covered, even[1:-1]), [n - 1]])).astype(np.int64)


def straight_arm_knots(intervals: FeasibleIntervals) -> Indices:
    """Samples around those where the arm is straightest, if the elbow can bend to either side there.

    Bending on to the same side and passing through differ by accelerations that only neighbouring samples
    show.

    Args:
        intervals: The feasible intervals.

    Returns:
        Increasing indices, shape (k,).

    Source:
        None (this package).
    """
    between = intervals.curves[0].elbow - intervals.curves[1].elbow
    bend = 0.5 * np.abs(between - TURN * np.rint(between / TURN))
    sides = [~intervals.empty[:, intervals.branches[:, 0] == side].all(axis=1) for side in (1, -1)]
    padded = np.concatenate([[np.inf], bend, [np.inf]])
    least = (bend <= padded[:-2]) & (bend < padded[2:]) & (bend < _STRAIGHT) & sides[0] & sides[1]
    around = np.flatnonzero(least)[:, None] + np.arange(-_AROUND, _AROUND + 1)
    return np.unique(np.clip(around, 0, len(bend) - 1)).astype(np.int64)
