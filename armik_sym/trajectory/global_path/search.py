"""The global search: the cheapest ways through the swivel map, each in a corridor of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.build import Library
from armik_sym.trajectory.global_path.elbow_change import ELBOW
from armik_sym.trajectory.global_path.nodes import Nodes
from armik_sym.trajectory.global_path.shortest_path import Edges, Reached, shortest_path

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Ways whose postures differ by less than this everywhere are one, in [rad] …
DIFFERENT = 0.25
# … where the elbow, if it is bent to the other side, counts this many times more.
_ACROSS = 4.0


@dataclass(frozen=True, eq=False)
class Way:
    """One way through the nodes.

    Attributes:
        sample: Samples it was chosen at, shape (m,).
        branch: Branch at each, shape (m,).
        psi: Swivel angle at each, the shorter way round from one to the next, shape (m,), in [rad].
        q: Posture at each, shape (m, dof), in [rad].
        cost: What the search took it to cost.
    """

    sample: Indices
    branch: Indices
    psi: Array
    q: Array
    cost: float

    @property
    def side(self) -> Indices:
        """Side of the elbow at each, 0 for 1 and 1 for -1, shape (m,)."""
        return np.asarray(self.branch >= 4, dtype=np.int64)

    def straight(self, time: Array, samples: Indices | None = None) -> Array:
        """Joint angles straight from one of its samples to the next.

        Args:
            time: Time stamps of the path, shape (n,), in [s].
            samples: Where they are wanted, shape (k,); at all n samples if left out.

        Returns:
            Shape (k, dof), in [rad].

        Source:
            None (linear interpolation).
        """
        at = time if samples is None else time[samples]
        return np.array([np.interp(at, time[self.sample], column) for column in self.q.T]).T


class WaySearch:
    """The cheapest ways through the nodes.

    With the cheapest ways to a node from the first layer and from the last, their sum tells what the cheapest
    way through that node costs. Another way passes where this is least among the neighbours, far from the
    ways already known.

    Args:
        nodes: The nodes.
        cost: Cost of every node, shape (m,).
        edges: What steps cost.
        library: The compiled loops; None for NumPy.

    Source:
        Bellman (1957), Dynamic programming; the through-cost of every node: this package.
    """

    def __init__(self, nodes: Nodes, cost: Array, edges: Edges, library: Library | None) -> None:
        self._nodes, self._cost, self._edges, self._library = nodes, cost, edges, library
        self._forward = shortest_path(nodes.q, cost, nodes.side, nodes.first, edges, library)
        self._backward: Reached | None = None
        self._valleys = np.zeros(0, dtype=np.int64)
        self._through = self._forward.total

    def cheapest(self) -> Way | None:
        """The cheapest way.

        Returns:
            The way; None if none leads through.

        Source:
            Bellman (1957), Dynamic programming.
        """
        last = slice(int(self._nodes.first[-2]), int(self._nodes.first[-1]))
        if last.start == last.stop or not np.isfinite(self._forward.total[last].min()):
            return None
        end = int(last.start + self._forward.total[last].argmin())
        return _way(self._nodes, self._forward.way_to(end), float(self._forward.total[end]))

    def another(self, known: Sequence[Way], limit: float) -> Way | None:
        """The cheapest way that passes some layer far from all known ones.

        Args:
            known: Ways with postures at the same layers; the ones new since the last call are enough.
            limit: What it may cost at most.

        Returns:
            The way; None if there is no further one.

        Source:
            None (this package).
        """
        if self._backward is None:
            self._backward = _backward(self._nodes, self._cost, self._edges, self._library)
            self._through = self._forward.total + self._backward.total - self._cost
            self._valleys = _valleys(self._nodes, self._through)
        for way in known:
            self._valleys = self._valleys[_distance(self._nodes, self._valleys, way) > DIFFERENT]
        valleys = self._valleys
        if not valleys.size or self._through[valleys[0]] > limit:
            return None
        node = int(valleys[0])
        there, back = self._forward.way_to(node), self._backward.way_to(node)
        chosen = np.concatenate([there, back[::-1][1:]])
        return _way(self._nodes, chosen, float(self._through[node]))


def _backward(nodes: Nodes, cost: Array, edges: Edges, library: Library | None) -> Reached:
    """The cheapest ways from every node to the last layer."""
    m = len(cost)
    first = m - nodes.first[::-1]
    found = shortest_path(
        np.ascontiguousarray(nodes.q[::-1]), cost[::-1], nodes.side[::-1], first, edges.reversed(), library
    )
    after = found.previous[::-1]
    return Reached(found.total[::-1].copy(), np.where(after >= 0, m - 1 - after, -1))


def _valleys(nodes: Nodes, through: Array) -> Indices:
    """Nodes that are cheaper to pass than their neighbours in the layer, the cheapest first."""
    same_next = (nodes.layer[1:] == nodes.layer[:-1]) & (nodes.branch[1:] == nodes.branch[:-1])
    lower = np.ones(len(through), dtype=np.bool_)
    lower[1:] &= ~same_next | (through[1:] <= through[:-1])
    lower[:-1] &= ~same_next | (through[:-1] <= through[1:])
    found = np.flatnonzero(lower & np.isfinite(through))
    return found[np.argsort(through[found], kind="stable")]


def _distance(nodes: Nodes, chosen: Indices, way: Way) -> Array:
    """How far nodes are from the posture of a way in the same layer; across the straight arm counts more."""
    away = np.abs(nodes.q[chosen] - way.q[nodes.layer[chosen]])
    across = nodes.side[chosen] != way.side[nodes.layer[chosen]]
    return np.asarray(away.max(axis=1) + _ACROSS * across * away[:, ELBOW])


def _way(nodes: Nodes, chosen: Indices, cost: float) -> Way:
    psi = np.unwrap(nodes.psi[chosen])
    return Way(nodes.sample[chosen], nodes.branch[chosen], psi, nodes.q[chosen], cost)
