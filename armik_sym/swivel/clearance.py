"""How far postures on a swivel map are from the nearest limit, and which limit ends each interval."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.swivel.closed_form import SwivelCurve
from armik_sym.swivel.constants import REACH
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.postures_at import postures_at

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_BLOCK = 65_536
# How far outside an interval to look for the joint that ends it, in [rad].
_OUTSIDE = 1e-6


@dataclass(frozen=True, eq=False)
class Clearance:
    """Distance to the nearest limit.

    Attributes:
        margin: Smallest margin of all joints, shape (m, p), in [rad]; negative outside the range of motion,
            -inf where the target is out of reach.
        joint: The joint that has it, shape (m, p).
    """

    margin: Array
    joint: Indices


@dataclass(frozen=True, eq=False)
class IntervalEnds:
    """Which limit ends each interval.

    Attributes:
        joint: The joint that blocks beyond start and end, shape (k, 2); -1 where nothing does (the whole
            circle).
        upper: Whether it is its upper limit, shape (k, 2).
    """

    joint: Indices
    upper: NDArray[np.bool_]


def clearance(
    intervals: FeasibleIntervals,
    psi: ArrayLike,
    branch: int,
    samples: ArrayLike,
    backend: Backend = "auto",
) -> Clearance:
    """Smallest margin of all joints over samples and swivel angles: min_j min(q_j - lower_j, upper_j - q_j).

    Args:
        intervals: The feasible intervals, with their curves.
        psi: Swivel angles, shape (p,), in [rad].
        branch: Index into `intervals.branches`.
        samples: Indices of samples, shape (m,).
        backend: "auto", "c" or "vm".

    Returns:
        Margins and joints.

    Source:
        Definition of the margin (`RangeOfMotion.margin`).
    """
    angles, rows = np.asarray(psi, dtype=np.float64), np.asarray(samples, dtype=np.int64)
    rom, curve = intervals.curves[0].spherical.arm.rom, _curve_of(intervals, branch)
    margin = np.full((len(rows), len(angles)), -np.inf)
    joint = np.zeros(margin.shape, dtype=np.int64)
    step = max(1, _BLOCK // max(1, len(angles)))
    for first in range(0, len(rows), step):
        part = rows[first : first + step]
        every = np.repeat(part, len(angles))
        q = postures_at(intervals.curves, every, branch, np.tile(angles, len(part)), backend=backend).q
        margins = rom.margin(q).reshape(len(part), len(angles), rom.dof)
        margin[first : first + step] = margins.min(axis=2)
        joint[first : first + step] = margins.argmin(axis=2)
    margin[curve.shortfall[rows] > REACH] = -np.inf
    return Clearance(margin, joint)


def interval_ends(
    intervals: FeasibleIntervals, rows: ArrayLike | None = None, backend: Backend = "auto"
) -> IntervalEnds:
    """The joint limits that are met beyond the ends of intervals.

    Args:
        intervals: The feasible intervals.
        rows: Indices of intervals; all if left out.
        backend: "auto", "c" or "vm".

    Returns:
        Joints and limits; two columns, start and end.

    Source:
        None (this package).
    """
    chosen = np.arange(len(intervals.start)) if rows is None else np.asarray(rows, dtype=np.int64)
    start, end = intervals.start[chosen], intervals.end[chosen]
    sample, branch = intervals.sample[chosen], intervals.branch[chosen]
    rom = intervals.curves[0].spherical.arm.rom
    joint = np.empty((len(chosen), 2), dtype=np.int64)
    upper = np.empty((len(chosen), 2), dtype=np.bool_)
    # The elbow, and joints whose angles were given, do not depend on the swivel angle.
    moves = np.zeros(rom.dof, dtype=np.bool_)
    for triple in intervals.curves[0].triples:
        moves[triple.first : triple.first + 3] = True
    for side, beyond in enumerate((start - _OUTSIDE, end + _OUTSIDE)):
        q = postures_at(intervals.curves, sample, branch, beyond, backend=backend).q
        gaps = np.where(moves, np.stack([q - rom.lower, rom.upper - q], axis=1), np.inf)
        joint[:, side] = gaps.min(axis=1).argmin(axis=1)
        least = gaps.argmin(axis=1)
        upper[:, side] = np.take_along_axis(least, joint[:, side : side + 1], axis=1)[:, 0] == 1
    joint[(start == -np.pi) & (end == np.pi)] = -1
    return IntervalEnds(joint, upper)


def _curve_of(intervals: FeasibleIntervals, branch: int) -> SwivelCurve:
    return intervals.curves[0 if intervals.branches[branch, 0] == 1 else 1]
