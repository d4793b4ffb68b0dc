"""Joints whose range of motion is a turn or more: which of the motions whole turns apart is meant."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.swivel.constants import TURN

Array = NDArray[np.float64]

# A motion that begins or ends at a limit may be outside by this much for rounding, in [rad].
_ROUNDED = 1e-9


def in_best_turn(q: Array, wide: NDArray[np.bool_], rom: RangeOfMotion, aim: Array, share: Array) -> Array:
    """Turn joints as a whole by the multiple of 2π that keeps them in range and nearest to a posture.

    min over whole k of ∫ (q_j + 2πk - aim_j)² dt, that is k = round((aim_j - mean q_j)/2π), with lower_j ≤
    q_j + 2πk ≤ upper_j if any k does that, and as little beyond both as possible if none does.

    Args:
        q: Joint angles, shape (n, dof), in [rad].
        wide: Joints to be turned, shape (dof,).
        rom: Range of motion.
        aim: Preferred posture, shape (dof,), in [rad].
        share: Time each sample stands for, shape (n,), in [s].

    Returns:
        Shape (n, dof), in [rad].

    Source:
        None (this package).
    """
    turns = np.zeros(q.shape[1])
    least, most = q.min(axis=0), q.max(axis=0)
    mean = share @ q / share.sum()
    for j in np.flatnonzero(wide):
        first = np.ceil((rom.lower[j] - least[j] - _ROUNDED) / TURN)
        last = np.floor((rom.upper[j] - most[j] + _ROUNDED) / TURN)
        if first <= last:
            turns[j] = np.clip(np.rint((aim[j] - mean[j]) / TURN), first, last)
        else:
            turns[j] = np.rint((rom.middle[j] - 0.5 * (least[j] + most[j])) / TURN)
    return np.asarray(q + TURN * turns)
