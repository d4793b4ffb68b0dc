"""Dynamic programming in both directions: a bound for every cell, and the least chain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.lower_bound.box_minimum import line_minimum
from armik_sym.trajectory.lower_bound.propagate import Layer, step

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Passes:
    """Least costs of chains of cells.

    Attributes:
        ahead: v, g, η of the least cost from the first knot up to and with a cell, shape (3, m) per knot.
        back: The same from the last knot.
        through: Lower bound of every chain through a cell, shape (m,) per knot.
    """

    ahead: list[Array]
    back: list[Array]
    through: list[Array]


def both_ways(layers: Sequence[Layer], stiffness: Array) -> Passes:
    """Bound every chain through every cell.

    A chain through posture x of a cell costs at least ahead(x) + back(x) - node(x).

    Args:
        layers: Cells of the knots, at least one each.
        stiffness: Between neighbouring knots, shape (J - 1,).

    Returns:
        The bounds.

    Source:
        Bellman (1957), Dynamic Programming.
    """
    ahead = _costs(layers, stiffness)
    back = _costs(layers[::-1], stiffness[::-1])[::-1]
    through = []
    for there, home, layer in zip(ahead, back, layers, strict=True):
        v, g, eta = there + home - layer.node
        through.append(v + line_minimum(g, eta))
    return Passes(ahead, back, through)


def _costs(layers: Sequence[Layer], stiffness: Array) -> list[Array]:
    costs = [layers[0].node]
    for before, after, C in zip(layers[:-1], layers[1:], stiffness.tolist(), strict=True):
        costs.append(step(before, costs[-1], after, C))
    return costs


def least_chain(passes: Passes, layers: Sequence[Layer], stiffness: Array, knot: int, cell: int) -> Array:
    """The chain of postures through one cell that costs about least: a hint, nothing is certified with it.

    Args:
        passes: Least costs.
        layers: Cells of the knots.
        stiffness: Between neighbouring knots, shape (J - 1,).
        knot: Where to start.
        cell: Which cell of that knot.

    Returns:
        Postures minus reference, shape (J, dof), in [rad].

    Source:
        None (greedy on both sides).
    """
    layer = layers[knot]
    _, slope, bend = (passes.ahead[knot] + passes.back[knot] - layer.node)[:, cell]
    e = np.empty((len(layers), layer.centre.shape[1]))
    e[knot] = layer.centre[cell] + layer.tangent[cell] * _least_at(slope, bend)
    for j in range(knot - 1, -1, -1):
        e[j] = _nearest(e[j + 1], layers[j], passes.ahead[j], stiffness[j])
    for j in range(knot + 1, len(layers)):
        e[j] = _nearest(e[j - 1], layers[j], passes.back[j], stiffness[j - 1])
    return e


def _nearest(e: Array, layer: Layer, cost: Array, stiffness: float) -> Array:
    """The posture of a layer that costs least together with the way to e."""
    away, t = layer.centre - e, layer.tangent
    slope = cost[1] + stiffness * (away * t).sum(axis=1)
    bend = cost[2] + stiffness * (t * t).sum(axis=1)
    total = cost[0] + 0.5 * stiffness * (away * away).sum(axis=1) + line_minimum(slope, bend)
    a = int(np.argmin(total))
    return np.asarray(layer.centre[a] + t[a] * _least_at(slope[a], bend[a]))


def _least_at(slope: float, bend: float) -> float:
    """Where slope·x + ½·bend·x² is least on [-1, 1]."""
    return float(-slope / bend if bend > abs(slope) else -np.sign(slope))
