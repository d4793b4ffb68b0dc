"""The whole trajectory in full space: all joint angles of all samples are variables of one IPOPT problem."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.kinematics import compile
from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.errors import SolverError
from armik_sym.trajectory.attempts import Attempt, attempts
from armik_sym.trajectory.damped_least_squares import REACHED, PoseSolver
from armik_sym.trajectory.first_guess import first_near, guesses
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.input_checks import raise_too_fast
from armik_sym.trajectory.outcome import Outcome
from armik_sym.trajectory.pose_error import SampleError
from armik_sym.trajectory.reachability import find_unreachable, nearest_posture, raise_unreachable
from armik_sym.trajectory.request import Request
from armik_sym.trajectory.task import Task

Array = NDArray[np.float64]

# After this many motions that only rate limits spoil, further guesses are not worth the wait.
_ENOUGH_TOO_FAST = 2


def solve_in_full_space(request: Request, known: Iterable[Guess] = ()) -> Outcome:
    """Solve with every joint angle as a variable, from one guess after another.

    Args:
        request: What is asked.
        known: Guesses that come before those of this method.

    Returns:
        The first trajectory that converges.

    Raises:
        UnreachablePathError: If samples cannot be reached; names them and the distance.
        SolverError: If no attempt converged although every sample can be reached.
        LimitError: If only rate limits stand against every motion found.
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        None (direct transcription).
    """
    arm, path, options = request.arm, request.path, request.options
    called = time.perf_counter()
    kinematics = compile(arm, request.backend)
    between = time.perf_counter()
    stage = compile_stage(arm, request.orientation, request.backend)
    ready = time.perf_counter()
    compile_time = spent_now(kinematics.compile_time, between - called)
    compile_time += spent_now(stage.compile_time, ready - between)

    pose_solver = PoseSolver(kinematics, SampleError(arm, path, request.orientation))
    soft = options.tracking == "soft"
    start = request.start
    first = start if start is None or soft else first_near(pose_solver, arm.rom, start, request.seed)
    called = time.perf_counter()
    limits = request.max_speed, request.max_acceleration
    task = Task(arm, path, request.orientation, options, *limits, first, stage)
    if task.posture_cost is not None:
        compile_time += spent_now(task.posture_cost.compile_time, time.perf_counter() - called)
    request.tell("first guess")
    tries = guesses(pose_solver, path.time, arm.rom, first, request.seed)
    if not soft:
        tries = _exact_guesses(tries, task, pose_solver, request)
    every = itertools.chain(known, tries)
    outcome = _first_converged(task, attempts(task, every, soft=soft, progress=request.progress))
    return Outcome(arm.rom.clip(outcome.q), outcome.result.status, outcome.iterations, compile_time)


def spent_now(compile_time: float, elapsed: float) -> float:
    """Compile time that fell into this call: a program kept from an earlier call was compiled then.

    Args:
        compile_time: Seconds the compiler took whenever it ran, in [s].
        elapsed: Seconds this call took, in [s].

    Returns:
        Seconds of this call, in [s].

    Source:
        None (bookkeeping).
    """
    return compile_time if compile_time <= elapsed else 0.0


def _exact_guesses(
    tries: Iterator[Guess], task: Task, solver: PoseSolver, request: Request
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
    request.tell("samples out of reach")
    found = find_unreachable(solver, task.arm, len(task.path), first, request.seed)
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
