"""Where elbow and wrist are, and how the elbow is turned about the line between shoulder and wrist."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.compiled.backend import Backend
from armik_sym.errors import ShapeError
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.equivalent_angles import without_turns
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import SphericalArm, recognise

Array = NDArray[np.float64]

# Nearer than this to the line shoulder-wrist the elbow points nowhere: noise decides. In [m].
NEAR_LINE = 0.01


def elbow_position(arm: Arm, q: ArrayLike) -> Array:
    """Where the elbow is: the point of the elbow's axis nearest to the shoulder, by forward kinematics.

    Args:
        arm: An arm with spherical shoulder and hinge elbow.
        q: Joint angles, shape (n, dof), in [rad]; rows with NaN give NaN.

    Returns:
        Position in the base frame, shape (n, 3), in [m].

    Raises:
        ArmModelError: If the arm has no spherical shoulder with an elbow after it.
        ShapeError: If `q` does not have shape (n, dof).

    Source:
        Nguyen 2021, eq. 2.
    """
    angles = np.asarray(q, dtype=np.float64)
    if angles.ndim != 2 or angles.shape[1] != arm.dof:
        raise ShapeError(f"q {angles.shape}: expected (n, {arm.dof})")
    at_zero = recognise(arm).elbow
    # The frame that the third joint carries, and the elbow in it.
    moving = [i for i, link in enumerate(arm.chain.links) if link.moves]
    carried = moving[2] + 1
    zero = joint_frames(arm.chain, np.zeros((1, arm.dof)), arm.lengths)[0, carried]
    local = zero[:3, :3].T @ (at_zero - zero[:3, 3])
    frames = joint_frames(arm.chain, angles, arm.lengths)[:, carried]
    return np.asarray(frames[:, :3, :3] @ local + frames[:, :3, 3])


class Swivels(NamedTuple):
    """Swivel angles of two motions of one arm, counted from the same directions.

    Attributes:
        first: Of the first motion, without jumps of a turn, shape (n,), in [rad].
        apart: First minus second, between -π and π, shape (n,), in [rad].
        near_line: Where one of the elbows is so near to the line from shoulder to wrist that its direction
            means nothing; `apart` is NaN there, shape (n,).
    """

    first: Array
    apart: Array
    near_line: NDArray[np.bool_]


def swivels(arm: Arm, first: Array, second: Array, backend: Backend = "auto") -> Swivels:
    """Swivel angles of two motions of one arm.

    Both are counted from one direction, carried along the first motion without turning about the line from
    shoulder to wrist (to the hand, for arms without a spherical wrist), so that it does not matter for the
    difference where zero is.

    Args:
        arm: An arm with spherical shoulder and hinge elbow.
        first: Joint angles, shape (n, dof), in [rad]; rows with NaN give NaN.
        second: Joint angles, likewise.
        backend: "auto", "c" or "vm".

    Returns:
        Angles and their difference.

    Raises:
        ArmModelError: If the arm has no spherical shoulder with an elbow after it.

    Source:
        Definition of the swivel angle (this package).
    """
    spherical = recognise(arm)
    position_only = spherical.wrist is None
    reference = transported_reference(spherical, _to_wrist(spherical, first))
    near = np.zeros(len(first), dtype=np.bool_)
    psi = np.full((2, len(first)), np.nan)
    for i, q in enumerate((first, second)):
        known = np.flatnonzero(np.isfinite(q).all(axis=1))
        at = swivel_of_postures(spherical, q[known], reference[known], position_only, backend)
        psi[i, known] = at.psi
        near[known] |= _off_line(spherical, q[known]) < NEAR_LINE
    apart = without_turns(psi[0] - psi[1])
    known = np.isfinite(psi[0])
    psi[0, known] = np.unwrap(psi[0, known])
    return Swivels(psi[0], np.where(near, np.nan, apart), near)


def _to_wrist(spherical: SphericalArm, q: Array) -> Array:
    """From shoulder to wrist, or to the hand where there is no spherical wrist."""
    position, rotation = hand_pose(spherical.arm.chain, q, spherical.arm.lengths)
    if spherical.wrist is None:
        return np.asarray(position - spherical.shoulder.centre)
    return wrist_directions(spherical, position, rotation)


def _off_line(spherical: SphericalArm, q: Array) -> Array:
    """Distance of the elbow from the line shoulder-wrist, shape (n,), in [m]."""
    along = _to_wrist(spherical, q)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    along = along / np.maximum(length, 1e-12)
    upper_arm = elbow_position(spherical.arm, q) - spherical.shoulder.centre
    return np.asarray(np.linalg.norm(np.cross(along, upper_arm), axis=1))
