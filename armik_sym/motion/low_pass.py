"""Zero-phase low-pass filter for recordings with gaps."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import OptionError, RecordingError
from armik_sym.motion.marker_gaps import runs

Array = NDArray[np.float64]

_ORDER = 2
_STEP_TOLERANCE = 0.05


def low_pass(values: Array, rate: float, cutoff_hz: float) -> Array:
    """Butterworth filter of second order, run forwards and backwards: |H(f)|² = ½ at the cut-off.

    Two passes would lower the cut-off; it is raised beforehand by (√2 - 1)^(-1/4), on the warped
    frequency axis of the bilinear transform, so that the filter as a whole has the cut-off asked for.
    Every stretch between gaps is filtered by itself, extended at its ends by its odd mirror image;
    gaps stay gaps.

    Args:
        values: One signal for each column, shape (n, k); NaN in a row is a gap of that row.
        rate: Samples per second, in [Hz].
        cutoff_hz: Frequency at which the amplitude falls to 1/√2, in [Hz].

    Returns:
        Filtered signals, shape (n, k).

    Raises:
        OptionError: If the cut-off is not between 0 and half the rate.

    Source:
        Winter (2009), Biomechanics and motor control of human movement, section 3.4.4.2.
    """
    from scipy.signal import butter, sosfiltfilt  # slow to import, and most recordings are not filtered

    check_cutoff(rate, cutoff_hz)
    once = math.tan(math.pi * cutoff_hz / rate) / (math.sqrt(2.0) - 1.0) ** (1.0 / (2 * _ORDER))
    sos = butter(_ORDER, 2.0 / math.pi * math.atan(once), output="sos")
    extension = max(3 * (2 * len(sos) + 1), math.ceil(rate / cutoff_hz))
    filtered = values.copy()
    for first, end in runs(~np.isnan(values).any(axis=1)):
        if end - first > 1:
            stretch = values[first:end]
            filtered[first:end] = sosfiltfilt(sos, stretch, axis=0, padlen=min(extension, end - first - 1))
    return filtered


def check_cutoff(rate: float, cutoff_hz: float) -> None:
    """Refuse cut-offs the samples cannot carry: 0 < f_c < rate / 2.

    Args:
        rate: Samples per second, in [Hz].
        cutoff_hz: The cut-off, in [Hz].

    Raises:
        OptionError: If it is outside.

    Source:
        Shannon (1949), Communication in the presence of noise.
    """
    if not 0 < cutoff_hz < rate / 2:
        raise OptionError(
            f"cutoff_hz is {cutoff_hz!r}, expected more than 0 and less than half the sampling rate, "
            f"{rate / 2:g} Hz"
        )


def check_even(time: Array) -> None:
    """Refuse times that are not evenly spaced: all steps within 5 % of their median.

    Args:
        time: Times, shape (n,), in [s].

    Raises:
        RecordingError: If a step differs; names the first.

    Source:
        None (this package).
    """
    steps = np.diff(time)
    if not steps.size:
        return
    usual = float(np.median(steps))
    uneven = np.flatnonzero(np.abs(steps - usual) > _STEP_TOLERANCE * usual)
    if uneven.size:
        i = int(uneven[0])
        raise RecordingError(
            f"times are not evenly spaced: {steps[i]:.6g} s after sample {i}, usually {usual:.6g} "
            "s; a filter needs even steps: interpolate the recording to a fixed rate first"
        )
