"""What a sampled motion does between its samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]


def path_spline(time: Array, q: Array) -> CubicSpline:
    """The natural cubic spline through the samples: of all curves through them the one with the least ∫ |q̈|².

    Args:
        time: Time stamps, shape (n,) with n ≥ 2, in [s].
        q: Joint angles, shape (n, dof), in [rad].

    Returns:
        The spline; two samples are joined by a straight line.

    Source:
        de Boor, A Practical Guide to Splines (1978), ch. V.
    """
    return CubicSpline(time, q, axis=0, bc_type="natural")
