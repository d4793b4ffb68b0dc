"""What the angles over the swivel angle need to know of every sample, as one row of numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import TURN
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.one_curve.stage import BRANCH, OFFSET, PARTS, REFERENCE, SIZE

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def curve_parameters(intervals: FeasibleIntervals, sample: Indices, branch: Indices, q: Array) -> Array:
    """Rows of parameters for samples on given branches.

    Args:
        intervals: The feasible intervals, with their curves.
        sample: Samples, shape (m,).
        branch: Branch of each, shape (m,).
        q: A posture on each curve or near it, shape (m, dof), in [rad]: decides among angles 2π apart where
            the range of motion does not.

    Returns:
        Shape (m, SIZE).

    Source:
        None (bookkeeping).
    """
    spherical = intervals.curves[0].spherical
    rom, wrist = spherical.arm.rom, spherical.wrist
    signs = intervals.branches[branch]
    rows = np.zeros((len(sample), SIZE))
    parts = rows[:, slice(*PARTS)]
    elbow = np.empty(len(sample))
    for curve, side in zip(intervals.curves, (1, -1), strict=True):
        chosen = np.flatnonzero(signs[:, 0] == side)
        parts[chosen] = curve.parts[sample[chosen]].reshape(len(chosen), PARTS[1])
        elbow[chosen] = curve.elbow[sample[chosen]]
    rows[:, slice(*BRANCH)] = signs[:, 1:]
    rows[:, slice(*OFFSET)] = spherical.shoulder.offset, wrist.offset if wrist else 0.0
    # Where intervals are cut at the limits of a range of one turn, that range tells angles 2π apart as well.
    reference = np.where(rom.width > TURN + 1e-9, q, rom.middle)
    reference[:, 3] = elbow + TURN * np.rint((np.clip(q[:, 3], rom.lower[3], rom.upper[3]) - elbow) / TURN)
    rows[:, slice(*REFERENCE)] = reference
    return rows


def wide_joints(intervals: FeasibleIntervals) -> NDArray[np.bool_]:
    """Joints whose range of motion is a full turn or more, so that it does not tell angles 2π apart.

    Args:
        intervals: The feasible intervals.

    Returns:
        Shape (dof,).

    Source:
        None (definition).
    """
    rom = intervals.curves[0].spherical.arm.rom
    return np.asarray(rom.width >= TURN - 1e-9)
