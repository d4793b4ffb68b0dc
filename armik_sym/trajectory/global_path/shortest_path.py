"""The shortest path through layers of postures, by dynamic programming, in C or in NumPy."""

from __future__ import annotations

import ctypes
import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.address import address
from armik_sym.compiled.build import Library
from armik_sym.swivel.constants import TURN

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Edges:
    """What a step from one layer to the next costs: ½·weight·|q_b - q_a|² + change(side_a, side_b).

    Attributes:
        weight: One per step, shape (layers - 1,), in [1/s] times the speed weight.
        most: How far a joint may move in a step, shape (layers - 1, dof), in [rad].
        turns: Joints that take the shorter way round, shape (dof,).
        change: By the side before and after, shape (layers - 1, 2, 2).
    """

    weight: Array
    most: Array
    turns: NDArray[np.bool_]
    change: Array

    def reversed(self) -> Edges:
        """The same steps from the last layer to the first.

        Returns:
            New edges.

        Source:
            None (bookkeeping).
        """
        back = np.swapaxes(self.change[::-1], 1, 2)
        return Edges(self.weight[::-1].copy(), self.most[::-1].copy(), self.turns, np.ascontiguousarray(back))


@dataclass(frozen=True, eq=False)
class Reached:
    """The cheapest way to every node.

    Attributes:
        total: Its cost, the node's own included, shape (m,); infinite if there is none.
        previous: The node before, shape (m,); -1 in the first layer or if there is none.
    """

    total: Array
    previous: Indices

    def way_to(self, node: int) -> Indices:
        """The nodes from the first layer to one node.

        Args:
            node: Index of the node.

        Returns:
            One node per layer.

        Source:
            None (bookkeeping).
        """
        way = [node]
        while (before := int(self.previous[way[-1]])) >= 0:
            way.append(before)
        return np.array(way[::-1], dtype=np.int64)


def shortest_path(
    q: Array, cost: Array, side: Indices, first: Indices, edges: Edges, library: Library | None
) -> Reached:
    """Cheapest ways from the first layer to all nodes.

    total_b = cost_b + min over the layer before of total_a + ½·weight·|q_b - q_a|².

    Args:
        q: Postures, layer after layer, shape (m, dof), in [rad].
        cost: Cost of every node, shape (m,).
        side: Side of the elbow of every node, 0 or 1, shape (m,).
        first: Where each layer begins, and m, shape (layers + 1,).
        edges: What steps cost.
        library: The compiled loops; None for NumPy.

    Returns:
        The ways.

    Source:
        Bellman (1957), Dynamic programming.
    """
    if library is None:
        return _numpy(q, cost, side, first, edges)
    bounds = first.tolist()
    flat = np.concatenate([q[a:b].T.ravel() for a, b in itertools.pairwise(bounds)] or [cost])
    total, previous = np.empty(len(q)), np.empty(len(q), dtype=np.int64)
    work = np.empty(max(1, int(np.diff(first).max(initial=0))))
    arrays = (
        flat,
        np.ascontiguousarray(cost),
        side.astype(np.int32),
        edges.turns.astype(np.int32),
        edges.weight,
        edges.most,
        edges.change,
    )
    places = np.ascontiguousarray(first, dtype=np.intp)
    function = library.handle.armik_shortest_path
    function.restype = None
    function(
        ctypes.c_ssize_t(len(first) - 1),
        address(places),
        ctypes.c_ssize_t(q.shape[1]),
        *(address(array) for array in arrays),
        address(total),
        address(previous),
        address(work),
    )
    return Reached(total, previous)


def _numpy(q: Array, cost: Array, side: Indices, first: Indices, edges: Edges) -> Reached:
    total, previous = cost.copy(), np.full(len(q), -1, dtype=np.int64)
    for layer in range(1, len(first) - 1):
        before, here = slice(first[layer - 1], first[layer]), slice(first[layer], first[layer + 1])
        if before.start == before.stop:
            total[here] = np.inf
            continue
        away = q[here][:, None] - q[before][None]
        away[..., edges.turns] -= TURN * np.rint(away[..., edges.turns] / TURN)
        far = (np.abs(away) > edges.most[layer - 1]).any(axis=2)
        way = 0.5 * edges.weight[layer - 1] * np.square(away).sum(axis=2)
        way += edges.change[layer - 1][side[before][None], side[here][:, None]]
        way = np.where(far, np.inf, way) + total[before]
        best = way.argmin(axis=1)
        least = way[np.arange(len(best)), best]
        total[here] = least + cost[here]
        previous[here] = np.where(np.isfinite(least), best + before.start, -1)
    return Reached(total, previous)
