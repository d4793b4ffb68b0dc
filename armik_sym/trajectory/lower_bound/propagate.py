"""One step of dynamic programming over cells, with a parabola below the least cost on each cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.lower_bound.box_minimum import line_minimum, square_minimum

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Share τ of the stiffness that is given up for the curvature of cells that overlap.
_USUAL_SHARE = 0.05
_SAME = 1e-12
_BLOCK = 200_000


@dataclass(frozen=True, eq=False)
class Layer:
    """Cells of one knot relative to its reference posture: e = centre + tangent·x + ρ, |ρ| ≤ radius.

    Attributes:
        centre: Shape (m, dof), in [rad].
        tangent: Shape (m, dof), in [rad].
        radius: Shape (m,), in [rad].
        node: n0, n1, n2: n0 + n1·x + ½·n2·x² is at most the cost of the knot itself, shape (3, m).
    """

    centre: Array
    tangent: Array
    radius: Array
    node: Array

    def rows(self, part: slice) -> Layer:
        """Some of the cells.

        Args:
            part: Which.

        Returns:
            Those cells.

        Source:
            None (bookkeeping).
        """
        return Layer(self.centre[part], self.tangent[part], self.radius[part], self.node[:, part])


def layer_of(
    centre: Array, tangent: Array, spread: Array, smooth: Mask, weight: float, force: Array
) -> Layer:
    """Cells with a lower bound of ½·w·|e|² + f·e.

    f·ρ ≥ -Σ|f_i|·spread_i, times x² on smooth cells; |d + ρ|² ≥ (1 - τ)·|d|² - (1/τ - 1)·|ρ|² for 0 < τ ≤ 1.

    Args:
        centre: Centres minus reference, shape (m, dof), in [rad].
        tangent: Shape (m, dof), in [rad].
        spread: Bound of |ρ_i|, shape (m, dof), in [rad].
        smooth: Whether |ρ_i| ≤ spread_i·x², shape (m,).
        weight: w ≥ 0.
        force: f, shape (dof,).

    Returns:
        The layer.

    Source:
        None (this package).
    """
    radius = np.linalg.norm(spread, axis=1)
    size = np.linalg.norm(centre, axis=1)
    share = _share(radius, size, np.linalg.norm(tangent, axis=1))
    w, loss = weight * (1 - share), spread @ np.abs(force)
    n0 = centre @ force + 0.5 * w * size**2 - 0.5 * weight * (1 / share - 1) * radius**2
    n1 = tangent @ force + w * (centre * tangent).sum(axis=1)
    n2 = w * (tangent * tangent).sum(axis=1)
    node = np.stack([np.where(smooth, n0, n0 - loss), n1, np.where(smooth, n2 - 2 * loss, n2)])
    return Layer(centre, tangent, radius, node)


def step(before: Layer, value: Array, after: Layer, stiffness: float) -> Array:
    r"""From lower bounds of the least cost on the cells of one knot to those of a neighbouring knot.

    V_b(y) = node_b(y) + min over cells a and x of V_a(x) + ½C|D + ρ|² with D = e_b + t_b·y - e_a - t_a·x and
    |ρ| ≤ ε = radius_a + radius_b. As |D + ρ|² ≥ (1 - τ)|D|² - (1/τ - 1)ε² for every 0 < τ ≤ 1, each pair of
    cells has a quadratic in (x, y). Slope g and curvature η of V_b are those of the parabola through least
    values at y = -1, 0, 1. Whatever they are, v = min over a, x, y of (… - g·y - ½η·y²) makes v + g·y + ½η·y²
    a lower bound.

    Args:
        before: Cells of the one knot.
        value: v, g, η of each of them, shape (3, m).
        after: Cells of the other.
        stiffness: C ≥ 0.

    Returns:
        v, g, η of the other, shape (3, k).

    Source:
        None (this package).
    """
    rows = max(1, _BLOCK // len(before.centre))
    parts = [slice(i, i + rows) for i in range(0, len(after.centre), rows)]
    return np.hstack([_step(before, value, after.rows(part), stiffness) for part in parts])


def _step(before: Layer, value: Array, after: Layer, stiffness: float) -> Array:
    E, T, F, U = before.centre, before.tangent, after.centre, after.tangent
    square = (F * F).sum(axis=1)[:, None] + (E * E).sum(axis=1) - 2 * (F @ E.T)
    square = np.maximum(square, 0.0)
    epsilon = after.radius[:, None] + before.radius
    length = np.sqrt((U * U).sum(axis=1))[:, None] + np.sqrt((T * T).sum(axis=1))
    share = _share(epsilon, np.sqrt(square), length)
    C = stiffness * (1 - share)
    K = value[0] + 0.5 * C * square - 0.5 * stiffness * (1 / share - 1) * epsilon**2
    a = value[1] - C * (F @ T.T - (E * T).sum(axis=1))
    b = C * ((F * U).sum(axis=1)[:, None] - U @ E.T)
    haa, hbb = value[2] + C * (T * T).sum(axis=1), C * (U * U).sum(axis=1)[:, None]
    hab = -C * (U @ T.T)
    low, middle, high = (
        (K + y * b + 0.5 * y * y * hbb + line_minimum(a + y * hab, haa)).min(axis=1) for y in (-1.0, 0.0, 1.0)
    )
    slope, bend = 0.5 * (high - low), high + low - 2 * middle
    b, hbb = b - slope[:, None], hbb - bend[:, None]
    least = _least(K, a, b, haa, hab, hbb)
    return np.asarray(np.stack([least, slope, bend]) + after.node)


def _share(epsilon: Array, distance: Array, length: Array) -> Array:
    """The share τ of the stiffness given up: about ε/|D|, at which (1 - τ)|D|² - (1/τ - 1)ε² is largest.

    Centres are `distance` apart, and |D| is that up to `length`. Where |D| may be 0 it matters little, and a
    share of a certain size keeps ε²/τ small; where ε is larger than all of |D| nothing is left: τ = 1.
    """
    apart = np.maximum(distance - length, 0.0)
    least = np.minimum(_USUAL_SHARE, epsilon / (apart + _SAME))
    return np.asarray(np.clip(epsilon / (distance + length + _SAME), least, 1.0))


def _least(K: Array, a: Array, b: Array, haa: Array, hab: Array, hbb: Array) -> Array:
    """Least K + square_minimum(…) of each row, looking only at pairs that may hold it."""
    floor = K - np.abs(a) - np.abs(b) - np.abs(hab) + 0.5 * (np.minimum(haa, 0.0) + np.minimum(hbb, 0.0))
    worth = floor <= K.min(axis=1)[:, None]
    chosen = np.flatnonzero(worth)
    some = K.ravel()[chosen] + square_minimum(*(x.ravel()[chosen] for x in (a, b, haa, hab, hbb)))
    first = np.concatenate([[0], np.cumsum(worth.sum(axis=1))[:-1]])
    return np.minimum.reduceat(some, first)
