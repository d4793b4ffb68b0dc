"""Recorded joint angles at even times, smooth enough to be followed."""

from __future__ import annotations

import itertools
import warnings

import numpy as np

from armik_sym.errors import CalibrationWarning, OptionError, RecordingError
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.low_pass import low_pass

LONGEST_GAP = 0.1
"""Pause that is bridged by a straight line, at most, in [s]: six samples of lost frames at 60 Hz."""


def even_motion(
    motion: JointMotion, rate: float = 100.0, cutoff_hz: float = 6.0, longest_gap: float = LONGEST_GAP
) -> JointMotion:
    """The longest stretch of a recorded motion without a gap, low-pass filtered, at even times.

    Sensors quantise, frames get lost, so recorded angles have steps that no arm makes. Lost samples are
    bridged by straight lines, the whole is filtered forwards and backwards, and read off at the new rate.

    Args:
        motion: Recorded angles.
        rate: Samples per second, in [Hz].
        cutoff_hz: Frequency at which the amplitude falls to 1/√2, in [Hz].
        longest_gap: Pause that is bridged, at most, in [s].

    Returns:
        The motion of that stretch; time is that of the recording.

    Raises:
        OptionError: If the rate is not positive, or the cut-off is not below half of it, or of the recorded
            rate.
        RecordingError: If no stretch has a tenth of a second.

    Source:
        Winter (2009), Biomechanics and motor control of human movement, section 3.4.4.2 (the filter).
    """
    from scipy.interpolate import CubicSpline  # slow to import, and recording does without

    if not rate > 0 or not 0 < cutoff_hz < rate / 2:
        raise OptionError(
            f"rate is {rate:g} Hz, cutoff_hz {cutoff_hz:g} Hz: the cut-off has to be positive and below "
            "half the rate"
        )
    edges = [0, *(np.flatnonzero(np.diff(motion.time) > longest_gap) + 1).tolist(), motion.n]
    begin, end = max(itertools.pairwise(edges), key=lambda run: _length(motion, *run))
    time, q = motion.time[begin:end], motion.q[begin:end]
    if len(time) < 3 or time[-1] - time[0] < 0.1:
        raise RecordingError(
            f"no stretch of 0.1 s without a gap of more than {longest_gap:g} s: nothing to follow"
        )
    if len(edges) > 2:
        warnings.warn(
            f"the recording has {len(edges) - 2} gaps of more than {longest_gap:g} s: only its longest "
            f"stretch without one is used, {time[0]:.2f} to {time[-1]:.2f} s",
            CalibrationWarning,
            stacklevel=2,
        )
    step = float(np.median(np.diff(time)))
    fine = time[0] + step * np.arange(int((time[-1] - time[0]) / step + 1e-6) + 1)
    filled = np.column_stack([np.interp(fine, time, column) for column in q.T])
    smooth = low_pass(filled, 1.0 / step, cutoff_hz)
    wanted = time[0] + np.arange(int((fine[-1] - time[0]) * rate + 1e-6) + 1) / rate
    return JointMotion(wanted, CubicSpline(fine, smooth)(wanted), motion.joint_names)


def _length(motion: JointMotion, begin: int, end: int) -> float:
    return float(motion.time[end - 1] - motion.time[begin])
