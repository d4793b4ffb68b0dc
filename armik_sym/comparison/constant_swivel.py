"""The simplest guess of what a person does: the swivel angle of the first posture, kept."""

from __future__ import annotations

import time as clock
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.rate_limit import rate_limit
from armik_sym.arm.start_posture import finite_posture
from armik_sym.compiled.backend import Backend
from armik_sym.errors import ArmModelError, OptionError
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.marker_gaps import runs
from armik_sym.solution import Requirements, Solution
from armik_sym.solution.timing import Timing
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.equivalent_angles import without_turns
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

METHOD = "swivel-constant"

_POSITION_TOLERANCE, _ROTATION_TOLERANCE = 1e-6, 1e-5
_MAX_SPEED = 10.0
_RUNS_NAMED = 4


def constant_swivel(
    arm: Arm,
    path: HandPath,
    start: ArrayLike,
    *,
    zero: Literal["carried", "down"] = "carried",
    backend: Backend = "auto",
) -> Solution:
    """The trajectory that keeps the swivel angle and branch of a first posture: a baseline, no method.

    ψ_k = ψ_1, or the nearest angle that keeps every joint inside its range of motion. Where the branch has
    no such angle at all, ψ_1 is kept, the joints stop at their limits, and the hand leaves the path.

    Args:
        arm: An arm with spherical shoulder, hinge elbow and spherical wrist.
        path: The hand path with rotations, n samples.
        start: The first posture, shape (dof,), in [rad]; its elbow counts, its hand need not be on the path.
        zero: Where the swivel angle is counted from: "carried", a direction that goes along with the path
            without turning about the line from shoulder to wrist; or "down", the direction down as the arm
            knows it, which turns about that line when the wrist passes below the shoulder.
        backend: "auto", "c" or "vm".

    Returns:
        The solution, judged by itself as any other; `status` says where the angle could not be kept, and
        `settings` hold how many samples were clipped and blocked.

    Raises:
        ArmModelError: If the arm has no such closed form, or does not say where up is.
        OptionError: If the path has no rotations, or `zero` is another word.
        ShapeError: If `start` does not have shape (dof,).
        HandPathError: If `start` is not finite.

    Source:
        Baseline of this package; the swivel angle as in Tolani and Badler (1996).
    """
    began = clock.perf_counter()
    first = _checked(arm, path, start, zero)
    spherical = recognise(arm)
    if spherical.wrist is None:
        raise ArmModelError(f"no swivel angle to keep: {spherical.why_no_wrist}")
    rotation = path.rotation
    if rotation is None:
        raise OptionError("the path has no rotation: its positions alone leave the wrist free, too")
    along = wrist_directions(spherical, path.position, rotation)
    reference = (
        transported_reference(spherical, along) if zero == "carried" else np.tile(_down(arm), (len(path), 1))
    )
    intervals = feasible_intervals(spherical, path.position, rotation, reference, backend)
    at = swivel_of_postures(spherical, first[None], reference[:1], backend=backend)
    branch = int(intervals.branch_of(np.array([[at.elbow[0], at.shoulder[0], at.wrist[0]]]))[0])
    psi, clipped, blocked = _kept(intervals, branch, float(at.psi[0]), len(path))
    rows = np.arange(len(path))
    q = postures_at(intervals.curves, rows, branch, psi, np.tile(first, (len(path), 1)), backend).q
    return Solution(
        arm=arm,
        path=path,
        # Of the clipped postures rounding may leave the range, of the blocked ones one joint does.
        q=np.clip(q, arm.rom.lower, arm.rom.upper),
        method=METHOD,
        orientation=Orientation.FULL,
        requirements=Requirements(
            _POSITION_TOLERANCE,
            _ROTATION_TOLERANCE,
            rate_limit("max_speed", _MAX_SPEED, arm),
            rate_limit("max_acceleration", None, arm),
        ),
        start=first,
        timing=Timing(solve=clock.perf_counter() - began),
        status=_status(path.time, float(at.psi[0]), clipped, blocked),
        settings={
            "zero": zero,
            "swivel": float(at.psi[0]),
            "clipped": int(clipped.sum()),
            "blocked": int(blocked.sum()),
        },
    )


def _checked(arm: Arm, path: HandPath, start: ArrayLike, zero: str) -> Array:
    if not isinstance(arm, Arm):
        raise OptionError(f"arm is {arm!r}, expected an Arm: use load_arm(NAME or FILE)")
    if not isinstance(path, HandPath):
        raise OptionError(f"path is a {type(path).__name__}, expected a HandPath: use read_path(FILE)")
    if zero not in ("carried", "down"):
        raise OptionError(f"zero is {zero!r}: valid are carried, down")
    return finite_posture(arm, start, "start")


def _down(arm: Arm) -> Array:
    if arm.up is None:
        raise ArmModelError(f'arm {arm.name!r} does not say where up is: zero="down" needs it, use "carried"')
    return -np.asarray(arm.up, dtype=np.float64)


def _kept(intervals: FeasibleIntervals, branch: int, psi: float, n: int) -> tuple[Array, Mask, Mask]:
    """The angle at each sample, where it is not ψ but the nearest possible one, and where there is none."""
    mine = np.flatnonzero(intervals.branch == branch)
    sample, start, end = intervals.sample[mine], intervals.start[mine], intervals.end[mine]
    inside = np.mod(psi - start, 2 * np.pi) <= end - start
    to_start, to_end = without_turns(start - psi), without_turns(end - psi)
    move = np.where(inside, 0.0, np.where(np.abs(to_start) <= np.abs(to_end), to_start, to_end))
    kept, chosen = np.full(n, np.inf), np.zeros(n)
    for k, change in zip(sample, move, strict=True):
        if abs(change) < kept[k]:
            kept[k], chosen[k] = abs(change), change
    blocked = np.isinf(kept)
    return psi + chosen, (chosen != 0) & ~blocked, blocked


def _status(time: Array, psi: float, clipped: Mask, blocked: Mask) -> str:
    words = [
        f"swivel {np.rad2deg(psi):.1f}° kept at {int((~clipped & ~blocked).sum())} of {len(time)} samples"
    ]
    if clipped.any():
        words.append(f"moved to the nearest angle inside the range of motion at {_runs(time, clipped)}")
    if blocked.any():
        words.append(
            f"no posture inside the range of motion at {_runs(time, blocked)}: joints at their limits"
        )
    return "; ".join(words)


def _runs(time: Array, chosen: Mask) -> str:
    """Samples as times: 12 samples (0.1 s to 0.21 s)."""
    times = [f"{time[a]:.3g} s to {time[b - 1]:.3g} s" for a, b in runs(chosen)]
    more = f", and {len(times) - _RUNS_NAMED} more" if len(times) > _RUNS_NAMED else ""
    return f"{int(chosen.sum())} samples ({', '.join(times[:_RUNS_NAMED])}{more})"
