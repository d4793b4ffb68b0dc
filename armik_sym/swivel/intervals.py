"""The feasible swivel angles as intervals with exact ends, for every sample and branch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.swivel.c_intervals import compiled_intervals
from armik_sym.swivel.closed_form import SwivelCurve, pose_curve
from armik_sym.swivel.constants import REACH, ROUNDING, TURN
from armik_sym.swivel.joint_margins import elbow_margins, joint_margins
from armik_sym.swivel.library import swivel_library
from armik_sym.swivel.limit_cuts import limit_cuts
from armik_sym.swivel.spherical_arm import SphericalArm

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_BLOCK = 2048
_NONE = np.zeros(0)


@dataclass(frozen=True, eq=False)
class FeasibleIntervals:
    """Where every joint is inside its range of motion: start ≤ ψ ≤ end, ends included.

    One row per interval, sorted by sample, then branch, then start.

    Attributes:
        curves: The postures with elbow side 1 and with -1.
        branches: Elbow side, shoulder and wrist branch of each branch, ±1, shape (b, 3).
        sample: Sample each interval belongs to, shape (k,).
        branch: Index into `branches`, shape (k,).
        start: In [-π, π), shape (k,), in [rad].
        end: start ≤ end ≤ start + 2π, above π if the interval runs across ±π, shape (k,), in [rad]. The whole
            circle is -π to π. Joints that cannot move make intervals of length 0.
        empty: Whether a branch has no interval, shape (n, b).
    """

    curves: tuple[SwivelCurve, SwivelCurve]
    branches: Indices
    sample: Indices
    branch: Indices
    start: Array
    end: Array
    empty: NDArray[np.bool_]

    def branch_of(self, signs: Indices) -> Indices:
        """Which branches have given signs.

        Args:
            signs: Elbow side, shoulder and wrist branch, ±1, shape (m, 3).

        Returns:
            Indices into `branches`, shape (m,).

        Source:
            None (bookkeeping).
        """
        return np.asarray((signs[:, None] == self.branches).all(axis=2).argmax(axis=1), dtype=np.int64)

    def of(self, sample: int, branch: int) -> Array:
        """The intervals of one sample and branch.

        Args:
            sample: Index of the sample.
            branch: Index into `branches`.

        Returns:
            Starts and ends, shape (k, 2), in [rad].

        Source:
            None (bookkeeping).
        """
        rows = (self.sample == sample) & (self.branch == branch)
        return np.column_stack([self.start[rows], self.end[rows]])


def feasible_intervals(
    spherical: SphericalArm,
    position: ArrayLike,
    rotation: ArrayLike,
    reference: ArrayLike | None = None,
    backend: Backend = "auto",
) -> FeasibleIntervals:
    """All swivel angles that keep every joint inside the range of motion while the hand has given poses.

    Args:
        spherical: The arm.
        position: Positions of the hand, shape (n, 3), in [m].
        rotation: Rotations of the hand, shape (n, 3, 3).
        reference: As in `pose_curve`.
        backend: "auto", "c" or "vm".

    Returns:
        Intervals for all eight branches.

    Raises:
        OptionError: If the arm has no spherical wrist.
        ShapeError: If shapes do not fit.

    Source:
        Shimizu et al. (2008).
    """
    curves = tuple(pose_curve(spherical, position, rotation, side, reference, backend) for side in (1, -1))
    return intervals_of_curves((curves[0], curves[1]), backend)


def intervals_of_curves(
    curves: tuple[SwivelCurve, SwivelCurve], backend: Backend = "auto"
) -> FeasibleIntervals:
    """The same from curves, of poses or of positions.

    Between neighbouring cuts every joint stays on one side of its limits: the middle decides for the whole
    arc.

    Args:
        curves: The postures with elbow side 1 and with -1.
        backend: "auto", "c" or "vm".

    Returns:
        Intervals for all eight branches, or the four that positions have.

    Source:
        Shimizu et al. (2008).
    """
    library = swivel_library(backend)
    found = _in_numpy(curves) if library is None else compiled_intervals(library, curves)
    wrists = (1, -1) if len(curves[0].triples) == 2 else (1,)
    signs = [(e, s, w) for e in (1, -1) for s in (1, -1) for w in wrists]
    return FeasibleIntervals(curves, np.array(signs, dtype=np.int64), *found)


def _in_numpy(
    curves: tuple[SwivelCurve, SwivelCurve],
) -> tuple[Indices, Indices, Array, Array, NDArray[np.bool_]]:
    """Sample, branch, start and end of every interval, sorted; whether a branch has none."""
    n, pairs = len(curves[0].elbow), 2 ** len(curves[0].triples)
    found: list[tuple[Indices, Indices, Array, Array]] = []
    for e, curve in enumerate(curves):
        possible = np.flatnonzero((curve.shortfall <= REACH) & (elbow_margins(curve) >= -ROUNDING))
        for first in range(0, len(possible), _BLOCK):
            rows = possible[first : first + _BLOCK]
            sample, pair, start, end = _arcs(curve.rows(rows))
            found.append((rows[sample], pair + e * pairs, start, end))
    sample, branch = (np.concatenate([part[i] for part in found] or [_NONE]).astype(np.int64) for i in (0, 1))
    start, end = (np.concatenate([part[i] for part in found] or [_NONE]) for i in (2, 3))
    order = np.lexsort((start, branch, sample))
    empty = np.ones((n, 2 * pairs), dtype=np.bool_)
    empty[sample, branch] = False
    return sample[order], branch[order], start[order], end[order], empty


def _arcs(curve: SwivelCurve) -> tuple[Indices, Indices, Array, Array]:
    """Sample, pair of branches, start and end of every run of feasible arcs."""
    cuts = limit_cuts(curve)
    following = np.hstack([cuts[:, 1:], cuts[:, :1] + TURN])
    inside = joint_margins(curve, 0.5 * (cuts + following)).min(axis=-1) >= -ROUNDING
    if len(curve.triples) == 2:
        feasible = inside[:, :, 0, :, None] & inside[:, :, 1, None, :]
        feasible = feasible.reshape(*cuts.shape, 4)
    else:
        feasible = inside[:, :, 0]
    feasible = np.swapaxes(feasible, 1, 2)
    end = _ends(feasible, following)
    everywhere = feasible.all(axis=-1)
    starts = feasible & ~np.roll(feasible, 1, axis=-1)
    starts[everywhere, 0] = True
    sample, pair, k = np.nonzero(starts)
    start, end = cuts[sample, k], end[sample, pair, k]
    whole = everywhere[sample, pair]
    return sample, pair, np.where(whole, -np.pi, start), np.where(whole, np.pi, end)


def _ends(feasible: NDArray[np.bool_], following: Array) -> Array:
    """For every arc the end of the run of feasible arcs it is in, going around once."""
    m = feasible.shape[-1]
    end = np.broadcast_to(following[:, None], feasible.shape).copy()
    for k in range(2 * m - 2, -1, -1):
        now, after, turns = k % m, (k + 1) % m, TURN if k % m == m - 1 else 0.0
        end[..., now] = np.where(feasible[..., after], end[..., after] + turns, following[:, None, now])
    return end
