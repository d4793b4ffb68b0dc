"""Refusing rate limits that no swivel angle can keep: the path alone decides the elbow's angle."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.display_units import joint_unit
from armik_sym.arm.model import Arm
from armik_sym.errors import LimitError
from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.global_path.elbow_change import ELBOW, elbow_angles

Array = NDArray[np.float64]

# Limits that are missed by less than this share are left to the solver.
_ROUNDING = 1e-9


def check_elbow_rates(
    arm: Arm, path: HandPath, intervals: FeasibleIntervals, max_speed: Array, max_acceleration: Array
) -> None:
    """Refuse a path that makes the elbow faster than allowed, whatever else the arm does.

    The distance from shoulder to wrist gives the elbow's angle up to its side; of all sequences of sides that
    have a posture, the slowest counts.

    Args:
        arm: The arm.
        path: The hand path.
        intervals: The feasible intervals.
        max_speed: Speed limits, shape (dof,), in [rad/s].
        max_acceleration: Acceleration limits, shape (dof,), in [rad/s²].

    Raises:
        LimitError: If the elbow would have to break a limit; names it, the sample and the rate.

    Source:
        None (this package).
    """
    if arm.rom.width[ELBOW] >= TURN:
        return  # which of the angles a turn apart is taken is up to the solver
    theta = elbow_angles(intervals)
    pairs = intervals.empty.shape[1] // 2
    theta[0, intervals.empty[:, :pairs].all(axis=1)] = np.nan
    theta[1, intervals.empty[:, pairs:].all(axis=1)] = np.nan
    h = np.diff(path.time)
    _refuse(arm, "max_speed", _least(theta, [-1 / h, 1 / h]), float(max_speed[ELBOW]), "/s")
    if len(path) >= 3:
        share = 0.5 * (h[:-1] + h[1:])
        factors = [1 / (h[:-1] * share), -(1 / h[:-1] + 1 / h[1:]) / share, 1 / (h[1:] * share)]
        _refuse(arm, "max_acceleration", _least(theta, factors), float(max_acceleration[ELBOW]), "/s²")


def _least(theta: Array, factors: list[Array]) -> Array:
    """Smallest |Σ_i factor_i·θ_{k+i}| over the sides of neighbouring samples, which may differ."""
    count, rows = len(factors), len(factors[0])
    every = np.zeros((2**count, rows))
    for row, sides in zip(every, itertools.product((0, 1), repeat=count), strict=True):
        for i, side in enumerate(sides):
            row += factors[i] * theta[side, i : rows + i]
    return np.asarray(np.fmin.reduce(np.abs(every), axis=0))


def _refuse(arm: Arm, limit: str, least: Array, allowed: float, per: str) -> None:
    if not least.size or not np.nanmax(least) > allowed * (1 + _ROUNDING):
        return
    k, unit = int(np.nanargmax(least)), joint_unit(arm, ELBOW)
    raise LimitError(
        f"the path moves {arm.joint_names[ELBOW]} at {unit.text(least[k], 4, per)} after sample {k}, "
        f"whatever the other joints do, but {limit} allows {unit.text(allowed, 4, per)}: raise {limit}, slow "
        'the path down, or use tracking="soft"'
    )
