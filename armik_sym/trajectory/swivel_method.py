"""The whole trajectory over the swivel angle: the map, the global search, the optimum of each corridor."""

from __future__ import annotations

import itertools
import logging
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.progress import Progress
from armik_sym.solution.tracking_error import tracking_errors
from armik_sym.swivel.full_turns import split_at_full_turns
from armik_sym.swivel.library import swivel_library
from armik_sym.swivel.map import SwivelMap, swivel_map
from armik_sym.swivel.spherical_arm import why_not_spherical
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.by_swivel import Outline, SwivelProblem, joint_guess, outlines, polished, settled
from armik_sym.trajectory.elbow_rates import check_elbow_rates
from armik_sym.trajectory.full_space_method import spent_now
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.ipopt import IterationCallback
from armik_sym.trajectory.library import trajectory_library
from armik_sym.trajectory.nearest_start import nearest_on_curve
from armik_sym.trajectory.one_curve.limits import Limits
from armik_sym.trajectory.one_curve.parameters import wide_joints
from armik_sym.trajectory.one_curve.polish import Polished
from armik_sym.trajectory.outcome import Outcome
from armik_sym.trajectory.posture_cost import PostureCost, posture_cost, preferred_posture
from armik_sym.trajectory.request import Request
from armik_sym.trajectory.unreachable_on_map import raise_unreachable_on_map

Array = NDArray[np.float64]

_log = logging.getLogger(__name__)

# Further corridors, for when the best ones fail.
_SPARE = 3
# A suspect has to be better by this share to take the place of the best.
_BETTER = 1e-6
# Solutions whose joint angles differ by less than this everywhere are one, in [rad].
_SAME = 0.02
# Angles may leave the range of motion by this much for rounding before they are put back, in [rad].
_ROUNDING = 1e-7
_NOTHING = 1e-12
# Samples that miss the range of motion, in [rad], or the reach, in [m], by less are left to full space.
_BARELY = 1e-6


@dataclass(frozen=True, eq=False)
class SwivelOutcome:
    """What the method found.

    Attributes:
        outcomes: Trajectories, the best first; none if every corridor failed.
        guesses: Ways through the map, to start the full-space problem from.
        compile_time: Seconds the C compiler took.
    """

    outcomes: tuple[Outcome, ...]
    guesses: tuple[Guess, ...]
    compile_time: float


def why_not_by_swivel(request: Request) -> str | None:
    """Why a request is not one for the swivel map.

    Args:
        request: What is asked.

    Returns:
        The reason in one sentence; None if it is one.

    Source:
        None (this package).
    """
    if request.options.tracking != "exact":
        return 'the swivel map knows only exact tracking, but tracking is "soft"'
    if request.orientation is not Orientation.FULL:
        return f"the swivel map needs full poses, but orientation is {request.orientation.value!r}"
    return why_not_spherical(request.arm)


def solve_over_swivel(request: Request) -> SwivelOutcome:
    """Solve over the swivel angle.

    Args:
        request: What is asked, of an arm with spherical shoulder and wrist, with full poses.

    Returns:
        The trajectories found.

    Raises:
        UnreachablePathError: If samples have no posture inside the range of motion; names the joints.
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        None (this package); Shimizu et al. (2008) for one sample.
    """
    called = time.perf_counter()
    # Wishes that make no sense for this arm are refused here, before anything runs.
    preferred_posture(request.arm, request.options.prefer)
    wishes = posture_cost(request.arm, request.options, request.backend)
    compiled = _compile(request.backend) + (0.0 if wishes is None else wishes.compile_time)
    compile_time = spent_now(compiled, time.perf_counter() - called)
    request.tell("swivel map")
    map_ = swivel_map(request.arm, request.path, backend=request.backend)
    if map_.blocked.size:
        if _barely(map_):
            return SwivelOutcome((), (), compile_time)
        raise_unreachable_on_map(map_)
    check_elbow_rates(request.arm, request.path, map_.intervals, request.max_speed, request.max_acceleration)
    problem = swivel_problem(request, map_, wishes)
    request.tell("global path")
    n_best = request.options.n_best
    found = outlines(problem)
    if n_best > 1:
        found += outlines(problem, most=4 * n_best, within=3.0, kept=3.0)
    guesses = tuple(_guess(problem, outline) for outline in found[:3])
    best = _polish_each(request, problem, found)
    outcomes = [_outcome(request, each) for each in best]
    if request.options.certify and best:
        outcomes[0] = _certified(request, problem, map_, best[0])
    return SwivelOutcome(tuple(outcomes), guesses, compile_time)


