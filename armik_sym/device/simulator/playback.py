"""A motion played for as long as it takes: its angles at any time."""

from __future__ import annotations

from enum import Enum

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from armik_sym.motion.joint_motion import JointMotion

Array = NDArray[np.float64]


class AtEnd(Enum):
    """What follows when the motion has been played.

    SWING plays it backwards and forwards again, without a step; HOLD keeps its last posture.
    """

    SWING = "swing"
    HOLD = "hold"


class Playback:
    """Joint angles at any time, between the samples of a motion by monotone cubics: no overshoot."""

    def __init__(self, motion: JointMotion, at_end: AtEnd = AtEnd.SWING) -> None:
        """Prepare to play.

        Args:
            motion: The motion; it starts at its first sample.
            at_end: What follows at its end.
        """
        self._duration = motion.duration
        self._at_end = at_end
        self._first = motion.q[0]
        self._curve = PchipInterpolator(motion.time - motion.time[0], motion.q) if motion.n > 1 else None

    def angles(self, time: Array) -> Array:
        """Joint angles at some times.

        Args:
            time: Times since the start, none negative, shape (n,), in [s].

        Returns:
            Angles, shape (n, dof), in [rad].

        Source:
            Fritsch & Carlson 1980 (monotone cubics, as in SciPy).
        """
        if self._curve is None:
            return np.tile(self._first, (len(time), 1))
        if self._at_end is AtEnd.HOLD:
            played = np.minimum(time, self._duration)
        else:
            phase = np.mod(time, 2 * self._duration)
            played = np.minimum(phase, 2 * self._duration - phase)
        return np.asarray(self._curve(played), dtype=np.float64)
