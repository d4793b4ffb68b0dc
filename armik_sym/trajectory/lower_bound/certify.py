"""The certified lower bound of the objective of a whole trajectory."""

from __future__ import annotations

import time as clock

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import OptionError, ShapeError
from armik_sym.solution.lower_bound import LowerBound
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.equivalent_angles import without_turns
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.lower_bound.linearised import objective_of
from armik_sym.trajectory.lower_bound.problem import Problem, beside_chain
from armik_sym.trajectory.lower_bound.search import search

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Taken off the bound for rounding, relative to the objective.
_ROUNDING = 1e-9
# The elbow's angle of a trajectory is that of its pose up to this, in [rad].
_ON_CURVE = 1e-6


def lower_bound(
    intervals: FeasibleIntervals,
    time: ArrayLike,
    q: ArrayLike,
    *,
    speed_weight: float = 1.0,
    acceleration_weight: float = 0.01,
    posture_weight: float = 1e-3,
    preferred: ArrayLike | None = None,
    other_cost: float = 0.0,
    known_first: bool = False,
    gap: float = 0.01,
    most_pairs: int = 20_000_000,
) -> LowerBound:
    """A number that no feasible trajectory's objective is below, as near to that of a given one as asked for.

    The objective is ½ ∫ speed_weight·|q̇|² + acceleration_weight·|q̈|² + posture_weight·|q - preferred|² dt
    in the differences of `smoothness_matrix`; the derivation is in the docstring of this subpackage. Feasible
    is every trajectory with q_k on any branch and at any ψ of the feasible intervals of sample k. Rate limits
    and other terms that are never negative (clearance, a shifted preference) only make trajectories fewer or
    dearer, so that the bound holds with them, but does not see them. It holds for poses, not for paths of
    positions only.

    Args:
        intervals: Feasible intervals of the path, with eight branches.
        time: Time stamps, shape (n,), in [s].
        q: The trajectory in hand, shape (n, dof), in [rad]; the nearer to the optimum, the nearer the bound.
        speed_weight: Weight of squared speed.
        acceleration_weight: Weight of squared acceleration, in [s²].
        posture_weight: Weight of the squared distance from `preferred`, in [1/s²].
        preferred: Posture of the posture term, shape (dof,), in [rad]; mid-range if left out.
        other_cost: What other terms that are never negative add for `q`; it is in `objective`, and so in
            the gap.
        known_first: Whether only trajectories that begin with q[0] count.
        gap: Relative gap at which the search stops. A smaller one needs more knots, and more time.
        most_pairs: Work allowed, in pairs of cells; some million per second.

    Returns:
        The bound; it is valid even where the work allowed did not suffice for the gap.

    Raises:
        ShapeError: If shapes do not fit.
        OptionError: If the intervals are those of positions, or a number makes no sense.

    Source:
        None (this package).
    """
    began = clock.perf_counter()
    t, angles = np.asarray(time, dtype=np.float64), np.asarray(q, dtype=np.float64)
    rom = intervals.curves[0].spherical.arm.rom
    _check(intervals, t, angles)
    _check_numbers(
        {"gap": gap, "most_pairs": most_pairs},
        {
            "speed_weight": speed_weight,
            "acceleration_weight": acceleration_weight,
            "posture_weight": posture_weight,
            "other_cost": other_cost,
        },
    )
    rest = rom.middle if preferred is None else np.asarray(preferred, dtype=np.float64)
    if rest.shape != (rom.dof,):
        raise ShapeError(f"preferred {rest.shape}: expected ({rom.dof},)")
    objective = objective_of(t, speed_weight, acceleration_weight, posture_weight, rest)
    value, gradient = objective.value(angles), objective.gradient(angles)
    joints, shift = _searched(intervals, angles, gradient)
    gradient[:, np.setdiff1d(np.arange(rom.dof), joints)] = 0.0
    box = np.tile(rom.lower, (len(t), 1)), np.tile(rom.upper, (len(t), 1))
    if known_first:
        box[0][0] = box[1][0] = angles[0]
    bound, cells, suspect = 0.0, 0, None
    if value > 0:
        problem = Problem(intervals, t, objective, angles, gradient, joints, box, known_first)
        end = search(problem, value, gap, most_pairs)
        bound, cells = end.bound, end.looked_at
        if not end.done:
            suspect = rom.clip(angles + beside_chain(problem, end.start.knots, end.chain))
    lowest = max(value + bound + min(shift, 0.0) - _ROUNDING * value, 0.0)
    return LowerBound(lowest, value + other_cost, cells, clock.perf_counter() - began, suspect, known_first)


def _searched(intervals: FeasibleIntervals, q: Array, gradient: Array) -> tuple[Indices, float]:
    """Joints that are searched: not the elbow if the poses leave it no choice; and what it may add.

    Joints do not meet in the objective. If only one side of the elbow is feasible, its angles are known, and
    by convexity their cost is at least that of q plus gradient·difference.
    """
    rom = intervals.curves[0].spherical.arm.rom
    joints = np.arange(rom.dof)
    sides = np.unique(intervals.branches[intervals.branch, 0])
    covered = len(np.unique(intervals.sample)) == len(q)
    if len(sides) != 1 or not covered or rom.width[3] >= TURN:
        return joints, 0.0
    elbow = intervals.curves[0 if sides[0] == 1 else 1].elbow
    away = without_turns(elbow - q[:, 3])
    if np.abs(away).max() > _ON_CURVE:
        return joints, 0.0
    return np.delete(joints, 3), float(away @ gradient[:, 3])


def _check(intervals: FeasibleIntervals, time: Array, q: Array) -> None:
    curve = intervals.curves[0]
    n, dof = len(curve.elbow), curve.spherical.arm.dof
    if len(curve.triples) != 2:
        raise OptionError("the intervals are those of positions: a lower bound needs poses")
    if n < 2 or time.shape != (n,) or q.shape != (n, dof):
        raise ShapeError(
            f"time {time.shape} and q {q.shape}: expected ({n},) and ({n}, {dof}), with two samples or more"
        )
    if not (np.isfinite(q).all() and np.isfinite(time).all() and np.all(np.diff(time) > 0)):
        raise OptionError("time and q must be finite and time must increase")


def _check_numbers(positive: dict[str, float], not_negative: dict[str, float]) -> None:
    for name, number in positive.items():
        if not (np.isfinite(number) and number > 0):
            raise OptionError(f"{name} is {number!r}, expected a finite number > 0")
    for name, number in not_negative.items():
        if not (np.isfinite(number) and number >= 0):
            raise OptionError(f"{name} is {number!r}, expected a finite number ≥ 0")
