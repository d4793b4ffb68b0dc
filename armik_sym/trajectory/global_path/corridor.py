"""From a way through some samples to a swivel angle and its bounds at every sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.equivalent_angles import largest_difference
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.postures_at import postures_at
from armik_sym.trajectory.global_path.monotone_cubic import monotone_cubic
from armik_sym.trajectory.repeated import repeated

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# A posture farther from the one asked for than this counts as this far, in [rad].
_FAR = 1.0


@dataclass(frozen=True, eq=False)
class Corridor:
    """One feasible interval per sample, in a frame of angles that does not wrap.

    Attributes:
        psi: Swivel angles inside, shape (n,), in [rad].
        lower: Start of each interval, shape (n,), in [rad]; -inf for the whole circle.
        upper: End of each interval, shape (n,), in [rad].
        branch: Branch of each sample, shape (n,).
        missed: How far the swivel angle asked for was outside, shape (n,), in [rad]; infinite where the
            branch has no interval.
    """

    psi: Array
    lower: Array
    upper: Array
    branch: Indices
    missed: Array


def corridor(
    intervals: FeasibleIntervals,
    branch: Indices | int,
    psi: Array,
    near: Array,
    backend: Backend = "auto",
    samples: Indices | None = None,
) -> Corridor:
    """The interval of every sample that a motion passes: the one nearest in swivel angle and in posture.

    Args:
        intervals: The feasible intervals.
        branch: Branch at every sample, shape (n,) or a number.
        psi: Swivel angles asked for, without wrapping, shape (n,), in [rad].
        near: Postures asked for, shape (n, dof), in [rad].
        backend: "auto", "c" or "vm".
        samples: Samples that `branch`, `psi` and `near` are of, increasing, shape (n,); all if left out.

    Returns:
        The corridor.

    Source:
        None (this package).
    """
    n = len(psi)
    branches = np.broadcast_to(np.asarray(branch, dtype=np.int64), (n,))
    of, rows = _rows_of(intervals, np.arange(n) if samples is None else samples)
    same = intervals.branch[rows] == branches[of]
    of, chosen = of[same], rows[same]
    start, end = intervals.start[chosen], intervals.end[chosen]
    start, end = _around(start, end, psi[of])
    missed = np.maximum(np.maximum(start - psi[of], psi[of] - end), 0.0)
    away = missed.copy()
    several = np.flatnonzero(np.bincount(of, minlength=n)[of] > 1)
    if several.size:
        row, sample = of[several], intervals.sample[chosen[several]]
        at = np.clip(psi[row], start[several], end[several])
        q = postures_at(intervals.curves, sample, branches[row], at, backend=backend).q
        width = intervals.curves[0].spherical.arm.rom.width
        away[several] += np.minimum(largest_difference(q, near[row], width), _FAR)
    order = np.lexsort((away, of))
    row, first = np.unique(of[order], return_index=True)
    best = order[first]
    lower, upper, off = psi.copy(), psi.copy(), np.full(n, np.inf)
    lower[row], upper[row], off[row] = start[best], end[best], missed[best]
    return Corridor(np.clip(psi, lower, upper), lower, upper, branches, off)


def interpolated(time: Array, sample: Indices, psi: Array, branch: Indices) -> Array:
    """Swivel angles at all samples from those at some, without overshoot, branch by branch.

    Args:
        time: Time stamps, shape (n,), in [s].
        sample: Samples where they are known, shape (m,).
        psi: Known swivel angles, shape (m,), in [rad].
        branch: Branch at each known sample, shape (m,); each holds until the next one.

    Returns:
        Shape (n,), in [rad].

    Source:
        Fritsch and Carlson (1980), doi:10.1137/0717021 (monotone cubic interpolation).
    """
    everywhere = np.empty(len(time))
    edges = np.flatnonzero(np.diff(branch)) + 1
    for part in np.split(np.arange(len(sample)), edges):
        end = sample[part[-1] + 1] if part[-1] + 1 < len(sample) else len(time)
        samples = np.arange(sample[part[0]], end)
        if len(part) == 1:
            everywhere[samples] = psi[part[0]]
        else:
            inside = np.clip(time[samples], None, time[sample[part[-1]]])
            everywhere[samples] = monotone_cubic(time[sample[part]], psi[part], inside)
    return everywhere


def _rows_of(intervals: FeasibleIntervals, samples: Indices) -> tuple[Indices, Indices]:
    """All intervals of some samples, and the place of the sample each belongs to; no look at the others."""
    begin = np.searchsorted(intervals.sample, samples)
    count = np.searchsorted(intervals.sample, samples, side="right") - begin
    of, number = repeated(count)
    return of, begin[of] + number


def _around(start: Array, end: Array, psi: Array) -> tuple[Array, Array]:
    """Intervals a whole number of turns away, as near to an angle as possible."""
    turns = TURN * np.rint((psi - 0.5 * (start + end)) / TURN)
    whole = end - start >= TURN - 1e-12
    return np.where(whole, -np.inf, start + turns), np.where(whole, np.inf, end + turns)
