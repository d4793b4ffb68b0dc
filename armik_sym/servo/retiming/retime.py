"""Re-timing: as fast as limits allow, never slower than slowing the whole motion."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from armik_sym.arm.rate_limit import rate_limit
from armik_sym.errors import OptionError, RetimingError, UnknownNameError
from armik_sym.servo.dynamics import mass_matrix
from armik_sym.servo.reference import Solved, check_motion
from armik_sym.servo.retiming.cells import make_cells, steepest
from armik_sym.servo.retiming.retimed import Retimed
from armik_sym.servo.retiming.two_pass import fastest
from armik_sym.servo.setup import Setup
from armik_sym.servo.spline import path_spline

Array = NDArray[np.float64]

ENDS = ("uniform", "rest")
# Where nothing moves, nothing limits ṡ; so much faster than the original (squared) it may be.
_UNLIMITED = 1e6
_POSTURES = 200
# What a solution says about its times: cost and bound are integrals over time, alternatives have the old one.
_OF_THE_OLD_TIME: dict[str, Any] = {"cost": None, "bound": None, "alternatives": ()}


def retime(
    solution: Solved,
    speed: float | ArrayLike | None = None,
    acceleration: float | ArrayLike | None = None,
    *,
    ends: str = "uniform",
    faster: bool = False,
) -> Retimed:
    """Go along the path of a motion as fast as limits allow: |q' ṡ| ≤ v, |q'' ṡ² + q' s̈| ≤ a everywhere.

    Limits hold between the samples too, on the natural cubic spline through them. With `ends="uniform"` the
    result is never slower than slowing the whole motion by the smallest factor that keeps the limits.

    Args:
        solution: The motion.
        speed: Joint speed limit, one number or one per joint, in [rad/s]; None for none.
        acceleration: Joint acceleration limit, one number or one per joint, in [rad/s²]; None for none.
        ends: "uniform": it begins and ends with the speeds of the motion slowed uniformly; "rest": at rest.
        faster: Whether it may be faster than the original anywhere.

    Returns:
        The re-timed motion; check it again.

    Raises:
        RetimingError: If a limit is missing, or the samples do not move.
        LimitError: If a limit is not positive.
        UnknownNameError: If `ends` is another word.
        ShapeError: If the motion has fewer than two samples.
        HandPathError: If an angle is not finite.

    Source:
        Bobrow, Dubowsky & Gibson 1985; Pham & Pham 2018 (TOPP-RA); this package (limits inside cells).
    """
    check_motion(solution)
    if ends not in ENDS:
        raise UnknownNameError("ends", ends, ENDS)
    v = rate_limit("speed", speed, solution.arm)
    a = rate_limit("acceleration", acceleration, solution.arm)
    if not (np.isfinite(v).any() or np.isfinite(a).any()):
        raise RetimingError("no limit is given: give speed or acceleration")
    if ends == "rest" and not np.isfinite(a).all():
        raise RetimingError("beginning and ending at rest needs an acceleration limit for every joint")
    spline = path_spline(np.asarray(solution.time) - solution.time[0], solution.q)
    if not np.abs(spline.c[:-1]).max() > 0:
        raise RetimingError("the joints do not move: there is nothing to re-time")
    cells = make_cells(spline, v, a)
    factor = uniform_factor(spline, v, a)
    factor = factor if faster else max(factor, 1.0)
    uniform = factor**-2
    highest = np.minimum(cells.highest, max(_UNLIMITED, uniform) if faster else 1.0)
    cells = dataclasses.replace(cells, highest=highest)
    rest = ends == "rest"
    x, u = fastest(cells, 0.0 if rest else uniform, 0.0 if rest else uniform, 0.0 if rest else uniform)
    return _retimed(solution, spline, cells.s, x, u, (v, a), factor)


def uniform_factor(spline: CubicSpline, speed: Array, acceleration: Array) -> float:
    """Smallest factor by which slowing a motion keeps limits: max(|q̇|/v, √(|q̈|/a)), between samples too.

    Args:
        spline: The motion.
        speed: Limits, shape (dof,), in [rad/s].
        acceleration: Limits, shape (dof,), in [rad/s²].

    Returns:
        The factor; below 1 if the motion may be faster.

    Source:
        Hollerbach 1984.
    """
    knots = np.asarray(spline.x)
    h = np.diff(knots)[:, None]
    first, second = spline(knots, 1)[:-1], spline(knots, 2)
    bend = np.diff(second, axis=0) / (2 * h)
    fast = steepest(first, second[:-1], bend, h).max(axis=0)
    return float(max((fast / speed).max(), np.sqrt((np.abs(second).max(axis=0) / acceleration).max())))


def drive_limits(setup: Setup, q: Array, share: float = 0.9) -> tuple[Array, Array]:
    """Speed and acceleration limits a drive has along postures: a_j = share (peak - holding)_j / Σ_k |M_jk|.

    Args:
        setup: Arm and drives.
        q: Postures, shape (n, dof), in [rad].
        share: Part of the torque to be used.

    Returns:
        Speed limits, in [rad/s], and acceleration limits, in [rad/s²], each of shape (dof,).

    Raises:
        RetimingError: If a drive cannot even hold a posture.
        OptionError: If the share is not between 0 and 1.

    Source:
        This package. It leaves out Coriolis torques, so the result is to be checked.
    """
    if not 0 < share <= 1:
        raise OptionError(f"share is {share!r}, expected above 0, at most 1")
    some = q[:: max(len(q) // _POSTURES, 1)]
    joints = setup.drive.joints
    top = np.array([j.top_speed for j in joints])
    still = np.zeros_like(some)
    holding = np.abs(setup.body_torque(some, still, still)).max(axis=0)
    losses = np.array([j.friction + j.viscous * j.top_speed for j in joints])
    left = np.array([j.peak_torque for j in joints]) - holding - losses
    if not (left > 0).all():
        j = int(np.argmin(left))
        raise RetimingError(
            f"drive of {joints[j].name!r}: has {joints[j].peak_torque:.3g} Nm, holding the arm and friction "
            f"take {holding[j] + losses[j]:.3g} Nm: nothing is left to accelerate with"
        )
    M = np.abs(mass_matrix(setup.arm, setup.bodies, some)).max(axis=0).sum(axis=1)
    return top, share * left / (M + np.array([j.inertia for j in joints]))


def _retimed(
    solution: Solved,
    spline: CubicSpline,
    s: Array,
    x: Array,
    u: Array,
    limits: Sequence[Array],
    factor: float,
) -> Retimed:
    rate = np.sqrt(x)
    law = np.concatenate([[0.0], np.cumsum(2 * np.diff(s) / (rate[1:] + rate[:-1]))])
    time = law[np.searchsorted(s, np.asarray(spline.x))]
    path: Any = getattr(solution, "path", None)
    renewed = None
    if dataclasses.is_dataclass(solution) and dataclasses.is_dataclass(path):
        moved: Any = dataclasses.replace(path, time=time)
        own = {field.name for field in dataclasses.fields(solution)}
        stale = {name: value for name, value in _OF_THE_OLD_TIME.items() if name in own}
        renewed = dataclasses.replace(solution, path=moved, **stale)
    return Retimed(
        solution.arm, time, np.asarray(solution.q), factor, factor * float(s[-1]), limits[0], limits[1],
        renewed, law, s, rate, u, spline,
    )  # fmt: skip
