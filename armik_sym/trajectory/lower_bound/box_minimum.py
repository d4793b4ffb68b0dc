"""Minima of quadratics over [-1, 1] and over the square, in closed form and for many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Relative determinant below which a quadratic counts as flat in one direction.
_FLAT = 1e-9


def line_minimum(slope: Array, curvature: Array) -> Array:
    """Least value over -1 ≤ x ≤ 1 of slope·x + ½·curvature·x².

    With h > |l| the stationary point -l/h is inside and the minimum is -l²/2h; otherwise (also for h ≤ 0)
    it is at an end: ½h - |l|.

    Args:
        slope: l, any shape.
        curvature: h, of a shape that goes with it.

    Returns:
        Minima, of the common shape.

    Source:
        None (elementary).
    """
    size = np.abs(slope)
    inside = curvature > size
    return np.asarray(
        np.where(inside, -0.5 * slope * slope / np.where(inside, curvature, 1.0), 0.5 * curvature - size)
    )


def square_minimum(a: Array, b: Array, haa: Array, hab: Array, hbb: Array) -> Array:
    """Least value over -1 ≤ x, y ≤ 1 of a·x + b·y + ½·haa·x² + hab·x·y + ½·hbb·y².

    The minimum is on one of the four sides, or, if the matrix is positive definite, where the gradient is
    zero. If the matrix has a determinant of at most ω·haa·hbb the least curvature is at most
    ω·(haa + hbb)/2: along its direction (at most 2√2 long, downhill) a side is reached that lies at most
    2ω·(haa + hbb) higher; that much is subtracted and the inside is left out.

    Args:
        a: Slope along x, any shape.
        b: Slope along y; all five have shapes that go with each other.
        haa: Curvature along x.
        hab: Mixed second derivative.
        hbb: Curvature along y.

    Returns:
        Lower bounds that equal the minima up to that allowance.

    Source:
        None (elementary).
    """
    sides = [0.5 * haa + sign * a + line_minimum(b + sign * hab, hbb) for sign in (1.0, -1.0)]
    sides += [0.5 * hbb + sign * b + line_minimum(a + sign * hab, haa) for sign in (1.0, -1.0)]
    least = np.minimum(np.minimum(sides[0], sides[1]), np.minimum(sides[2], sides[3]))
    product, determinant = haa * hbb, haa * hbb - hab * hab
    convex = (haa > 0) & (hbb > 0) & (determinant > _FLAT * product)
    safe = np.where(convex, determinant, 1.0)
    x, y = (hab * b - hbb * a) / safe, (hab * a - haa * b) / safe
    inside = convex & (np.abs(x) <= 1) & (np.abs(y) <= 1)
    least = np.where(inside, np.minimum(least, 0.5 * (a * x + b * y)), least)
    return np.asarray(least - 2 * _FLAT * (np.maximum(haa, 0.0) + np.maximum(hbb, 0.0)))
