"""Guesses from cold: whole joint trajectories to start the full-space problem from."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.trajectory.damped_least_squares import REACHED, PoseSolver
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.posture_graph import graph_guess

Array = NDArray[np.float64]

_SCOUTED_SAMPLES = 40
_RANDOM_STARTS = 24
_CANDIDATES = 3
_GRAPHS = 2
_FOLLOWED_SAMPLES = 300
_SAME_POSTURE = 0.05


def guesses(
    solver: PoseSolver, time: Array, rom: RangeOfMotion, start: Array | None, seed: int
) -> Iterator[Guess]:
    """Trajectories to try, the most promising first; made one at a time, as they are asked for.

    First postures come from `start`, or from mid-range and random postures, each brought to sample 0.
    A scout along a few samples ranks them by the error it leaves and its largest step. Then come: the
    path followed sample by sample from the best, the shortest way through a graph of postures, the
    path followed from the others, and the best first posture held.

    Args:
        solver: Finds postures for samples.
        time: Time stamps, shape (n,), in [s].
        rom: Range of motion.
        start: First posture, shape (dof,), in [rad], or None.
        seed: Seed of the random postures.

    Yields:
        Guesses.

    Source:
        None (this package).
    """
    n = len(time)
    firsts = [start] if start is not None else first_postures(solver, n, rom, seed)
    for rank, first in enumerate(firsts):
        postures, errors = follow(solver, time, first)
        yield Guess(postures, errors, f"followed from first posture {rank + 1}")
        if rank == 0:
            for attempt in range(_GRAPHS):
                yield graph_guess(solver, time, rom, start, seed + attempt)
    yield Guess(np.tile(firsts[0], (n, 1)), np.full(n, np.inf), "first posture held")


def follow(solver: PoseSolver, time: Array, first: Array) -> tuple[Array, Array]:
    """Follow a path from a first posture; a long path by some of its samples, linear in between.

    What is missed in between is small where the path is dense, and the solver's to mend.

    Args:
        solver: Finds postures for samples.
        time: Time stamps, shape (n,), in [s].
        first: Posture at sample 0, shape (dof,), in [rad].

    Returns:
        Postures, shape (n, dof), in [rad], and the error at each followed sample, shape (n,), in [m],
        0 in between.

    Source:
        None (this package).
    """
    n = len(time)
    visited = np.unique(np.linspace(0, n - 1, min(n, _FOLLOWED_SAMPLES)).astype(np.int64))
    postures, errors = solver.follow(visited, first)
    if len(visited) == n:
        return postures, errors
    everywhere = np.zeros(n)
    everywhere[visited] = errors
    filled = [np.interp(time, time[visited], column) for column in postures.T]
    return np.array(filled).T, everywhere


def first_near(solver: PoseSolver, rom: RangeOfMotion, start: Array, seed: int) -> Array:
    """The posture at sample 0 that a known start leads to.

    Where the way down from `start` ends beside the sample, the one nearest to `start` among postures
    reached from random ones.

    Args:
        solver: Finds postures for samples.
        rom: Range of motion.
        start: Known posture, shape (dof,), in [rad].
        seed: Seed of the random postures.

    Returns:
        Posture, shape (dof,), in [rad]; it misses the sample if none was found that does not.

    Source:
        None (multistart).
    """
    direct = solver.reach(0, start)
    if direct.error < REACHED:
        return direct.q
    rng = np.random.default_rng(seed)
    tries = start + rng.uniform(0, 1, (_RANDOM_STARTS, 1)) * (
        rom.random_postures(rng, _RANDOM_STARTS) - start
    )
    others = [solver.reach(0, q) for q in tries]
    found = [other.q for other in others if other.error < REACHED]
    return min(found, key=lambda q: float(np.abs(q - start).max()), default=direct.q)


def first_postures(solver: PoseSolver, n: int, rom: RangeOfMotion, seed: int) -> list[Array]:
    """Postures for sample 0, ranked by how well a scout gets along the path from them.

    Score: error left at the scouted samples [m], then the largest joint step between them [rad].

    Args:
        solver: Finds postures for samples.
        n: Number of samples.
        rom: Range of motion.
        seed: Seed of the random postures.

    Returns:
        At most three postures, best first.

    Source:
        None (this package).
    """
    rng = np.random.default_rng(seed)
    starts = [rom.middle, *(rom.middle + rom.width * rng.uniform(-0.45, 0.45, (_RANDOM_STARTS, rom.dof)))]
    distinct: list[Array] = []
    for start in starts:
        reached = solver.reach(0, start)
        if all(np.abs(reached.q - other).max() > _SAME_POSTURE for other in distinct):
            distinct.append(reached.q)
    scouted = np.unique(np.linspace(0, n - 1, min(n, _SCOUTED_SAMPLES)).astype(np.int64))
    scores = []
    for first in distinct:
        postures, errors = solver.follow(scouted, first, iterations=25)
        steps = np.abs(np.diff(postures, axis=0)).max(initial=0.0)
        scores.append(10.0 * float(np.maximum(errors - 1e-6, 0).sum()) + float(steps))
    return [distinct[i] for i in np.argsort(scores)[:_CANDIDATES]]
