"""Axis times angle of a rotation."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def rotation_vector(E: Array) -> Array:
    """Axis times angle of a rotation: E = exp([w]×), |w| ≤ π.

    Through the unit quaternion, scaled by four times its largest component, so that it is exact at 0, at
    half a turn, and everywhere between.

    Args:
        E: Rotation matrix, shape (3, 3).

    Returns:
        Shape (3,), in [rad].

    Source:
        Al-Faiz, eq. 51 and 53, corrected; Shepperd (1978), doi:10.2514/3.55767b.
    """
    trace = float(np.trace(E))
    v = np.array([E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])
    scalar = 1.0 + trace
    if not trace > 0:
        i = int(np.argmax(np.diag(E)))
        j, k = (i + 1) % 3, (i + 2) % 3
        scalar = v[i]
        v = E[i] + E[:, i]
        v[i] = 1.0 + E[i, i] - E[j, j] - E[k, k]
    length = math.sqrt(float(v @ v))
    if length > 1e-15:
        angle = 2.0 * math.atan2(length, abs(scalar))
        return np.asarray(v * (angle / (-length if scalar < 0 else length)))
    return np.asarray(v * (2.0 / scalar))
