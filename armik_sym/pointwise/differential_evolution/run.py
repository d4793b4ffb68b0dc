"""ISADE and Pro-ISADE along paths: one, or many at once on all cores."""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError
from armik_sym.pointwise.differential_evolution.compiled_search import CompiledSearch
from armik_sym.pointwise.differential_evolution.options import IsadeOptions
from armik_sym.pointwise.differential_evolution.search import NumpySearch
from armik_sym.pointwise.hand_targets import HandTargets, PointwiseOutcome
from armik_sym.pointwise.library import PointwiseLibrary
from armik_sym.progress import Progress, ProgressCallback

Array = NDArray[np.float64]

# Samples per call into C, and work per call (`IsadeOptions.work_for`) at some 150 ns each: Ctrl-C is heard
# after 0.3 s, or after the sample if that one takes longer.
BLOCK = 32
WORK = 2_000_000


@dataclass(frozen=True, eq=False)
class PathJob:
    """One path to solve.

    Attributes:
        targets: What has to be reached.
        start: Known posture at the beginning, shape (dof,), in [rad], or None.
        seed: Seed of everything random.
    """

    targets: HandTargets
    start: Array | None = None
    seed: int = 0


def run_isade(
    arm: Arm,
    targets: HandTargets,
    options: IsadeOptions,
    *,
    start: Array | None = None,
    seed: int = 0,
    library: PointwiseLibrary,
    progress: ProgressCallback | None = None,
) -> PointwiseOutcome:
    """Follow a path with ISADE, or with Pro-ISADE if the options are `ProIsadeOptions`.

    Without a start posture, q_0 of eq. (16) is the middle of the range of motion.

    Args:
        arm: The arm.
        targets: What has to be reached.
        options: The options.
        start: Known posture at the beginning, shape (dof,), in [rad].
        seed: Seed of everything random; the same seed gives the same answer.
        library: Compiled loops; NumPy serves where there are none.
        progress: Told how many samples are done.

    Returns:
        Postures and what they took; reached means b·‖hand error‖ < stop.

    Source:
        Nguyen 2021, §3, §4.2.
    """
    return _follow(arm, PathJob(targets, start, seed), options, library, progress, threading.Event())


def run_many(
    arm: Arm,
    jobs: Sequence[PathJob],
    options: IsadeOptions,
    *,
    library: PointwiseLibrary,
    threads: int | None = None,
) -> list[PointwiseOutcome]:
    """Follow many paths at once; the answers do not depend on the number of threads.

    Args:
        arm: The arm.
        jobs: The paths.
        options: The options.
        library: Compiled loops; without, the threads share one interpreter and gain little.
        threads: Number of threads; None: one per core.

    Returns:
        One outcome per path, in their order.

    Raises:
        OptionError: If `threads` is less than 1.

    Source:
        Nguyen 2021, §4.1 (20 repetitions of each task).
    """
    count = threads if threads is not None else os.cpu_count() or 1
    if count < 1:
        raise OptionError(f"threads is {threads!r}, expected a whole number ≥ 1")
    cancelled = threading.Event()
    with ThreadPoolExecutor(count) as pool:
        running = [pool.submit(_follow, arm, job, options, library, None, cancelled) for job in jobs]
        try:
            return [task.result() for task in running]
        except BaseException:
            cancelled.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _follow(
    arm: Arm,
    job: PathJob,
    options: IsadeOptions,
    library: PointwiseLibrary,
    progress: ProgressCallback | None,
    cancelled: threading.Event,
) -> PointwiseOutcome:
    measure, n = options.measure_for(job.targets), len(job.targets)
    beginning = arm.rom.middle if job.start is None else np.asarray(job.start, dtype=np.float64)
    previous = np.clip(beginning, arm.rom.lower, arm.rom.upper)
    q, error = np.empty((n, arm.dof)), np.full(n, np.inf)
    generations, evaluations = np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int64)
    pose = np.ascontiguousarray(job.targets.pose)
    step = max(1, min(BLOCK, WORK // options.work_for(measure))) if library.library else 1
    compiled = CompiledSearch(library.library, arm, options, measure) if library.library else None
    plain = None if compiled else NumpySearch(arm, options, measure)
    for first in range(0, n, step):
        if cancelled.is_set():
            break
        part = slice(first, min(first + step, n))
        if compiled:
            q[part], error[part], generations[part], evaluations[part] = compiled.samples(
                first, pose[part], previous, job.seed
            )
        elif plain:
            found = plain.sample(first, pose[first], previous, job.seed)
            q[first], error[first] = found.q, found.error
            generations[first], evaluations[first] = found.generations, found.evaluations
            previous = found.q
        if progress:
            progress(Progress(options.method, part.stop))
    reached = (error < options.stop) & np.isfinite(q).all(axis=1)
    return PointwiseOutcome(q, reached, generations, int(evaluations.sum()))
