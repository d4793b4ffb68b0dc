"""Representations of a rotation matrix as CasADi expressions."""

from __future__ import annotations

import casadi as ca


def roll_pitch_yaw(R: ca.SX) -> ca.SX:
    """Roll, pitch, yaw with R = Rz(yaw) Ry(pitch) Rx(roll).

    roll = atan2(r32, r33), pitch = atan2(-r31, √(r32² + r33²)), yaw = atan2(r21, r11).
    Singular at pitch = ±90°.

    Args:
        R: Rotation matrix, SX of shape (3, 3).

    Returns:
        SX of shape (3, 1), in [rad].

    Source:
        Siciliano et al., Robotics (2009), §2.4.2.
    """
    return ca.vertcat(
        ca.atan2(R[2, 1], R[2, 2]),
        ca.atan2(-R[2, 0], ca.sqrt(R[2, 1] ** 2 + R[2, 2] ** 2)),
        ca.atan2(R[1, 0], R[0, 0]),
    )


def quaternion(R: ca.SX) -> ca.SX:
    """Unit quaternion (w, x, y, z) with w ≥ 0 of a rotation by less than 180°.

    w = ½√(1 + tr R), (x, y, z) = vee(R - Rᵀ) / 4w. Singular at 180°, where w = 0.

    Args:
        R: Rotation matrix, SX of shape (3, 3).

    Returns:
        SX of shape (4, 1).

    Source:
        Siciliano et al., Robotics (2009), eq. 2.34.
    """
    w = 0.5 * ca.sqrt(1 + ca.trace(R))
    return ca.vertcat(w, vee_of_difference(R) / (4 * w))


def vee_of_difference(E: ca.SX) -> ca.SX:
    """The vector of the skew part: vee(E - Eᵀ) = 2 sin θ · axis for a rotation E by θ.

    Args:
        E: Matrix, SX of shape (3, 3).

    Returns:
        (e32 - e23, e13 - e31, e21 - e12), SX of shape (3, 1).

    Source:
        Al-Faiz, eq. 53 prints these differences with other signs and order (ledger: alfaiz 53).
    """
    return ca.vertcat(E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1])
