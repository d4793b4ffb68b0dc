"""The path through layers of postures that is best with accelerations counted, in C or in NumPy.

Dynamic programming over pairs of postures from neighbouring layers: written out, the square of an
acceleration has one term for each pair of its three layers, so that one minimum over the first of three is
all there is to a step.
"""

from __future__ import annotations

import ctypes
import itertools

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.address import address
from armik_sym.compiled.build import Library
from armik_sym.trajectory.one_curve.smoothness import Smoothness

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# More postures in a layer than the tables can count.
MOST_IN_A_LAYER = 255


def smoothest_path(
    q: Array, cost: Array, first: Indices, most: Array, smooth: Smoothness, library: Library | None
) -> tuple[Indices, float]:
    """One posture of every layer, so that the whole is least.

    Σ_l cost + ½|speed_l (q_{l+1} - q_l)|² + ½|bend_l0 q_l + bend_l1 q_{l+1} + bend_l2 q_{l+2}|², not scaled.

    Args:
        q: Postures, layer after layer, shape (m, dof), in [rad].
        cost: Cost of every posture, shape (m,).
        first: Where each layer begins, and m, shape (layers + 1,); at least one and at most
            `MOST_IN_A_LAYER` in each, two layers at least.
        most: How far a joint may move in a step, shape (layers - 1, dof), in [rad].
        smooth: The weights, scaled; postures are not drawn to its aim.
        library: The compiled loops; None for NumPy.

    Returns:
        Index of one posture per layer, shape (layers,), and the cost; infinite if there is no path.

    Source:
        Bellman (1957), Dynamic programming.
    """
    unscaled = 1.0 / np.sqrt(smooth.scale)
    speed, bend = unscaled * smooth.speed, unscaled * smooth.bend
    if library is None:
        return _numpy(q, cost, first, most, speed, bend)
    sizes = np.diff(first)
    largest = int(sizes.max())
    way = np.empty(len(sizes), dtype=np.int64)
    before = np.empty(max(1, int((sizes[1:] * sizes[:-1]).sum())), dtype=np.uint8)
    work = np.empty(3 * largest**2 + 2 * largest)
    places = np.ascontiguousarray(first, dtype=np.intp)
    arrays = [np.ascontiguousarray(part, dtype=np.float64) for part in (q, cost, most, speed, bend)]
    function = library.handle.armik_smoothest_path
    function.restype = ctypes.c_double
    value = function(
        ctypes.c_ssize_t(len(sizes)),
        address(places),
        ctypes.c_ssize_t(q.shape[1]),
        *(address(array) for array in arrays),
        address(before),
        address(way),
        address(work),
    )
    return way, float(value)


def _numpy(
    q: Array, cost: Array, first: Indices, most: Array, speed: Array, bend: Array
) -> tuple[Indices, float]:
    bounds = [slice(a, b) for a, b in itertools.pairwise(first)]
    layers, costs = [q[part] for part in bounds], [cost[part] for part in bounds]
    total = costs[0][:, None] + _pairs(layers[0], layers[1], speed[0], most[0]) + costs[1]
    before: list[Indices] = []
    for k, b in enumerate(bend):
        total, least = _further(total, layers[k : k + 3], b)
        total += _pairs(layers[k + 1], layers[k + 2], speed[k + 1], most[k + 1]) + costs[k + 2]
        before.append(least)
    i, j = np.unravel_index(int(total.argmin()), total.shape)
    way = [int(j), int(i)]
    for table in before[::-1]:
        way.append(int(table[way[-1], way[-2]]))
    return np.asarray(first[:-1] + np.array(way[::-1]), dtype=np.int64), float(total[i, j])


def _pairs(a: Array, b: Array, speed: float, most: Array) -> Array:
    """Cost of the steps from every posture of a layer to every one of the next."""
    step = b[None] - a[:, None]
    far = (np.abs(step) > most).any(axis=2)
    return np.where(far, np.inf, 0.5 * speed**2 * np.square(step).sum(axis=2))


def _further(total: Array, layers: list[Array], bend: Array) -> tuple[Array, Indices]:
    """From costs of pairs (a, b) to those of pairs (b, c), the acceleration between included, and which a."""
    qa, qb, qc = layers
    a, b, c = (0.5 * w**2 * np.square(x).sum(axis=1) for w, x in zip(bend, layers, strict=True))
    arrived = total + (b + bend[0] * bend[1] * (qa @ qb.T))
    corner = a[:, None] + bend[0] * bend[2] * (qa @ qc.T)
    ways = arrived[:, :, None] + corner[:, None, :]
    return ways.min(axis=0) + c + bend[1] * bend[2] * (qb @ qc.T), ways.argmin(axis=0)
