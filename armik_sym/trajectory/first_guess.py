"""Guesses from cold: whole joint trajectories to start the full-space problem from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.damped_least_squares import PoseSolver

Array = NDArray[np.float64]

_SCOUTED_SAMPLES = 40
_RANDOM_STARTS = 24
_CANDIDATES = 3
_SAME_POSTURE = 0.05


@dataclass(frozen=True, eq=False)
class Guess:
    """A joint trajectory to start from.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad].
        errors: Error left at each sample, shape (n,), in [m].
        origin: How it was made, for logs.
    """

    q: Array
    errors: Array
    origin: str


def guesses(
    solver: PoseSolver, n: int, middle: Array, width: Array, start: Array | None, seed: int
) -> Iterator[Guess]:
    """Trajectories to try, the most promising first; made one at a time, as they are asked for.

    First postures come from `start`, or from mid-range and random postures, each brought to sample 0.
    A scout along a few samples ranks them by the error it leaves and its largest step. Then come, for
    each: the path followed sample by sample, and the first posture held constant.

    Args:
        solver: Finds postures for samples.
        n: Number of samples.
        middle: Posture in the middle of the range of motion, shape (dof,), in [rad].
        width: Width of the range of motion, shape (dof,), in [rad].
        start: First posture, shape (dof,), or None.
        seed: Seed of the random postures.

    Returns:
        Guesses.

    Source:
        None (this package).
    """
    firsts = [start] if start is not None else first_postures(solver, n, middle, width, seed)
    everything = np.arange(n)
    for rank, first in enumerate(firsts):
        postures, errors = solver.follow(everything, first)
        yield Guess(postures, errors, f"followed from first posture {rank + 1}")
    for rank, first in enumerate(firsts):
        constant = np.tile(first, (n, 1))
        yield Guess(constant, np.full(n, np.inf), f"first posture {rank + 1} held")


def first_postures(solver: PoseSolver, n: int, middle: Array, width: Array, seed: int) -> list[Array]:
    """Postures for sample 0, ranked by how well a scout gets along the path from them.

    Score: error left at the scouted samples [m], then the largest joint step between them [rad].

    Args:
        solver: Finds postures for samples.
        n: Number of samples.
        middle: Posture in the middle of the range of motion, shape (dof,), in [rad].
        width: Width of the range of motion, shape (dof,), in [rad].
        seed: Seed of the random postures.

    Returns:
        At most three postures, best first.

    Source:
        None (this package).
    """
    rng = np.random.default_rng(seed)
    starts = [middle, *(middle + width * rng.uniform(-0.45, 0.45, (_RANDOM_STARTS, len(middle))))]
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
