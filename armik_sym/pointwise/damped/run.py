"""Levenberg-Marquardt and Sugihara's method for many poses: along a path, or each from its own start."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import ShapeError
from armik_sym.pointwise.damped.c_loop import CompiledLoop
from armik_sym.pointwise.damped.found import Found
from armik_sym.pointwise.damped.numpy_loop import NumpyLoop
from armik_sym.pointwise.damped.options import LmOptions, SugiharaOptions
from armik_sym.pointwise.damped.settings import DampedSettings
from armik_sym.pointwise.hand_targets import HandTargets, PointwiseOutcome
from armik_sym.pointwise.library import PointwiseLibrary
from armik_sym.progress import Progress, ProgressCallback

Array = NDArray[np.float64]

# Samples per call into C: between calls Ctrl-C and progress have their turn.
BLOCK = 64

# Solves the samples of a slice: (slice, targets, starts, chain, found).
Loop = Callable[[slice, Array, Array, bool, Found], None]


def run_damped(
    arm: Arm,
    targets: HandTargets,
    options: LmOptions | SugiharaOptions,
    *,
    start: Array | None,
    seed: int,
    library: PointwiseLibrary,
    progress: ProgressCallback | None = None,
    workers: int = 1,
    block: int = BLOCK,
) -> PointwiseOutcome:
    """Solve samples one after another, each from the posture before, or independently of each other.

    Args:
        arm: The arm.
        targets: What the hand has to reach.
        options: Options of one of the two methods; they choose the method.
        start: Posture before the first sample, shape (dof,), in [rad]; None takes the middle of the range of
            motion. With shape (n, dof) the samples are independent, each starting from its own posture.
        seed: Seed of random restarts; they depend on it and on the index of the sample.
        library: Compiled loops; without them NumPy serves.
        progress: Told how many samples are done.
        workers: Threads for independent samples; results do not depend on it.
        block: Samples per call into C; results do not depend on it.

    Returns:
        Postures inside the range of motion, the best ones found where a sample was not reached.

    Raises:
        ShapeError: If `start` fits neither the arm nor the samples.

    Source:
        Al-Faiz, eq. 58-63; Sugihara (2011), doi:10.1109/TRO.2011.2148230.
    """
    n, dof = len(targets), arm.dof
    starts = np.ascontiguousarray(arm.rom.middle if start is None else start, dtype=np.float64)
    chain = starts.ndim == 1
    if starts.shape != ((dof,) if chain else (n, dof)):
        raise ShapeError(
            f"start has shape {starts.shape}, expected ({dof},), or ({n}, {dof}): one per sample"
        )
    pose = np.ascontiguousarray(targets.pose, dtype=np.float64)
    settings = DampedSettings.of(options, targets.orientation)
    seed %= 2**64
    loop: Loop
    if library.library is not None:
        loop = CompiledLoop(library.library, arm, settings, seed)
    else:
        loop = NumpyLoop(arm, settings, seed)
    found = Found.empty(n, dof)
    # Many restarts make samples slow, so fewer of them fit into one call.
    size = max(1, min(block, 20 * block // (options.restarts + 1)))
    parts = [slice(i, min(i + size, n)) for i in range(0, n, size)]
    done = 0
    for part in _solve_parts(loop, parts, pose, starts, chain, found, 1 if chain else workers):
        done += part.stop - part.start
        if progress is not None:
            progress(Progress("samples", done))
    return PointwiseOutcome(
        q=found.q,
        reached=found.error < options.tolerance,
        iterations=found.iterations,
        evaluations=int(found.evaluations.sum()),
    )


def _solve_parts(
    loop: Loop, parts: list[slice], pose: Array, starts: Array, chain: bool, found: Found, workers: int
) -> Iterator[slice]:
    """Solve parts of the samples; yields each when it is done."""
    if workers <= 1 or len(parts) == 1:
        for part in parts:
            loop(part, pose, found.q[part.start - 1] if chain and part.start else starts, chain, found)
            yield part
        return
    pool = ThreadPoolExecutor(workers)
    try:
        jobs = {pool.submit(loop, part, pose, starts, chain, found): part for part in parts}
        for job in as_completed(jobs):
            job.result()
            yield jobs[job]
    finally:
        pool.shutdown(cancel_futures=True)
