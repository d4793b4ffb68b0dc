"""The twist from the hand to a sample: what a damped least-squares step has to undo."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.rotation_vector import rotation_vector
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]


class SampleError:
    """Error twists of an arm along a path: [p* - p; rotation vector from R to R*].

    Rotation errors count in the unit of length `radian_length`, so that both parts weigh alike.

    Args:
        arm: The arm.
        path: The hand path.
        orientation: What of it is tracked.

    Source:
        Siciliano et al., Robotics (2009), §3.7.
    """

    radian_length = 0.3

    def __init__(self, arm: Arm, path: HandPath, orientation: Orientation) -> None:
        self._position = path.position
        self._rotation = None if orientation is Orientation.NONE else path.rotation
        self._axis = arm.pointing_axis if orientation is Orientation.POINTING else None

    def __call__(self, k: int, p: Array, R: Array, J: Array) -> tuple[Array, Array]:
        """Error twist of sample k and the Jacobian rows that change it.

        Args:
            k: Index of the sample.
            p: Position of the hand, shape (3,), in [m].
            R: Rotation of the hand, shape (3, 3).
            J: Geometric Jacobian, shape (6, dof).

        Returns:
            Error, shape (3,) or (6,), in [m], and rows, shape (3 or 6, dof).

        Source:
            Siciliano et al., Robotics (2009), §3.7.
        """
        shift = self._position[k] - p
        if self._rotation is None:
            return shift, J[:3]
        rows = self.radian_length * J[3:]
        if self._axis is None:
            turn = rotation_vector(self._rotation[k] @ R.T)
        else:
            fingers, wanted = R @ self._axis, self._rotation[k] @ self._axis
            turn = _turn_between(fingers, wanted)
            rows = rows - np.outer(fingers, fingers @ rows)
        return np.concatenate([shift, self.radian_length * turn]), np.vstack([J[:3], rows])


def _turn_between(start: Array, end: Array) -> Array:
    across = np.cross(start, end)
    sine, cosine = float(np.linalg.norm(across)), float(start @ end)
    if sine > 1e-9:
        return np.asarray(across * (math.atan2(sine, cosine) / sine))
    if cosine > 0:
        return np.asarray(across)
    normal = np.cross(start, np.eye(3)[int(np.argmin(np.abs(start)))])
    return np.asarray(math.pi * normal / np.linalg.norm(normal))
