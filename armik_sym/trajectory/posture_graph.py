"""A guess by shortest path: many postures for some samples, and the smoothest way through them.

Following a path sample by sample can run into a dead end that nothing later repairs. Here the choice
between elbow positions and between the sides of the shoulder is made for the whole path at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.trajectory.damped_least_squares import PoseSolver
from armik_sym.trajectory.guess import Guess

Array = NDArray[np.float64]

_LAYERS = 40
_RANDOM_STARTS = 10
_MOST_POSTURES = 48
_SAME_POSTURE = 0.1
_NEAR_ENOUGH = 1e-4
_MISS_COST = 1e4


def graph_guess(solver: PoseSolver, time: Array, rom: RangeOfMotion, first: Array | None, seed: int) -> Guess:
    """Joint trajectory along the shortest way through a layered graph of postures.

    Layers are up to 40 samples. A layer holds postures reached from random ones, from those of the
    layer before and, on the way back, from those of the layer after. An edge costs |Δq|²/Δt; the way
    of least cost is found by dynamic programming, interpolated, and the solver takes it from there.

    Args:
        solver: Finds postures for samples.
        time: Time stamps, shape (n,), in [s].
        rom: Range of motion.
        first: The posture at sample 0 if it is known, shape (dof,), in [rad].
        seed: Seed of the random postures.

    Returns:
        The guess.

    Source:
        Idea after Wang, Wang & Rakita, IKLink (2024): dynamic programming over sampled postures.
    """
    n = len(time)
    chosen = np.unique(np.linspace(0, n - 1, min(n, _LAYERS)).astype(np.int64))
    layers = _layers(solver, chosen, rom, first, np.random.default_rng(seed))
    way = _shortest_way(layers, time[chosen])
    filled = [np.interp(time, time[chosen], column) for column in way.T]
    errors = np.zeros(n)
    errors[chosen] = [layer.errors[0] for layer in layers]
    return Guess(np.array(filled).T, errors, "shortest way through a graph of postures")


class _Layer:
    """Distinct postures for one sample, with the error each leaves."""

    def __init__(self, solver: PoseSolver, sample: int) -> None:
        self._solver, self._sample = solver, sample
        self.postures: list[Array] = []
        self.errors: list[float] = []

    def add_from(self, starts: list[Array]) -> None:
        for start in starts:
            if len(self.postures) >= _MOST_POSTURES:
                return
            self.add(start)

    def add(self, start: Array) -> None:
        reached = self._solver.reach(self._sample, start, iterations=30)
        new = all(np.abs(reached.q - other).max() > _SAME_POSTURE for other in self.postures)
        if new and (reached.error < _NEAR_ENOUGH or not self.postures):
            self.postures.append(reached.q)
            self.errors.append(reached.error)


def _layers(
    solver: PoseSolver,
    chosen: NDArray[np.int64],
    rom: RangeOfMotion,
    first: Array | None,
    rng: np.random.Generator,
) -> list[_Layer]:
    layers = [_Layer(solver, int(k)) for k in chosen]
    if first is not None:
        layers[0].add(first)
    for i, layer in enumerate(layers):
        if i:
            layer.add_from(layers[i - 1].postures)
        if i or first is None:
            layer.add_from(_random_postures(solver, rom, rng, _RANDOM_STARTS if i else 4 * _RANDOM_STARTS))
    for i in range(len(layers) - 2, 0 if first is not None else -1, -1):
        layers[i].add_from(layers[i + 1].postures)
    return layers


def _random_postures(
    solver: PoseSolver, rom: RangeOfMotion, rng: np.random.Generator, count: int
) -> list[Array]:
    """Random postures; joints that cannot move the hand stay in the middle, lest they cost way."""
    postures = rom.random_postures(rng, count)
    idle = solver.idle_joints(postures[0])
    postures[:, idle] = rom.middle[idle]
    return list(postures)


def _shortest_way(layers: list[_Layer], time: Array) -> Array:
    cost = _MISS_COST * np.square(layers[0].errors)
    back: list[NDArray[np.intp]] = []
    for i in range(1, len(layers)):
        before, after = np.array(layers[i - 1].postures), np.array(layers[i].postures)
        edges = np.square(after[:, None] - before[None]).sum(axis=2) / (time[i] - time[i - 1])
        total = edges + cost[None]
        back.append(np.argmin(total, axis=1))
        cost = total.min(axis=1) + _MISS_COST * np.square(layers[i].errors)
    index = int(np.argmin(cost))
    way = [layers[-1].postures[index]]
    for i in range(len(back) - 1, -1, -1):
        index = int(back[i][index])
        way.append(layers[i].postures[index])
    return np.array(way[::-1])
