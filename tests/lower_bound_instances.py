"""Paths, feasible trajectories and objectives that the tests of the lower bound share."""

from __future__ import annotations

import numpy as np
from spherical_arms import poses

from armik_sym.arm import Arm
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.trajectory.rates import acceleration_matrix, sample_durations, speed_matrix

TURN = 2 * np.pi


def motion(arm: Arm, rng: np.random.Generator, n: int, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """A smooth joint motion inside the range of motion, at uneven times."""
    time = np.cumsum(rng.uniform(0.5, 1.5, n))
    time = (time - time[0]) / (time[-1] - time[0]) * duration
    lower, width = arm.rom.lower, arm.rom.width
    q = np.tile(lower + width * rng.uniform(0.3, 0.7, arm.dof), (n, 1))
    for k in range(1, 4):
        phase, size = rng.uniform(0, 6, arm.dof), rng.uniform(0, 0.25, arm.dof) / k
        q += np.cos(np.pi * k * time[:, None] / duration + phase) * width * size
    return time, np.clip(q, lower + 1e-3, arm.rom.upper - 1e-3)


def intervals_along(arm: Arm, q: np.ndarray) -> FeasibleIntervals:
    """Feasible intervals of the path a joint motion makes."""
    spherical = recognise(arm)
    position, rotation = poses(arm, q)
    reference = transported_reference(spherical, wrist_directions(spherical, position, rotation))
    return feasible_intervals(spherical, position, rotation, reference)


def objective(
    time: np.ndarray, q: np.ndarray, rest: np.ndarray, speed: float, acceleration: float, posture: float
) -> float:
    """The objective from its definition; times may not nearly coincide."""
    total = speed * np.sum(np.square(speed_matrix(time) @ q) * np.diff(time)[:, None])
    if len(time) > 2:
        spacing = 0.5 * (time[2:] - time[:-2])
        total += acceleration * np.sum(np.square(acceleration_matrix(time) @ q) * spacing[:, None])
    total += posture * np.sum(np.square(q - rest) * sample_durations(time)[:, None])
    return float(0.5 * total)


def posture_at(
    intervals: FeasibleIntervals, sample: int, branch: int, psi: float, wish: np.ndarray | None = None
) -> np.ndarray:
    """The posture at a swivel angle."""
    e, s, w = intervals.branches[branch]
    curve = intervals.curves[0 if e == 1 else 1].rows([sample])
    return curve.postures(psi, s, w, wish=None if wish is None else wish[None]).q[0]


def random_feasible(
    intervals: FeasibleIntervals, q: np.ndarray, rng: np.random.Generator, jump: float
) -> np.ndarray:
    """A feasible trajectory: the swivel angles of `q` shifted smoothly, now and then any interval."""
    n = len(q)
    curve = intervals.curves[0]
    position, rotation = poses(curve.spherical.arm, q)
    reference = transported_reference(curve.spherical, wrist_directions(curve.spherical, position, rotation))
    at = swivel_of_postures(curve.spherical, q, reference)
    share = np.linspace(0, np.pi, n)
    shift = rng.uniform(-2, 2) + rng.uniform(-1, 1) * np.cos(share) + rng.uniform(-1, 1) * np.cos(2 * share)
    out = np.empty_like(q)
    for k in range(n):
        signs = at.elbow[k], at.shoulder[k], at.wrist[k]
        branch = int(np.flatnonzero((intervals.branches == signs).all(axis=1))[0])
        mine = np.flatnonzero((intervals.sample == k) & (intervals.branch == branch))
        if rng.uniform() < jump or not mine.size:
            row = rng.choice(np.flatnonzero(intervals.sample == k))
            psi = rng.uniform(intervals.start[row], intervals.end[row])
        else:
            psi, row = nearest_inside(intervals, mine, at.psi[k] + shift[k])
        out[k] = posture_at(intervals, k, int(intervals.branch[row]), psi, out[k - 1] if k else q[0])
    return out


def nearest_inside(intervals: FeasibleIntervals, rows: np.ndarray, psi: float) -> tuple[float, int]:
    """The feasible swivel angle nearest to a wished one, and its interval."""
    best = (np.inf, 0.0, 0)
    for row in rows:
        start, end = intervals.start[row], intervals.end[row]
        for wished in (psi - TURN, psi, psi + TURN):
            inside = float(np.clip(wished, start, end))
            best = min(best, (abs(inside - wished), inside, int(row)))
    return best[1], best[2]