def _barely(map_: SwivelMap) -> bool:
    """Whether blocked samples miss by so little that rounding may be all there is, as at a straight arm."""
    why = map_.why_blocked(map_.blocked)
    return bool((why.missing < _BARELY).all() and (why.shortfall < _BARELY).all())


def _compile(backend: Backend) -> float:
    """Compile both libraries at the same time; returns the seconds of the one that took longer."""
    with ThreadPoolExecutor(2) as both:
        one, other = both.submit(swivel_library, backend), both.submit(trajectory_library, backend)
        libraries = one.result(), other.result()
    return max((library.compile_time for library in libraries if library is not None), default=0.0)


def swivel_problem(request: Request, map_: SwivelMap, wishes: PostureCost | None) -> SwivelProblem:
    """The problem over the swivel angle.

    Args:
        request: What is asked.
        map_: The swivel map of its arm and path.
        wishes: Clearance and preferred elbow direction; None if not asked for.

    Returns:
        The problem.

    Source:
        None (this package).
    """
    intervals = split_at_full_turns(map_.intervals, request.backend)
    o, arm = request.options, request.arm
    first = None
    if request.start is not None:
        first = nearest_on_curve(intervals, request.start, request.backend)
    return SwivelProblem(
        arm=arm,
        path=request.path,
        intervals=intervals,
        reference=map_.reference,
        weights=(o.speed_weight, o.acceleration_weight, o.posture_weight),
        aim=preferred_posture(arm, o.prefer),
        limits=Limits(request.max_speed, request.max_acceleration, arm.rom, wide_joints(intervals)),
        first=first,
        library=trajectory_library(request.backend),
        backend=request.backend,
        posture_cost=wishes,
        max_iterations=o.max_iterations,
        output=o.ipopt_output,
    )


def _polish_each(request: Request, problem: SwivelProblem, found: list[Outline]) -> list[Polished]:
    """The optima of the corridors, the best first; those that fail or turn out to be one are left out."""
    n_best = request.options.n_best
    if not found:
        return []
    chosen = found[:1] if n_best == 1 else found
    corridors = sorted((settled(problem, outline) for outline in chosen), key=lambda each: each.value)
    spare = (settled(problem, outline) for outline in found[len(chosen) :][:_SPARE])
    kept: list[Polished] = []
    for corridor in itertools.chain(corridors, spare):
        if len(kept) == n_best:
            break
        result = polished(problem, corridor, _reporter(request))
        _log.info("corridor: %s, objective %.6g", result.result.status, result.value)
        known = any(np.abs(result.q - other.q).max() < _SAME for other in kept)
        if _is_good(request, result, corridor.beside_pole) and not known:
            kept.append(result)
    return sorted(kept, key=lambda each: each.value)


def _certified(request: Request, problem: SwivelProblem, map_: SwivelMap, best: Polished) -> Outcome:
    """The best trajectory with its bound; where the bound suspects a better one, that is tried, too."""
    from armik_sym.trajectory.certified import certified, suspected  # slow to import, and seldom asked for

    request.tell("lower bound")
    bound = certified(problem, map_, request.arm.rom.clip(best.q))
    suspect = suspected(problem, bound)
    if suspect is not None:
        corridor = settled(problem, suspect)
        other = polished(problem, corridor, _reporter(request))
        if _is_good(request, other, corridor.beside_pole) and other.value < (1 - _BETTER) * best.value:
            best, bound = other, certified(problem, map_, request.arm.rom.clip(other.q))
    return replace(_outcome(request, best), bound=bound)


def _is_good(request: Request, result: Polished, beside_pole: bool) -> bool:
    """Whether limits are kept and, where rounding may have been at work, the hand is where it should be."""
    if not result.result.converged or result.broken:
        return False
    outside = -float(request.arm.rom.margin(result.q).min())
    if outside > _ROUNDING:
        return False
    if outside <= _NOTHING and not beside_pole:
        return True  # the closed form itself, untouched: it is exact
    path, o = request.path, request.options
    q = request.arm.rom.clip(result.q)
    shift, turn = tracking_errors(request.arm, q, path.position, path.rotation, Orientation.FULL)
    return bool(
        shift.max() <= o.position_tolerance_or_default and turn.max() <= o.rotation_tolerance_or_default
    )


def _outcome(request: Request, result: Polished) -> Outcome:
    return Outcome(request.arm.rom.clip(result.q), result.result.status, result.iterations)


def _guess(problem: SwivelProblem, outline: Outline) -> Guess:
    return Guess(joint_guess(problem, outline.way), np.zeros(len(problem.path)), "way through the swivel map")


def _reporter(request: Request) -> IterationCallback | None:
    progress = request.progress
    if progress is None:
        return None
    return lambda iteration, violation: progress(Progress("one curve", iteration, violation))
