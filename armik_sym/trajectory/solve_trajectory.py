"""The whole joint trajectory in one call."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Sequence

from numpy.typing import ArrayLike

from armik_sym.arm.model import Arm
from armik_sym.arm.rate_limit import rate_limit
from armik_sym.arm.start_posture import check_start
from armik_sym.compiled.backend import Backend
from armik_sym.errors import OptionError, SolverError
from armik_sym.motion.hand_path import HandPath
from armik_sym.progress import ProgressCallback
from armik_sym.solution import Requirements, Solution, Timing
from armik_sym.solution.tracked_orientation import tracked_orientation
from armik_sym.trajectory.full_space_method import solve_in_full_space
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.input_checks import check_enough_joints, check_hand_speed
from armik_sym.trajectory.interrupt import interrupts_come_out
from armik_sym.trajectory.map_guess import map_guess
from armik_sym.trajectory.objective import objective
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.outcome import Outcome
from armik_sym.trajectory.request import Request
from armik_sym.trajectory.swivel_method import SwivelOutcome, solve_over_swivel, why_not_by_swivel


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
    """Solve the inverse kinematics of a whole hand path at once.

    minimise ½∫ w_v|q̇|² + w_a|q̈|² + w_p|q - preferred|² dt + ∫ ℓ(q) dt subject to hand(q_k) = sample k,
    lower ≤ q_k ≤ upper, |q̇| ≤ max_speed, |q̈| ≤ max_acceleration. ℓ is what clearance and preferred elbow
    direction cost.

    For full poses of an arm with spherical shoulder and wrist the unknown is one curve, the swivel angle: a
    global search through the swivel map finds the corridor, IPOPT the optimum in it. Everything else is
    solved in full space, with every joint angle of every sample as a variable.

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
    request = _checked(arm, path, options, start, seed, backend, progress)
    with interrupts_come_out():
        outcomes, compile_time = _outcomes(request)
        timing = Timing(0.0, compile_time, time.perf_counter() - began - compile_time)
        best, *others = (_solution(request, outcome, timing) for outcome in outcomes)
    return dataclasses.replace(best, alternatives=tuple(others))


def _outcomes(request: Request) -> tuple[Sequence[Outcome], float]:
    """Trajectories, the best first, and the seconds the compiler took."""
    found, known = SwivelOutcome((), (), 0.0), tuple[Guess, ...]()
    by_swivel = _by_swivel(request)
    if by_swivel:
        found = solve_over_swivel(request)
        known = found.guesses
    elif request.options.search != "full-space" and (guess := map_guess(request)) is not None:
        known = (guess,)
    if found.outcomes:
        return found.outcomes, found.compile_time
    if request.options.search == "swivel":
        raise SolverError(
            "no corridor of the swivel map led to a trajectory inside all limits, though every sample can be "
            'reached on its own. Raise max_speed or max_acceleration, or use search="auto", which goes on in '
            "full space"
        )
    outcome = solve_in_full_space(request, known)
    if by_swivel:
        without = ", without a bound" if request.options.certify else ""
        outcome = dataclasses.replace(outcome, status=f"{outcome.status} in full space{without}")
    return (outcome,), found.compile_time + outcome.compile_time


def _checked(
    arm: Arm,
    path: HandPath,
    options: TrajectoryOptions,
    start: ArrayLike | None,
    seed: int,
    backend: Backend,
    progress: ProgressCallback | None,
) -> Request:
    orientation = tracked_orientation(options.orientation, path)
    if options.tracking == "exact":
        check_enough_joints(arm, orientation)
    max_speed = rate_limit("max_speed", options.max_speed, arm)
    max_acceleration = rate_limit("max_acceleration", options.max_acceleration, arm)
    first = check_start(arm, start)
    check_hand_speed(arm, path, max_speed)
    limits = max_speed, max_acceleration
    return Request(arm, path, orientation, options, *limits, first, seed, backend, progress)


def _by_swivel(request: Request) -> bool:
    """Whether the swivel map is the way to go; refuses wishes only it can fulfil where it is not."""
    search, n_best = request.options.search, request.options.n_best
    reason = 'search is "full-space"' if search == "full-space" else why_not_by_swivel(request)
    if reason is None:
        return True
    if search == "swivel":
        raise OptionError(f'search="swivel" does not fit: {reason}. Use search="auto" or search="full-space"')
    if n_best > 1:
        raise OptionError(f"n_best={n_best} needs the swivel map, which is not used here: {reason}")
    if request.options.certify:
        raise OptionError(f"certify=True needs the swivel map, which is not used here: {reason}")
    return False


def _solution(request: Request, outcome: Outcome, timing: Timing) -> Solution:
    options = request.options
    return Solution(
        arm=request.arm,
        path=request.path,
        q=outcome.q,
        method="trajectory",
        orientation=request.orientation,
        requirements=Requirements(
            position_tolerance=options.position_tolerance_or_default,
            rotation_tolerance=options.rotation_tolerance_or_default,
            max_speed=request.max_speed,
            max_acceleration=request.max_acceleration,
            start_tolerance=options.start_tolerance,
        ),
        start=request.start,
        seed=request.seed,
        timing=timing,
        status=outcome.status,
        iterations=outcome.iterations,
        settings=dataclasses.asdict(options),
        bound=outcome.bound,
        cost=objective(request.arm, request.path.time, outcome.q, options, request.backend),
    )
