"""Postures around a way at each of its knots: on its own branch, and across poles and the straight arm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import TURN
from armik_sym.swivel.limit_cuts import joint_coefficients, zeros
from armik_sym.swivel.postures_at import postures_at
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Sine of the angle between first and third axis, or bend of the elbow in [rad], below which a way may cross.
_NEAR = 0.3
# Postures farther than this from the way are left out, in [rad] …
_FARTHEST = 0.7
# … and so are those beyond this many at a knot, the farthest first.
_MOST = 48
_OUTSIDE = 1e-9


@dataclass(frozen=True, eq=False)
class Neighbours:
    """Postures in layers, one layer per knot.

    Attributes:
        branch: Branch of each, shape (m,).
        psi: Swivel angle, shape (m,), in [rad].
        q: Posture, shape (m, dof), in [rad].
        first: Where each layer begins, and m, shape (layers + 1,).
    """

    branch: Indices
    psi: Array
    q: Array
    first: Indices


def neighbours(problem: SwivelProblem, way: Way, step: float, count: int) -> Neighbours:
    """The way itself and what is near to it, by multiples of one step so that whole stretches can shift.

    On its own branch and, where the arm is nearly straight, on that with the other side of the elbow, swivel
    angles ψ + i·step; beside a pole of shoulder or wrist, on both branches that meet there, the swivel angles
    at which its first angle is α + i·step.

    Args:
        problem: The problem.
        way: The way.
        step: The step, in [rad].
        count: i goes from -count to count.

    Returns:
        The postures, the way's own first in each layer.

    Source:
        None (this package).
    """
    steps = np.asarray(step * np.arange(-count, count + 1), dtype=np.float64)
    parts = [_beside(problem, way, steps)] + [_across_pole(problem, way, steps, i) for i in (0, 1)]
    layer, branch, psi = (np.concatenate([part[i] for part in parts]) for i in range(3))
    wish = way.q[layer]
    q = postures_at(problem.intervals.curves, way.sample[layer], branch, psi, wish, backend=problem.backend).q
    away = np.abs(q - wish).max(axis=1)
    kept = np.flatnonzero((away < _FARTHEST) & (problem.arm.rom.margin(q).min(axis=1) >= -_OUTSIDE))
    if problem.first is not None:
        kept = kept[layer[kept] > 0]
    return _in_layers(way, layer[kept], branch[kept], psi[kept], q[kept], away[kept])


def _beside(problem: SwivelProblem, way: Way, steps: Array) -> tuple[Indices, Indices, Array]:
    """Layer, branch and swivel angle of shifted postures, also with the elbow on its other side."""
    m, branches = len(way.sample), problem.intervals.branches
    bend = np.abs(problem.intervals.curves[0].elbow - problem.intervals.curves[1].elbow)[way.sample]
    gap = np.diff(way.sample, prepend=-np.inf, append=np.inf)
    # Between knots farther apart the elbow would change its side without any acceleration to show for it.
    close = np.maximum(gap[1:], gap[:-1]) == 1
    straight = np.flatnonzero(close & (np.abs(bend - TURN * np.rint(bend / TURN)) < 2 * _NEAR))
    layer = np.concatenate([np.arange(m), straight])
    other = problem.intervals.branch_of(branches[way.branch[straight]] * np.array([-1, 1, 1]))
    branch = np.concatenate([way.branch, other])
    # Bent to the other side, the elbow is on the other side of the line to the wrist.
    middle = way.psi[layer] + np.where(np.arange(len(layer)) < m, 0.0, np.pi)
    k = len(steps)
    return np.repeat(layer, k), np.repeat(branch, k), (middle[:, None] + steps).ravel()


def _across_pole(problem: SwivelProblem, way: Way, steps: Array, i: int) -> tuple[Indices, Indices, Array]:
    """The same beside poles of shoulder (0) or wrist (1), on the branches on both sides."""
    intervals = problem.intervals
    triple = intervals.curves[0].triples[i]
    offset = _offset(problem, i)
    near = np.flatnonzero(np.abs(np.sin(way.q[:, triple.first + 1] + offset)) < _NEAR)
    elbow = (intervals.branches[way.branch[near], 0] < 0).astype(np.int64)
    C = np.empty((len(near), 3, 9))
    for side, curve in enumerate(intervals.curves):
        C[elbow == side] = curve.parts[way.sample[near[elbow == side]], i]
    angle = (way.q[near, triple.first, None] + steps).ravel()
    C, k = np.repeat(C, len(steps), axis=0), np.repeat(np.arange(len(near)), len(steps))
    roots = zeros(joint_coefficients(C, triple, 0, angle))
    turn = np.ones(3, dtype=np.int64)
    turn[1 + i] = -1
    own = way.branch[near]
    over = intervals.branch_of(intervals.branches[own] * turn)
    layer = np.tile(near[k], 4)
    branch = np.concatenate([own[k], own[k], over[k], over[k]])
    psi = np.tile(roots.T.ravel(), 2)
    good = ~np.isnan(psi)
    return layer[good], branch[good], psi[good]


def _offset(problem: SwivelProblem, i: int) -> float:
    spherical = problem.intervals.curves[0].spherical
    if i == 0:
        return float(spherical.shoulder.offset)
    return float(spherical.wrist.offset) if spherical.wrist else 0.0


def _in_layers(way: Way, layer: Indices, branch: Indices, psi: Array, q: Array, away: Array) -> Neighbours:
    """Sorted by layer, the way's own posture first, then the nearest, no more than fit."""
    m = len(way.sample)
    layer = np.concatenate([np.arange(m), layer])
    order = np.lexsort((np.concatenate([np.full(m, -1.0), away]), layer))
    first = np.searchsorted(layer[order], np.arange(m + 1))
    place = np.arange(len(order)) - first[layer[order]]
    order = order[place < _MOST]
    return Neighbours(
        np.concatenate([way.branch, branch])[order],
        np.concatenate([way.psi, psi])[order],
        np.vstack([way.q, q])[order],
        np.searchsorted(layer[order], np.arange(m + 1)),
    )
