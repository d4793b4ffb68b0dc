"""Rigid-body dynamics of a chain: torques from motion, and inertia from posture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import DHConvention
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.errors import DriveError
from armik_sym.servo.body import RigidBody

Array = NDArray[np.float64]

GRAVITY = 9.80665


def gravity_of(arm: Arm) -> Array:
    """Gravity in the base frame of an arm: -g up.

    Args:
        arm: The arm; it must say where up is.

    Returns:
        Shape (3,), in [m/s²].

    Raises:
        DriveError: If the arm does not say where up is.

    Source:
        Standard gravity, ISO 80000-3.
    """
    if arm.up is None:
        raise DriveError(
            f"arm {arm.name!r} does not say where up is, so gravity has no direction: give `up` in its file"
        )
    return -GRAVITY * np.asarray(arm.up, dtype=np.float64)


def inverse_dynamics(
    arm: Arm, bodies: Sequence[RigidBody], q: Array, speed: Array, acceleration: Array, gravity: Array
) -> Array:
    """Joint torques that make bodies move as given: τ = M(q) q̈ + c(q, q̇) + g(q), for turning joints.

    τ_j = z_j · Σ_b [ (p_b - o_j) × m_b (a_b - g) + I_b α_b + ω_b × I_b ω_b ], summed over what lies beyond
    joint j.

    Args:
        arm: The arm.
        bodies: What has mass.
        q: Joint angles, shape (n, dof), in [rad].
        speed: Their speeds, shape (n, dof), in [rad/s].
        acceleration: Their accelerations, shape (n, dof), in [rad/s²].
        gravity: In the base frame, shape (3,), in [m/s²].

    Returns:
        Shape (n, dof), in [Nm].

    Source:
        Luh, Walker & Paul 1980 (recursive Newton-Euler); Siciliano et al. 2009, §7.5.
    """
    frames = joint_frames(arm.chain, q, arm.lengths)
    n, rows = len(q), len(arm.chain.links)
    omega, alpha = np.zeros((n, 3)), np.zeros((n, 3))
    origin_acceleration = np.zeros((n, 3))
    torque = np.zeros((n, arm.dof))
    axes: list[tuple[Array, Array]] = []
    column = 0
    for i in range(rows + 2):
        if 1 <= i <= rows:
            link = arm.chain.links[i - 1]
            if link.moves:
                axis_frame = i if arm.chain.convention is DHConvention.MODIFIED else i - 1
                z, o = link.sign * frames[:, axis_frame, :3, 2], frames[:, axis_frame, :3, 3]
                arm_ = o - frames[:, i - 1, :3, 3]
                at_axis = origin_acceleration + _carried(omega, alpha, arm_)
                turned = speed[:, column, None] * z
                alpha = alpha + acceleration[:, column, None] * z + np.cross(omega, turned)
                omega = omega + turned
                origin_acceleration = at_axis + _carried(omega, alpha, frames[:, i, :3, 3] - o)
                axes.append((z, o))
                column += 1
            else:
                step = frames[:, i, :3, 3] - frames[:, i - 1, :3, 3]
                origin_acceleration = origin_acceleration + _carried(omega, alpha, step)
        elif i == rows + 1:
            step = frames[:, i, :3, 3] - frames[:, i - 1, :3, 3]
            origin_acceleration = origin_acceleration + _carried(omega, alpha, step)
        for body in bodies:
            if body.frame == i:
                _add(torque, axes, body, frames[:, i], omega, alpha, origin_acceleration - gravity)
    return torque


def _carried(omega: Array, alpha: Array, way: Array) -> Array:
    """Acceleration of a point of a turning body relative to another: α × r + ω × (ω × r)."""
    return np.asarray(np.cross(alpha, way) + np.cross(omega, np.cross(omega, way)))


def _add(
    torque: Array,
    axes: list[tuple[Array, Array]],
    body: RigidBody,
    T: Array,
    omega: Array,
    alpha: Array,
    a: Array,
) -> None:
    """Add what one body asks of the joints before it."""
    R = T[:, :3, :3]
    way = R @ body.centre
    force = body.mass * (a + _carried(omega, alpha, way))
    inertia = R @ body.inertia @ R.transpose(0, 2, 1)
    spin = (inertia @ omega[:, :, None])[:, :, 0]
    moment = (inertia @ alpha[:, :, None])[:, :, 0] + np.cross(omega, spin)
    place = T[:, :3, 3] + way
    for j, (z, o) in enumerate(axes):
        torque[:, j] += np.einsum("ni,ni->n", z, np.cross(place - o, force) + moment)


def gravity_torque(arm: Arm, bodies: Sequence[RigidBody], q: Array, gravity: Array) -> Array:
    """Torques that hold bodies still: g(q).

    Args:
        arm: The arm.
        bodies: What has mass.
        q: Joint angles, shape (n, dof), in [rad].
        gravity: In the base frame, shape (3,), in [m/s²].

    Returns:
        Shape (n, dof), in [Nm].

    Source:
        Siciliano et al. 2009, §7.2.
    """
    still = np.zeros_like(q)
    return inverse_dynamics(arm, bodies, q, still, still, gravity)


def joint_inertia(arm: Arm, bodies: Sequence[RigidBody], q: Array) -> Array:
    """Inertia of all bodies about each joint, the others held: the diagonal of M(q).

    Args:
        arm: The arm.
        bodies: What has mass.
        q: Joint angles, shape (n, dof), in [rad].

    Returns:
        Shape (n, dof), in [kg m²].

    Source:
        Siciliano et al. 2009, §7.2.
    """
    return np.stack([column[:, j] for j, column in enumerate(_columns(arm, bodies, q))], axis=1)


def mass_matrix(arm: Arm, bodies: Sequence[RigidBody], q: Array) -> Array:
    """Inertia matrix M(q), column by column from unit accelerations.

    Args:
        arm: The arm.
        bodies: What has mass.
        q: Joint angles, shape (n, dof), in [rad].

    Returns:
        Shape (n, dof, dof), in [kg m²].

    Source:
        Walker & Orin 1982, method 1.
    """
    return np.stack(_columns(arm, bodies, q), axis=2)


def _columns(arm: Arm, bodies: Sequence[RigidBody], q: Array) -> list[Array]:
    still, none = np.zeros_like(q), np.zeros(3)
    unit = np.eye(arm.dof)
    return [
        inverse_dynamics(arm, bodies, q, still, np.broadcast_to(unit[j], q.shape), none)
        for j in range(arm.dof)
    ]
