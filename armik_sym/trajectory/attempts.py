"""Trying to solve a task: from one guess after another, rate limits only where they matter."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.progress import Progress, ProgressCallback
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.ipopt import IpoptResult, IterationCallback, run_ipopt
from armik_sym.trajectory.task import Task

Array = NDArray[np.float64]

_log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Attempt:
    """How one attempt ended.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad].
        result: What IPOPT returned last.
        iterations: IPOPT iterations in all.
        unlimited: Angles found without rate limits where those with limits were not, else None.
    """

    q: Array
    result: IpoptResult
    iterations: int
    unlimited: Array | None = None


def attempt(task: Task, guess: Array, *, soft: bool, progress: ProgressCallback | None) -> Attempt:
    """Solve from one guess: without rate limits first, then with them if they are exceeded.

    An optimum that respects limits it was not told about is the optimum with them, too; the rows cost
    time and rarely bind, so they come in only when needed.

    Args:
        task: The task.
        guess: Joint angles, shape (n, dof), in [rad].
        soft: True for soft tracking.
        progress: Told about every iteration.

    Returns:
        How it ended; look at `result.converged`.

    Raises:
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        None (lazy constraints).
    """
    report = _reporter("soft tracking" if soft else "exact tracking", progress)
    outcome = _run(task, guess, soft=soft, rates=False, report=report)
    if outcome.result.converged and task.exceeds_rates(outcome.q):
        report = _reporter("speed and acceleration limits", progress)
        limited = _run(task, outcome.q, soft=soft, rates=True, report=report)
        iterations = outcome.iterations + limited.iterations
        return Attempt(limited.q, limited.result, iterations, None if limited.result.converged else outcome.q)
    return outcome


def attempts(
    task: Task, guesses: Iterator[Guess], *, soft: bool, progress: ProgressCallback | None
) -> Iterator[Attempt]:
    """Attempts from one guess after another; for exact tracking, a last one by way of a soft solution.

    Args:
        task: The task.
        guesses: Guesses, the most promising first.
        soft: True for soft tracking.
        progress: Told about every iteration.

    Yields:
        Attempts, converged or not.

    Source:
        None (this package).
    """
    first: Array | None = None
    for guess in guesses:
        first = guess.q if first is None else first
        outcome = attempt(task, guess.q, soft=soft, progress=progress)
        _log.info("%s: %s after %d iterations", guess.origin, outcome.result.status, outcome.iterations)
        yield outcome
    if not soft and first is not None:
        detour = attempt(task, first, soft=True, progress=progress)
        yield attempt(task, detour.q, soft=False, progress=progress)


def _run(task: Task, q: Array, *, soft: bool, rates: bool, report: IterationCallback | None) -> Attempt:
    result = run_ipopt(
        task.problem(soft=soft, rates=rates),
        task.bounds(soft=soft, rates=rates),
        task.start_vector(q, soft=soft),
        max_iterations=task.options.max_iterations,
        output=task.options.ipopt_output,
        report=report,
    )
    angles = result.x[: q.size].reshape(q.shape)
    return Attempt(angles, result, result.iterations)


def _reporter(stage: str, progress: ProgressCallback | None) -> IterationCallback | None:
    if progress is None:
        return None
    return lambda iteration, violation: progress(Progress(stage, iteration, violation))
