"""Why a sample has no posture inside the range of motion: which joint blocks, and by how much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.errors import OptionError, ShapeError
from armik_sym.swivel.c_intervals import compiled_blocking
from armik_sym.swivel.closed_form import SwivelCurve
from armik_sym.swivel.constants import ROUNDS, TIE, TURN
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.joint_margins import elbow_margins, joint_margins
from armik_sym.swivel.library import swivel_library
from armik_sym.swivel.limit_cuts import limit_cuts

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_BLOCK = 1024
_SHOULDER_AND_WRIST = (0, 1, 2, 4, 5, 6)


@dataclass(frozen=True, eq=False)
class Blocking:
    """The posture that misses the range of motion least, for some samples.

    Attributes:
        sample: Indices of the samples, shape (k,).
        branch: Branch of that posture, index into `FeasibleIntervals.branches`, shape (k,).
        psi: Its swivel angle, shape (k,), in [rad].
        joint: The joint that misses its limit most, shape (k,); often two miss theirs by the same, then the
            first of shoulder, wrist and elbow.
        missing: By how much, shape (k,), in [rad]: if every joint had this much more, the sample would be
            feasible, and with less it would not; negative if it is feasible.
        shortfall: By how much the target is out of reach of the lengths, shape (k,), in [m].
    """

    sample: Indices
    branch: Indices
    psi: Array
    joint: Indices
    missing: Array
    shortfall: Array


def blocking(
    intervals: FeasibleIntervals,
    samples: ArrayLike | None = None,
    branch: int | None = None,
    backend: Backend = "auto",
) -> Blocking:
    """Which joint blocks samples, and how much of its range of motion is missing.

    The least angle by which all ranges of motion would have to be wider, to 1e-10 rad.

    Args:
        intervals: The feasible intervals.
        samples: Indices of samples; those without any interval (on this branch) if left out.
        branch: Only this branch; the best one if left out.
        backend: "auto", "c" or "vm".

    Returns:
        One row per sample.

    Raises:
        OptionError: If there is no such branch.
        ShapeError: If `samples` are no indices of samples.

    Source:
        None (this package).
    """
    branches = len(intervals.branches)
    if branch is not None and not 0 <= branch < branches:
        raise OptionError(f"branch is {branch}, expected 0 to {branches - 1}")
    if samples is None:
        empty = intervals.empty.all(axis=1) if branch is None else intervals.empty[:, branch]
        samples = np.flatnonzero(empty)
    chosen = np.asarray(samples, dtype=np.int64)
    n = len(intervals.empty)
    if chosen.ndim != 1 or np.any((chosen < 0) | (chosen >= n)):
        raise ShapeError(f"samples {chosen}: expected indices from 0 to {n - 1}, shape (k,)")
    library = swivel_library(backend)
    if library is not None:
        return Blocking(chosen, *compiled_blocking(library, intervals.curves, chosen, branch))
    return _in_numpy(intervals, chosen, branch)


def _in_numpy(intervals: FeasibleIntervals, chosen: Indices, branch: int | None) -> Blocking:
    pairs = 2 ** len(intervals.curves[0].triples)
    sides = range(2) if branch is None else (branch // pairs,)
    answers = []
    for first in range(0, len(chosen), _BLOCK):
        rows = chosen[first : first + _BLOCK]
        tried = [_side(intervals.curves[e].rows(rows), e * pairs, branch) for e in sides]
        better = tried[-1].missing < tried[0].missing
        answers.append(_pick(tried[0], tried[-1], better, rows))
    if not answers:
        nothing, none = np.zeros(0, dtype=np.int64), np.zeros(0)
        return Blocking(nothing, nothing, none, nothing, none, none)
    return Blocking(
        chosen,
        np.concatenate([answer.branch for answer in answers]),
        np.concatenate([answer.psi for answer in answers]),
        np.concatenate([answer.joint for answer in answers]),
        np.concatenate([answer.missing for answer in answers]),
        np.concatenate([answer.shortfall for answer in answers]),
    )


def _side(curve: SwivelCurve, offset: int, branch: int | None) -> Blocking:
    """The best swivel angle of one side of the elbow.

    With every range widened by some angle, the arcs between the cuts tell exactly whether there is a
    posture; the least such angle is found by bisection.
    """
    n = len(curve.elbow)
    wanted = None if branch is None else branch - offset
    least, most, best = np.full(n, -np.pi), np.full(n, np.inf), np.zeros(n)
    for k in range(ROUNDS):
        extra = np.where(most < np.inf, 0.5 * (least + most), 0.0) if k else np.zeros(n)
        psi = _middles(limit_cuts(curve, extra))
        margin = _margins(curve, psi, wanted)[0]
        at = margin.argmax(axis=1)
        missing = -np.take_along_axis(margin, at[:, None], axis=1)[:, 0]
        better = missing < most
        best = np.where(better, np.take_along_axis(psi, at[:, None], axis=1)[:, 0], best)
        most = np.minimum(most, missing)
        least = np.where(missing > extra, np.maximum(least, extra), least)
    margin, joint, pair = _margins(curve, best[:, None], wanted)
    best = best - TURN * np.floor((best + np.pi) / TURN)
    return Blocking(np.arange(n), pair[:, 0] + offset, best, joint[:, 0], -margin[:, 0], curve.shortfall)


def _middles(cuts: Array) -> Array:
    return 0.5 * (cuts + np.hstack([cuts[:, 1:], cuts[:, :1] + TURN]))


def _margins(curve: SwivelCurve, psi: Array, wanted: int | None) -> tuple[Array, Indices, Indices]:
    """Smallest margin of all joints, the joint that has it, and the branches chosen; shape (n, m) each."""
    margins = joint_margins(curve, psi)
    smallest = margins.min(axis=-1)
    groups = smallest.shape[2]
    if wanted is None:
        side = smallest.argmax(axis=-1)
    else:
        side = np.broadcast_to([wanted // 2, wanted % 2] if groups == 2 else [wanted], smallest.shape[:3])
    taken = np.take_along_axis(margins, side[..., None, None], axis=3)[..., 0, :]
    elbow = np.broadcast_to(elbow_margins(curve)[:, None, None], (*psi.shape, 1))
    every = np.concatenate([taken.reshape(*psi.shape, -1), elbow], axis=-1)
    names = np.array([*_SHOULDER_AND_WRIST[: 3 * groups], 3])
    pair = 2 * side[..., 0] + side[..., 1] if groups == 2 else side[..., 0]
    least = every.min(axis=-1)
    return least, names[(every <= least[..., None] + TIE).argmax(axis=-1)], pair


def _pick(one: Blocking, other: Blocking, better: NDArray[np.bool_], rows: Indices) -> Blocking:
    return Blocking(
        rows,
        np.where(better, other.branch, one.branch),
        np.where(better, other.psi, one.psi),
        np.where(better, other.joint, one.joint),
        np.where(better, other.missing, one.missing),
        np.where(better, other.shortfall, one.shortfall),
    )
