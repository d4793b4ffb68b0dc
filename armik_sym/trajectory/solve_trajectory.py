"""The whole joint trajectory in one call."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.rate_limit import rate_limit
from armik_sym.arm.start_posture import check_start
from armik_sym.compiled.backend import Backend
from armik_sym.compiled.kinematics import compile
from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.errors import SolverError
from armik_sym.motion.hand_path import HandPath
from armik_sym.progress import Progress, ProgressCallback
from armik_sym.solution import Requirements, Solution, Timing
from armik_sym.solution.tracked_orientation import tracked_orientation
from armik_sym.trajectory.attempts import Attempt, attempts
from armik_sym.trajectory.damped_least_squares import REACHED, PoseSolver
from armik_sym.trajectory.first_guess import first_near, guesses
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.input_checks import check_enough_joints, check_hand_speed, raise_too_fast
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.pose_error import SampleError
from armik_sym.trajectory.reachability import find_unreachable, nearest_posture, raise_unreachable
from armik_sym.trajectory.task import Task

Array = NDArray[np.float64]

# After this many motions that only rate limits spoil, further guesses are not worth the wait.
_ENOUGH_TOO_FAST = 2


def solve_trajectory(
    arm: Arm,
    path: HandPath,
    options: TrajectoryOptions,
    *,
    start: ArrayLike | None = None,
    seed: int = 0,
    backend: Backend = "auto",
    progress: ProgressCallback | None = None,
) -> Solution:
    """Solve the inverse kinematics of a whole hand path at once, with IPOPT over all samples.

    minimise ½∫ w_v|q̇|² + w_a|q̈|² + w_p|q - middle|² dt subject to hand(q_k) = sample k, lower ≤ q_k ≤
    upper, |q̇| ≤ max_speed, |q̈| ≤ max_acceleration.

    Args:
        arm: The arm.
        path: The hand path.
        options: Choices, see `TrajectoryOptions`.
        start: Known posture at the beginning, shape (dof,), in [rad]. Soft tracking begins with it. Exact
            tracking begins with it if it puts the hand on sample 0, otherwise with a posture near it
            that does; a difference above `start_tolerance` is a reason against the solution.
        seed: Seed of the random first postures tried from cold.
        backend: "auto", "c" or "vm".
        progress: Told what is going on, see `Progress`.

    Returns:
        The solution.

    Raises:
        UnreachablePathError: If samples cannot be reached; names them and the distance.
        SolverError: If no attempt converged although every sample can be reached.
        LimitError: If `start` lies outside the range of motion or limits contradict the path.
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        None (this package); compare Nguyen 2021, §3.3, which solves point after point.
    """
    began = time.perf_counter()
    orientation = tracked_orientation(options.orientation, path)
    if options.tracking == "exact":
        check_enough_joints(arm, orientation)
    max_speed = rate_limit("max_speed", options.max_speed, arm)
    max_acceleration = rate_limit("max_acceleration", options.max_acceleration, arm)
    start = check_start(arm, start)
    check_hand_speed(arm, path, max_speed)
    called = time.perf_counter()
    kinematics = compile(arm, backend)
    between = time.perf_counter()
    stage = compile_stage(arm, orientation, backend)
    ready = time.perf_counter()
    compile_time = _spent_now(kinematics.compile_time, between - called)
    compile_time += _spent_now(stage.compile_time, ready - between)

    pose_solver = PoseSolver(kinematics, SampleError(arm, path, orientation))
    soft = options.tracking == "soft"
    first = start if start is None or soft else first_near(pose_solver, arm.rom, start, seed)
    task = Task(arm, path, orientation, options, max_speed, max_acceleration, first, stage)
    if progress:
        progress(Progress("first guess"))
    tries = guesses(pose_solver, path.time, arm.rom, first, seed)
    if not soft:
        tries = _exact_guesses(tries, task, pose_solver, seed, progress)
    outcome = _first_converged(task, attempts(task, tries, soft=soft, progress=progress))
    return Solution(
        arm=arm,
        path=path,
        q=arm.rom.clip(outcome.q),
        method="trajectory",
        orientation=orientation,
        requirements=Requirements(
            position_tolerance=options.position_tolerance_or_default,
            rotation_tolerance=options.rotation_tolerance_or_default,
            max_speed=max_speed,
            max_acceleration=max_acceleration,
            start_tolerance=options.start_tolerance,
        ),
        start=start,
        seed=seed,
        timing=Timing(ready - began - compile_time, compile_time, time.perf_counter() - ready),
        status=outcome.result.status,
        iterations=outcome.iterations,
        settings=dataclasses.asdict(options),
    )


def _exact_guesses(
    tries: Iterator[Guess], task: Task, solver: PoseSolver, seed: int, progress: ProgressCallback | None
) -> Iterator[Guess]:
    """Pass guesses on; where the first misses samples or all fail, see whether the path can be reached."""
    first: Array = task.arm.rom.middle
    for number, guess in enumerate(tries):
        if number == 0:
            first = guess.q[0]
            missed = np.flatnonzero(guess.errors >= REACHED)
            if missed.size and _is_lost(task, solver, int(missed[np.argmax(guess.errors[missed])]), guess):
                break
        yield guess
    if progress:
        progress(Progress("samples out of reach"))
    found = find_unreachable(solver, task.arm, len(task.path), first, seed)
    if found.samples.size:
        raise_unreachable(task.arm, task.path, task.orientation, found)


def _is_lost(task: Task, solver: PoseSolver, k: int, guess: Guess) -> bool:
    """True if the worst sample of a guess cannot be reached from many postures either."""
    rom = task.arm.rom
    rng = np.random.default_rng(k)
    starts = [guess.q[k], rom.middle, *rom.random_postures(rng, 30)]
    return nearest_posture(solver, k, starts).error >= REACHED


def _first_converged(task: Task, outcomes: Iterator[Attempt]) -> Attempt:
    last: Attempt | None = None
    too_fast: list[Array] = []
    for outcome in outcomes:
        if outcome.result.converged:
            return outcome
        last = outcome
        too_fast += [] if outcome.unlimited is None else [outcome.unlimited]
        if len(too_fast) == _ENOUGH_TOO_FAST:
            break
    status = last.result.status if last else "no guess"
    if too_fast:
        raise_too_fast(task.arm, task.path, too_fast[0], task.max_speed, task.max_acceleration)
    raise SolverError(f"no attempt converged (last: {status}). {_what_to_do(task, status)}", status)


def _what_to_do(task: Task, status: str) -> str:
    if status == "Maximum_Iterations_Exceeded":
        return f"Raise max_iterations (now {task.options.max_iterations})."
    if status in ("Infeasible_Problem_Detected", "no guess"):
        return (
            f"Every sample can be reached on its own, but no continuous motion of arm {task.arm.name!r} "
            "inside its range of motion and rate limits was found. Raise max_speed or max_acceleration, give "
            'a start posture, or use tracking="soft".'
        )
    return (
        "The solver ran into numerical trouble: look at time stamps that nearly coincide and at weights that "
        'differ by many orders of magnitude, or use tracking="soft".'
    )


def _spent_now(compile_time: float, elapsed: float) -> float:
    """Compile time that fell into this call: a program kept from an earlier call was compiled then."""
    return compile_time if compile_time <= elapsed else 0.0
