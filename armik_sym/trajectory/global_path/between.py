"""Where a way runs between its knots when it changes the branch there, or leaves the intervals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.equivalent_angles import largest_difference
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.limit_cuts import joint_coefficients, zeros
from armik_sym.swivel.postures_at import postures_at
from armik_sym.trajectory.global_path.search import Way

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_AROUND = 0.4
_TRIED = 33
_OUTSIDE = 100.0
_GAIN = 1e-3


def with_samples(
    way: Way, further: Indices, time: Array, intervals: FeasibleIntervals, reference: Array, backend: Backend
) -> tuple[Way, Array]:
    """A way with further samples: there, the posture nearest to the straight line from knot to knot.

    Tried are swivel angles around that of the straight line, and those at which the first angle of shoulder
    or wrist is as on the line: beside a pole they are the ones that count.

    Args:
        way: The way.
        further: Samples that are not its knots, increasing, shape (k,).
        time: Time stamps of the path, shape (n,), in [s].
        intervals: The feasible intervals.
        reference: Reference directions of the swivel angles, shape (n, 3).
        backend: "auto", "c" or "vm".

    Returns:
        The way with these knots added, and how far each is from the line, shape (k,), in [rad].

    Source:
        None (this package).
    """
    line = way.straight(time, further)
    before = np.searchsorted(way.sample, further) - 1
    branch, psi, away = _nearest(
        further, way.branch[before], way.branch[before + 1], line, intervals, reference, backend
    )
    merged = np.argsort(np.concatenate([way.sample, further]), kind="stable")

    both = Way(
        np.concatenate([way.sample, further])[merged],
        np.concatenate([way.branch, branch])[merged],
        np.unwrap(np.concatenate([way.psi, psi])[merged]),
        np.concatenate([way.q, line])[merged],
        way.cost,
    )
    return both, away


@dataclass(frozen=True, eq=False)
class Reassigned:
    """Branches after samples beside poles were looked at again.

    Attributes:
        branch: Branch of every sample, shape (m,).
        psi: Swivel angle of the samples looked at, shape (m,), in [rad].
        q: Posture the others ask them to be near to, shape (m, dof), in [rad].
    """

    branch: Indices
    psi: Array
    q: Array


def reassigned(
    sample: Indices,
    q: Array,
    branch: Indices,
    looked_at: Indices,
    time: Array,
    intervals: FeasibleIntervals,
    reference: Array,
    backend: Backend,
) -> Reassigned:
    """Where the branch changes and beside poles, the branch that comes nearest to what the neighbours ask.

    The two branches of a sample share out the directions in which a motion can pass its pole; when the
    direction turns, a sample can find itself on the wrong one.

    Args:
        sample: Samples of the motion, increasing, shape (m,).
        q: Joint angles there, shape (m, dof), in [rad].
        branch: Branches there, shape (m,).
        looked_at: Rows to look at besides those where the branch changes, shape (k,).
        time: Time stamps of the path, shape (n,), in [s].
        intervals: The feasible intervals.
        reference: Reference directions, shape (n, 3).
        backend: "auto", "c" or "vm".

    Returns:
        The branches.

    Source:
        None (this package).
    """
    found = Reassigned(branch.copy(), np.zeros(len(branch)), q.copy())
    change = np.flatnonzero(np.diff(branch))
    rows = np.unique(np.concatenate([looked_at, change, change + 1]))
    inner = rows[(rows > 0) & (rows < len(q) - 1)]
    if not inner.size:
        return found
    before, here, after = (time[sample[inner + i]] for i in (-1, 0, 1))
    share = ((here - before) / (after - before))[:, None]
    line = q[inner - 1] + share * (q[inner + 1] - q[inner - 1])
    now = np.abs(q[inner] - line).max(axis=1)
    worth = now > _GAIN
    if not worth.any():
        return found
    inner, line, now = inner[worth], line[worth], now[worth]
    own = branch[inner]
    other = np.where(own != branch[inner + 1], branch[inner + 1], branch[inner - 1])
    same = np.flatnonzero(other == own)
    other[same] = _across(intervals, own[same], sample[inner[same]])
    best, psi, away = _nearest(sample[inner], own, other, line, intervals, reference, backend)
    better = (best != own) & (away < now - _GAIN)
    found.branch[inner[better]] = best[better]
    found.psi[inner], found.q[inner] = psi, line
    return found


def nearest_on_branch(
    sample: int, branch: int, line: Array, intervals: FeasibleIntervals, reference: Array, backend: Backend
) -> tuple[float, float]:
    """Where one sample comes nearest to a posture on a given branch.

    Args:
        sample: The sample.
        branch: The branch.
        line: The posture, shape (dof,), in [rad].
        intervals: The feasible intervals.
        reference: Reference directions, shape (n, 3).
        backend: "auto", "c" or "vm".

    Returns:
        Swivel angle, and how far it is from the posture; much farther if it is outside the range of motion.

    Source:
        None (this package).
    """
    samples, branches = np.array([sample]), np.array([branch])
    _, psi, away = _nearest(samples, branches, branches, line[None], intervals, reference, backend)
    return float(psi[0]), float(away[0])


def _across(intervals: FeasibleIntervals, branch: Indices, samples: Indices) -> Indices:
    """The branch on the other side of the nearest pole of each sample: shoulder or wrist turned over."""
    signs = intervals.branches[branch]
    sines = np.empty((len(samples), 2))
    for curve, side in zip(intervals.curves, (1, -1), strict=True):
        rows = np.flatnonzero(signs[:, 0] == side)
        q33 = curve.parts[samples[rows]][:, :, :, 8]
        highest = np.abs(q33[:, :, 0]) + np.hypot(q33[:, :, 1], q33[:, :, 2])
        sines[rows] = 1.0 - highest
    shoulder = sines[:, 0] <= sines[:, 1]
    turned = signs * np.column_stack(
        [np.ones(len(samples)), np.where(shoulder, -1, 1), np.where(shoulder, 1, -1)]
    )
    return intervals.branch_of(turned)


def _nearest(
    further: Indices,
    before: Indices,
    after: Indices,
    line: Array,
    intervals: FeasibleIntervals,
    reference: Array,
    backend: Backend,
) -> tuple[Indices, Array, Array]:
    """Branch (one of two), swivel angle and distance of the posture nearest to a line, for each sample."""
    sample, branch, psi = _tried(further, before, after, line, intervals, reference)
    rom = intervals.curves[0].spherical.arm.rom
    q = postures_at(intervals.curves, sample, branch, psi, backend=backend).q
    row = np.searchsorted(further, sample)
    away = largest_difference(q, line[row], rom.width)
    away += _OUTSIDE * np.maximum(-rom.margin(q).min(axis=1) - 1e-9, 0.0)
    order = np.lexsort((away, row))
    _, first = np.unique(row[order], return_index=True)
    best = order[first]
    return branch[best], psi[best], away[best]


def _tried(
    further: Indices,
    before: Indices,
    after: Indices,
    line: Array,
    intervals: FeasibleIntervals,
    reference: Array,
) -> tuple[Indices, Indices, Array]:
    """Samples, branches and swivel angles worth trying."""
    spherical = intervals.curves[0].spherical
    at = swivel_of_postures(spherical, line, reference[further])
    steps = np.linspace(-_AROUND, _AROUND, _TRIED)
    samples, branches, angles = [], [], []
    for branch in (before, after):
        exact = _of_first_angles(further, branch, line, intervals)
        # Across the straight arm the elbow is on the other side of the line to the wrist.
        half = np.where(intervals.branches[branch, 0] == at.elbow, 0.0, np.pi)
        around = (at.psi + half)[:, None] + steps
        psi = np.hstack([around, np.where(np.isnan(exact), around[:, :1], exact)])
        samples.append(np.repeat(further, psi.shape[1]))
        branches.append(np.repeat(branch, psi.shape[1]))
        angles.append(psi.ravel())
    return np.concatenate(samples), np.concatenate(branches), np.concatenate(angles)


def _of_first_angles(further: Indices, branch: Indices, line: Array, intervals: FeasibleIntervals) -> Array:
    """Swivel angles at which the first angle of shoulder or wrist is that of the line, shape (k, 4)."""
    found = np.full((len(further), 4), np.nan)
    for curve, side in zip(intervals.curves, (1, -1), strict=True):
        rows = np.flatnonzero(intervals.branches[branch, 0] == side)
        for i, triple in enumerate(curve.triples):
            C = curve.parts[further[rows], i]
            angle = line[rows, triple.first]
            found[rows, 2 * i : 2 * i + 2] = zeros(joint_coefficients(C, triple, 0, angle))
    return found
