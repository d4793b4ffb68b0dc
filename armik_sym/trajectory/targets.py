"""The path's samples in the form the tracking equations take."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.motion.hand_path import HandPath
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]


def stage_targets(arm: Arm, path: HandPath, orientation: Orientation) -> Array:
    """One target vector per sample, as `symbolic.tracking_residual` reads it.

    Full: [p*, R* row by row]. Pointing: [p*, d, b1, b2] with d = R*·pointing_axis and two normals.

    Args:
        arm: The arm.
        path: The hand path.
        orientation: What of it is tracked.

    Returns:
        Shape (n, orientation.target_size); positions in [m].

    Source:
        None (bookkeeping).
    """
    if orientation is Orientation.NONE or path.rotation is None:
        return np.array(path.position)
    if orientation is Orientation.FULL:
        return np.hstack([path.position, path.rotation.reshape(-1, 9)])
    direction = path.rotation @ arm.pointing_axis
    b1, b2 = normals(direction)
    return np.hstack([path.position, direction, b1, b2])


def normals(direction: Array) -> tuple[Array, Array]:
    """Two unit vectors normal to each direction and to each other.

    b1 = e × d / |e × d| with the axis e least aligned with d, b2 = d × b1.

    Args:
        direction: Unit vectors, shape (n, 3).

    Returns:
        b1 and b2, shape (n, 3) each.

    Source:
        None (elementary).
    """
    helper = np.eye(3)[np.argmin(np.abs(direction), axis=1)]
    b1 = np.cross(helper, direction)
    b1 /= np.linalg.norm(b1, axis=1, keepdims=True)
    return b1, np.cross(direction, b1)
