"""What is drawn of an arm: one point on the axis of every joint, and the hand."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import DHConvention
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.errors import ArmModelError
from armik_sym.swivel.spherical_arm import SphericalArm, recognise
from armik_sym.symbolic import ArmExpressions
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.symbolic.row_order import row_by_row

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DrawnPoints:
    """The points of an arm that are drawn.

    Attributes:
        local: The point of each joint in the frame that the joint turns about z of, shape (dof, 3), in [m].
        landmarks: Index of shoulder, elbow, wrist and hand among the points, as far as the arm has them;
            the hand comes after the joints.
    """

    local: Array
    landmarks: dict[str, int]


def drawn_points(arm: Arm) -> DrawnPoints:
    """Points to be drawn: where the axes of shoulder and wrist meet, the elbow, else origins of frames.

    Args:
        arm: The arm.

    Returns:
        The points.

    Source:
        Siciliano et al., Robotics (2009), §2.8.2 (the frames of a DH chain).
    """
    local, landmarks = np.zeros((arm.dof, 3)), {"hand": arm.dof}
    try:
        spherical = recognise(arm)
    except ArmModelError:
        return DrawnPoints(local, landmarks)
    at_zero = joint_frames(arm.chain, np.zeros((1, arm.dof)), arm.lengths)[0][_frames_of_joints(arm)]
    for j, point in _centres(spherical).items():
        local[j] = at_zero[j, :3, :3].T @ (point - at_zero[j, :3, 3])
    landmarks |= {"shoulder": 0, "elbow": 3} | ({"wrist": 4} if spherical.wrist else {})
    return DrawnPoints(local, landmarks)


def drawn_function(arm: ArmExpressions) -> ca.Function:
    """The points of the joints and the pose of the hand: x_j = T_j(q)·local_j; p(q), R(q).

    Args:
        arm: Symbolic kinematics with segment lengths as parameters.

    Returns:
        Function `drawn` (q, lengths, points 3·dof) → points 3·dof, position 3, rotation 9 row by row.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    dof = arm.arm.dof
    local = ca.SX.sym("points", 3 * dof)
    frames = [arm.frames[i] for i in _frames_of_joints(arm.arm)]
    points = [T[:3, :3] @ local[3 * j : 3 * j + 3] + T[:3, 3] for j, T in enumerate(frames)]
    inputs = {"q": arm.q, "lengths": arm.lengths, "points": local}
    return dense_function("drawn", inputs, ca.vertcat(*points, arm.position, row_by_row(arm.rotation)))


def _frames_of_joints(arm: Arm) -> list[int]:
    """Frames whose z is the axis of each joint: before a standard row, after a modified one."""
    after = arm.chain.convention is DHConvention.MODIFIED
    return [i + after for i, link in enumerate(arm.chain.links) if link.moves]


def _centres(spherical: SphericalArm) -> dict[int, Array]:
    """Points on the axes at q = 0 by joint."""
    centres = dict.fromkeys(range(3), spherical.shoulder.centre) | {3: spherical.elbow}
    if spherical.wrist is not None:
        centres |= dict.fromkeys(range(4, 7), spherical.wrist.centre)
    return centres
