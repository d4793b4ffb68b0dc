"""How far the hand is from the path, computed from the joint angles alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]


def tracking_errors(
    arm: Arm, q: Array, position: Array, rotation: Array | None, orientation: Orientation
) -> tuple[Array, Array]:
    """Distance and turn between hand and path, sample by sample.

    |p(q) - p*|, and the angle of R*ᵀ R(q) (full) or between the pointing axes (pointing); the angle is
    2·asin of half the chord, which keeps its digits near zero. Uses a plain product of transforms in
    NumPy, no code of any solver.

    Args:
        arm: The arm.
        q: Joint angles, shape (n, dof), in [rad].
        position: Positions of the path, shape (n, 3), in [m].
        rotation: Rotations of the path, shape (n, 3, 3), or None.
        orientation: What of the path is tracked.

    Returns:
        Position error, shape (n,), in [m], and rotation error, shape (n,), in [rad]; zeros where
        nothing of the orientation is tracked.

    Source:
        None (chordal distance of rotations).
    """
    p, R = hand_pose(arm.chain, q, arm.lengths)
    distance = np.linalg.norm(p - position, axis=1)
    if rotation is None or orientation is Orientation.NONE:
        return distance, np.zeros(len(q))
    if orientation is Orientation.POINTING:
        chord = np.linalg.norm((R - rotation) @ arm.pointing_axis, axis=1)
        return distance, 2 * np.arcsin(np.clip(chord / 2, 0, 1))
    chord = np.linalg.norm(R - rotation, axis=(1, 2)) / np.sqrt(2.0)
    return distance, 2 * np.arcsin(np.clip(chord / 2, 0, 1))
