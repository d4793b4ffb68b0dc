"""A hand path solved one pose after another."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.rate_limit import rate_limit
from armik_sym.arm.start_posture import check_start
from armik_sym.compiled.backend import Backend
from armik_sym.motion.hand_path import HandPath
from armik_sym.pointwise.hand_targets import HandTargets, PointwiseOutcome
from armik_sym.pointwise.judging import Judging
from armik_sym.pointwise.library import PointwiseLibrary, pointwise_library
from armik_sym.progress import ProgressCallback
from armik_sym.solution import Requirements, Solution, Timing
from armik_sym.solution.tracked_orientation import tracked_orientation
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]


class PointwiseMethod(Protocol):
    """A method that takes one pose after another."""

    def __call__(
        self,
        arm: Arm,
        targets: HandTargets,
        options: Any,
        *,
        start: Array | None,
        seed: int,
        library: PointwiseLibrary,
        progress: ProgressCallback | None = None,
    ) -> PointwiseOutcome:
        """Solve all samples."""


def solve_pointwise(
    method: str,
    run: PointwiseMethod,
    arm: Arm,
    path: HandPath,
    options: Judging,
    *,
    start: ArrayLike | None = None,
    seed: int = 0,
    backend: Backend = "auto",
    progress: ProgressCallback | None = None,
) -> Solution:
    """Solve a hand path with a method that takes one pose after another.

    Args:
        method: Name of the method, for the record.
        run: The method.
        arm: The arm.
        path: The hand path.
        options: Options of the method.
        start: Known posture at the beginning, shape (dof,), in [rad].
        seed: Seed of everything random.
        backend: "auto", "c" or "vm".
        progress: Told what is going on, see `Progress`.

    Returns:
        The solution. Samples at which the method stopped without meeting its own criterion are a reason
        against it.

    Raises:
        LimitError: If `start` lies outside the range of motion.
        OptionError: If an option does not fit arm or path.

    Source:
        Nguyen 2021, §3.3; Al-Faiz, §3-5.
    """
    began = time.perf_counter()
    orientation = tracked_orientation(options.orientation, path)
    requirements = Requirements(
        position_tolerance=options.position_tolerance,
        rotation_tolerance=options.rotation_tolerance,
        max_speed=rate_limit("max_speed", options.max_speed, arm),
        max_acceleration=np.full(arm.dof, np.inf),
        start_tolerance=options.start_tolerance,
    )
    first = check_start(arm, start)
    called = time.perf_counter()
    library = pointwise_library(arm, backend)
    ready = time.perf_counter()
    # A library kept from an earlier call was compiled then.
    compile_time = library.compile_time if library.compile_time <= ready - called else 0.0
    targets = hand_targets(path, orientation)
    outcome = run(arm, targets, options, start=first, seed=seed, library=library, progress=progress)
    return Solution(
        arm=arm,
        path=path,
        q=outcome.q,
        method=method,
        orientation=orientation,
        requirements=requirements,
        start=first,
        seed=seed,
        timing=Timing(ready - began - compile_time, compile_time, time.perf_counter() - ready),
        status=_status(outcome, library),
        iterations=int(outcome.iterations.sum()),
        reached=outcome.reached,
        sample_iterations=outcome.iterations,
        settings=dataclasses.asdict(options),
    )


def named(method: str, run: PointwiseMethod) -> Callable[..., Solution]:
    """A pointwise method as an entry of `ak.solve`.

    Args:
        method: Its name.
        run: The method.

    Returns:
        A function (arm, path, options, *, start, seed, backend, progress) → Solution.

    Source:
        None (bookkeeping).
    """

    def solve(arm: Arm, path: HandPath, options: Judging, **keywords: Any) -> Solution:
        return solve_pointwise(method, run, arm, path, options, **keywords)

    return solve


def hand_targets(path: HandPath, orientation: Orientation) -> HandTargets:
    """The poses of a path in the form the pointwise methods read.

    Args:
        path: The hand path.
        orientation: What of its orientation is tracked.

    Returns:
        One pose per sample.

    Source:
        None (bookkeeping).
    """
    if orientation is Orientation.NONE or path.rotation is None:
        rotation = np.broadcast_to(np.eye(3).ravel(), (len(path), 9))
    else:
        rotation = path.rotation.reshape(-1, 9)
    return HandTargets(orientation, np.ascontiguousarray(np.hstack([path.position, rotation])))


def _status(outcome: PointwiseOutcome, library: PointwiseLibrary) -> str:
    done = int(np.count_nonzero(outcome.reached))
    how = "compiled" if library.library else "NumPy"
    return f"{done} of {len(outcome.reached)} samples reached ({how})"
