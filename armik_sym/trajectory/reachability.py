"""Which samples of a path an arm cannot reach at all, and by how much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError, UnreachablePathError
from armik_sym.motion.hand_path import HandPath
from armik_sym.solution.tracking_error import tracking_errors
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.damped_least_squares import REACHED, PoseSolver, Reached

Array = NDArray[np.float64]

_STARTS = 30
_FEW_STARTS = 3
_THOROUGH = 30
_LISTED = 8


@dataclass(frozen=True, eq=False)
class Unreachable:
    """Samples that no posture inside the range of motion was found for.

    Attributes:
        samples: Their indices, shape (m,).
        q: The nearest postures found, shape (m, dof), in [rad].
    """

    samples: NDArray[np.int64]
    q: Array


def find_unreachable(solver: PoseSolver, arm: Arm, n: int, q0: Array, seed: int) -> Unreachable:
    """Follow the whole path, and try the samples missed on the way from many postures.

    Args:
        solver: Finds postures for samples.
        arm: The arm.
        n: Number of samples.
        q0: Posture to begin with, shape (dof,), in [rad].
        seed: Seed of the random postures.

    Returns:
        The samples that no posture brings the hand to.

    Source:
        None (multistart).
    """
    postures, errors = solver.follow(np.arange(n), q0)
    missed = np.flatnonzero(errors >= REACHED)
    rng = np.random.default_rng(seed)
    samples: list[int] = []
    nearest: list[Array] = []
    for k in missed:
        # Once many samples are lost for certain, a few tries tell whether their neighbours are, too.
        count = _STARTS if len(samples) < _THOROUGH else _FEW_STARTS
        tries = [postures[k], *nearest[-1:], arm.rom.middle]
        tries += list(arm.rom.random_postures(rng, count))
        best = nearest_posture(solver, int(k), tries)
        if best.error >= REACHED:
            samples.append(int(k))
            nearest.append(best.q)
    return Unreachable(np.array(samples, dtype=np.int64), np.array(nearest).reshape(-1, arm.dof))


def nearest_posture(solver: PoseSolver, k: int, starts: list[Array]) -> Reached:
    """The posture that brings the hand nearest to a sample, from several starts.

    Args:
        solver: Finds postures for samples.
        k: The sample.
        starts: Postures to start from, shape (dof,) each, in [rad].

    Returns:
        The best; the search ends at the first that reaches the sample.

    Raises:
        OptionError: If there is no start.

    Source:
        None (multistart).
    """
    best: Reached | None = None
    for start in starts:
        reached = solver.reach(k, start, iterations=100)
        best = reached if best is None or reached.error < best.error else best
        if best.error < REACHED:
            break
    if best is None:
        raise OptionError("nearest_posture needs at least one start")
    return best


def raise_unreachable(arm: Arm, path: HandPath, orientation: Orientation, found: Unreachable) -> None:
    """Raise the error that names the samples out of reach and what to do about them.

    Args:
        arm: The arm.
        path: The hand path.
        orientation: What of it is tracked.
        found: The samples out of reach.

    Raises:
        UnreachablePathError: Always.

    Source:
        None (reporting).
    """
    m = len(found.samples)
    rotation = None if path.rotation is None else path.rotation[found.samples]
    shortfall, turn = tracking_errors(arm, found.q, path.position[found.samples], rotation, orientation)
    listed = ", ".join(
        f"{k} by {1000 * s:.3g} mm"
        + ("" if orientation is Orientation.NONE else f" and {np.rad2deg(r):.2g}°")
        for k, s, r in zip(found.samples[:_LISTED], shortfall, turn, strict=False)
    )
    more = f" and {m - _LISTED} more" if m > _LISTED else ""
    raise UnreachablePathError(
        f"{m} of {len(path)} samples cannot be reached by arm {arm.name!r} inside its range of motion: "
        f'sample {listed}{more}. Use tracking="soft" for the nearest continuous motion, or check units, '
        f"shoulder position, segment lengths (reach {arm.reach:.3g} m) and range of motion.",
        found.samples,
        shortfall,
        turn,
    )
