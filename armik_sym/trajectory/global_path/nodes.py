"""The nodes of the global search: postures spread over the feasible intervals of some samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.swivel.closed_form import Postures
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.postures_at import postures_at
from armik_sym.trajectory.global_path.pole_nodes import pole_nodes
from armik_sym.trajectory.repeated import repeated

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_FEWEST = 3
_MOST_BETWEEN = 24
_TURNED = 24


@dataclass(frozen=True, eq=False)
class Nodes:
    """Postures in layers, one layer per knot, sorted by layer.

    Attributes:
        layer: Layer of each node, shape (m,).
        sample: Sample of each node, shape (m,).
        branch: Branch of each node, shape (m,).
        psi: Swivel angle, shape (m,), in [rad].
        q: Posture, shape (m, dof), in [rad].
        first: Where each layer begins, and the number of nodes, shape (layers + 1,).
        side: Side of the elbow, 0 for 1 and 1 for -1, shape (m,).
    """

    layer: Indices
    sample: Indices
    branch: Indices
    psi: Array
    q: Array
    first: Indices
    side: Indices

    def with_first(self, branch: int, side: int, psi: float, q: Array) -> Nodes:
        """The same nodes with a known posture as the only one of the first layer.

        Args:
            branch: Its branch.
            side: Its side of the elbow, 0 or 1.
            psi: Its swivel angle, in [rad].
            q: The posture, shape (dof,), in [rad].

        Returns:
            New nodes.

        Source:
            None (bookkeeping).
        """
        rest = slice(self.first[1], None)
        return Nodes(
            np.concatenate([[0], self.layer[rest]]),
            np.concatenate([[0], self.sample[rest]]),
            np.concatenate([[branch], self.branch[rest]]),
            np.concatenate([[psi], self.psi[rest]]),
            np.vstack([q, self.q[rest]]),
            np.concatenate([[0], self.first[1:] - self.first[1] + 1]),
            np.concatenate([[side], self.side[rest]]),
        )


def spread_nodes(
    intervals: FeasibleIntervals, knots: Indices, spacing: float, backend: Backend = "auto"
) -> Nodes:
    """Nodes on all intervals of the knots, ends included, denser where the joints turn faster.

    Args:
        intervals: The feasible intervals.
        knots: Samples, increasing, shape (layers,).
        spacing: Distance between neighbours aimed at, for the swivel angle and for every joint, in [rad].
        backend: "auto", "c" or "vm".

    Returns:
        The nodes.

    Source:
        None (this package).
    """
    layer_of = np.full(len(intervals.empty), -1)
    layer_of[knots] = np.arange(len(knots))
    row = np.flatnonzero(layer_of[intervals.sample] >= 0)
    width = intervals.end[row] - intervals.start[row]
    count = np.maximum(np.ceil(width / spacing).astype(np.int64) + 1, _FEWEST)
    count[width <= 0] = 1
    interval, place = repeated(count)
    part = place / np.maximum(count[interval] - 1, 1)
    psi = intervals.start[row][interval] + part * width[interval]
    beside_pole, psi_beside = pole_nodes(intervals, row)
    interval, psi = np.concatenate([interval, beside_pole]), np.concatenate([psi, psi_beside])
    order = np.lexsort((psi, interval))
    interval, psi = interval[order], psi[order]
    sample, branch = intervals.sample[row][interval], intervals.branch[row][interval]
    postures = postures_at(intervals.curves, sample, branch, psi, backend=backend)
    q = postures.q
    between, psi_between = _in_between(interval, psi, q, spacing)
    turned, wish = _turned(postures, intervals)
    chosen = np.concatenate([np.arange(len(psi)), between, turned])
    psi = np.concatenate([psi, psi_between, psi[turned]])
    interval, sample, branch = interval[chosen], sample[chosen], branch[chosen]
    new = slice(len(q), len(q) + len(between))
    q_between = postures_at(intervals.curves, sample[new], branch[new], psi[new], backend=backend).q
    last = slice(new.stop, None)
    q_turned = postures_at(intervals.curves, sample[last], branch[last], psi[last], wish, backend=backend).q
    q = np.vstack([q, q_between, q_turned])
    order = np.lexsort((psi, interval, layer_of[sample]))
    layer = layer_of[sample][order]
    first = np.searchsorted(layer, np.arange(len(knots) + 1))
    side = (intervals.branches[branch[order], 0] < 0).astype(np.int64)
    return Nodes(layer, sample[order], branch[order], psi[order], q[order], first, side)


def _turned(postures: Postures, intervals: FeasibleIntervals) -> tuple[Indices, Array]:
    """Nodes at a pole, where a joint of shoulder or wrist turns freely: again, turned to several angles."""
    rom = intervals.curves[0].spherical.arm.rom
    at_pole = np.flatnonzero(postures.degenerate)
    repeated = np.repeat(at_pole, _TURNED)
    wish = postures.q[repeated].copy()
    share = np.tile((np.arange(_TURNED) + 0.5) / _TURNED, len(at_pole))
    first = np.where(postures.shoulder_sine[repeated] <= postures.wrist_sine[repeated], 0, 4)
    wish[np.arange(len(repeated)), first] = rom.lower[first] + share * rom.width[first]
    return repeated, wish


def _in_between(interval: Indices, psi: Array, q: Array, spacing: float) -> tuple[Indices, Array]:
    """Further swivel angles where neighbours on an interval are far apart in a joint."""
    gap = np.abs(np.diff(q, axis=0)).max(axis=1, initial=0.0)
    extra = np.clip(np.ceil(gap / (2 * spacing)).astype(np.int64) - 1, 0, _MOST_BETWEEN)
    extra[interval[1:] != interval[:-1]] = 0
    left, number = repeated(extra)
    return left, psi[left] + (psi[left + 1] - psi[left]) * (number + 1) / (extra[left] + 1)
