"""How noisy recorded points are, and what a filter leaves of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.motion.low_pass import low_pass

Array = NDArray[np.float64]

# Noise of sd σ has fourth differences of variance (1 + 16 + 36 + 16 + 1) σ².
_WEIGHT = 70.0
_ORDER = 4
# A rotation vector of sd θ per component changes the nine entries of a matrix by 2·3·θ² in total.
_ENTRIES = 6.0


def white_noise(values: Array) -> float:
    """Standard deviation of white noise per coordinate, from fourth differences.

    σ² = mean((Δ⁴x)²) / 70 over all runs of five samples without a gap. Movement of a few hertz has next to no
    fourth differences at 100 samples per second; at low rates some of it counts as noise. Noise that was
    smoothed before, and skin that slides with the movement, are not seen.

    Args:
        values: Evenly sampled positions, shape (n, d), in any unit; NaN where missing.

    Returns:
        Noise in the unit of the values; NaN if there are no five samples in a row.

    Source:
        von Neumann et al. (1941), The mean square successive difference, with fourth differences.
    """
    differences = np.diff(values, n=_ORDER, axis=0)
    seen = differences[np.isfinite(differences).all(axis=1)]
    return float(np.sqrt(np.mean(seen**2) / _WEIGHT)) if len(seen) else float("nan")


def rotation_noise(rotation: Array) -> float:
    """The same for rotations: noise of each component of the rotation vector.

    Args:
        rotation: Shape (n, 3, 3); NaN where missing.

    Returns:
        Noise, in [rad]; NaN if there are no five samples in a row.

    Source:
        von Neumann et al. (1941); small rotations.
    """
    return white_noise(rotation.reshape(-1, 9)) * float(np.sqrt(9.0 / _ENTRIES))


def left_by_filter(rate: float, cutoff_hz: float | None) -> float:
    """Share of white noise that the filter of `MarkerRecording.filtered` leaves: √(Σ h²), h its response.

    Args:
        rate: Samples per second, in [Hz].
        cutoff_hz: Cut-off of the filter, in [Hz]; None if there was none.

    Returns:
        Noise after the filter per noise before; 1 without a filter.

    Source:
        Oppenheim and Schafer, Discrete-Time Signal Processing, §2.10 (noise through a linear filter).
    """
    if cutoff_hz is None:
        return 1.0
    # The response of `low_pass` itself, long enough to fade away.
    length = int(min(max(20 * rate / cutoff_hz, 64), 100_000))
    impulse = np.zeros((2 * length + 1, 1))
    impulse[length] = 1.0
    response = low_pass(impulse, rate, cutoff_hz)
    return float(np.sqrt(np.sum(response**2)))
