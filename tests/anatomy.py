"""Directions and points of a left arm, and how they move with a joint."""

from __future__ import annotations

import numpy as np

from armik_sym.arm.product_of_transforms import joint_frames

UP, FORWARD, MEDIAL = np.array([1.0, 0, 0]), np.array([0, 0, 1.0]), np.array([0, 1.0, 0])
ELBOW, WRIST, HAND = 3, 5, -1  # frames whose origins are these points
FINGERS, RADIAL, DORSAL = np.array([1.0, 0, 0]), np.array([0, -1.0, 0]), np.array([0, 0, 1.0])


def frames(arm, **degrees):
    q = np.zeros(arm.dof)
    for joint, angle in degrees.items():
        q[arm.joint_index(joint)] = np.deg2rad(angle)
    return joint_frames(arm.chain, q[None], arm.lengths)[0]


def movement(arm, joint, of, posture):
    """Direction in which a point moves, or a vector of a frame turns, when one joint increases."""
    more = {**posture, joint: posture.get(joint, 0) + 1e-3}
    step = of(frames(arm, **more)) - of(frames(arm, **posture))
    return step / np.linalg.norm(step)


def origin(frame):
    return lambda T: T[frame][:3, 3]


def axis_of_hand(axis):
    return lambda T: T[HAND][:3, :3] @ axis
