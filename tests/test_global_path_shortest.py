"""The two dynamic programmes of the global search against all paths, tried one by one."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import pytest
from curve_problems import BACKENDS, bare, library

from armik_sym.trajectory.global_path.joined import cheapest_pieces
from armik_sym.trajectory.global_path.shortest_path import Edges, Reached, shortest_path
from armik_sym.trajectory.global_path.smoothest_path import smoothest_path

TURN = 2 * np.pi


def layers_of(rng: np.random.Generator, most: int = 4) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(rng.integers(1, most + 1, rng.integers(2, 6)))])


def all_paths(first: np.ndarray) -> Iterator[np.ndarray]:
    for path in itertools.product(*(range(a, b) for a, b in itertools.pairwise(first))):
        yield np.array(path)


def random_edges(rng: np.random.Generator, layers: int, turns: bool) -> Edges:
    return Edges(
        weight=rng.uniform(0.5, 3.0, layers - 1),
        most=rng.uniform(1.0, 4.0, (layers - 1, 7)),
        turns=rng.random(7) < 0.4 if turns else np.zeros(7, dtype=np.bool_),
        change=rng.uniform(0.0, 3.0, (layers - 1, 2, 2)),
    )


def cost_of(path: np.ndarray, q: np.ndarray, cost: np.ndarray, side: np.ndarray, edges: Edges) -> float:
    total = cost[path].sum()
    for step, (a, b) in enumerate(itertools.pairwise(path)):
        away = q[b] - q[a]
        away = np.where(edges.turns, np.mod(away + np.pi, TURN) - np.pi, away)
        if (np.abs(away) > edges.most[step]).any():
            return np.inf
        total += 0.5 * edges.weight[step] * (away @ away) + edges.change[step, side[a], side[b]]
    return float(total)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("seed", range(12))
def test_shortest_path_is_the_least_of_all_paths(backend: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    first = layers_of(rng)
    m, layers = int(first[-1]), len(first) - 1
    q, cost, side = rng.uniform(-3, 3, (m, 7)) * 0.6, rng.random(m), rng.integers(0, 2, m)
    edges = random_edges(rng, layers, turns=seed % 2 == 0)
    found = shortest_path(q, cost, side, first, edges, library(backend))
    least = np.full(m, np.inf)
    for length in range(1, layers + 1):
        for path in all_paths(first[: length + 1]):
            least[path[-1]] = min(least[path[-1]], cost_of(path, q, cost, side, edges))
    np.testing.assert_allclose(found.total, least, rtol=1e-12)
    for node in np.flatnonzero(np.isfinite(least)):
        way = found.way_to(int(node))
        assert cost_of(way, q, cost, side, edges) == pytest.approx(least[node])
    assert (found.previous[~np.isfinite(least)] == -1).all()


@pytest.mark.parametrize("backend", BACKENDS)
def test_there_and_back_cost_the_same(backend: str) -> None:
    rng = np.random.default_rng(5)
    first = np.array([0, 3, 7, 9, 13])
    q, cost, side = rng.normal(size=(13, 7)), rng.random(13), rng.integers(0, 2, 13)
    edges = random_edges(rng, 4, turns=True)
    there = shortest_path(q, cost, side, first, edges, library(backend))
    back = shortest_path(
        np.ascontiguousarray(q[::-1]),
        cost[::-1],
        side[::-1],
        13 - first[::-1],
        edges.reversed(),
        library(backend),
    )
    assert np.isfinite(there.total[9:].min())
    assert there.total[9:].min() == pytest.approx(back.total[10:].min())


@pytest.mark.parametrize("backend", BACKENDS)
def test_an_empty_layer_lets_nothing_through(backend: str) -> None:
    first = np.array([0, 2, 2, 4])
    found = shortest_path(
        np.zeros((4, 7)),
        np.zeros(4),
        np.zeros(4, dtype=np.int64),
        first,
        random_edges(np.random.default_rng(0), 3, turns=False),
        library(backend),
    )
    assert isinstance(found, Reached)
    assert np.isinf(found.total[2:]).all()
    assert (found.total[:2] == 0).all()


def smooth_cost(q: np.ndarray, cost: np.ndarray, most: np.ndarray, seed: int, time: np.ndarray) -> float:
    """The cost of one path written out, without the formulas of the code."""
    step = np.diff(q, axis=0)
    if (np.abs(step) > most).any():
        return np.inf
    h = np.diff(time)
    total = cost.sum() + 0.5 * (1.0 * step**2 / h[:, None]).sum()
    speed = step / h[:, None]
    spacing = 0.5 * (h[1:] + h[:-1])
    return float(total + 0.5 * 0.01 * (np.diff(speed, axis=0) ** 2 / spacing[:, None]).sum())


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("seed", range(12))
def test_smoothest_path_is_the_least_of_all_paths(backend: str, seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    first = layers_of(rng)
    m, layers = int(first[-1]), len(first) - 1
    time = np.cumsum(rng.uniform(0.05, 0.2, layers))
    q, cost = 0.3 * rng.normal(size=(m, 7)), rng.random(m)
    most = rng.uniform(0.6, 1.5, (layers - 1, 7))
    way, value = smoothest_path(q, cost, first, most, bare(layers, 0, time), library(backend))
    costs = [(smooth_cost(q[path], cost[path], most, seed, time), path) for path in all_paths(first)]
    least, path = min(costs, key=lambda each: each[0])
    assert value == pytest.approx(least, rel=1e-9)
    if np.isfinite(least):
        np.testing.assert_array_equal(way, path)


def test_c_and_numpy_agree_on_large_layers() -> None:
    rng = np.random.default_rng(3)
    sizes = rng.integers(1, 60, 30)
    first = np.concatenate([[0], np.cumsum(sizes)])
    q = np.repeat(np.cumsum(0.05 * rng.normal(size=(30, 7)), axis=0), sizes, axis=0)
    q += 0.1 * rng.normal(size=q.shape)
    cost, most = rng.random(len(q)), np.full((29, 7), 0.5)
    ways = [smoothest_path(q, cost, first, most, bare(30, 1), library(b)) for b in BACKENDS]
    assert np.isfinite(ways[0][1])
    assert ways[0][1] == pytest.approx(ways[1][1], rel=1e-12)
    np.testing.assert_array_equal(ways[0][0], ways[1][0])


@pytest.mark.parametrize("seed", range(8))
def test_pieces_of_ways_are_the_cheapest_of_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    k, m = 3, 5
    cost, passing = rng.random((k, m)), rng.random((k, k, m)) * (1 - np.eye(k))[:, :, None]

    def of(pick: tuple[int, ...]) -> float:
        own = sum(cost[way, row] for row, way in enumerate(pick))
        return own + sum(passing[pick[row - 1], pick[row], row] for row in range(1, m))

    best = min(itertools.product(range(k), repeat=m), key=of)
    assert tuple(cheapest_pieces(cost, passing)) == best
