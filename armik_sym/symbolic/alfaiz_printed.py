"""The inverse kinematics of Al-Faiz as printed, for repeating the paper's numbers only.

Plain arc tangents lose the quadrant, and r of eq. (21) takes a sign: for three hand orientations in four
the posture misses the target. See the ledger of equations for what is wrong where.
"""

from __future__ import annotations

import casadi as ca

from armik_sym.symbolic.alfaiz_closed_form import upper_rotation
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.symbolic.row_order import row_major


def printed_posture(position: ca.SX, rotation: ca.SX, lengths: ca.SX, phi: ca.SX) -> ca.SX:
    """All seven angles for a given φ by the printed equations; NaN where they have no value.

    Eq. (5) is taken with tg² and a plus sign: as printed it contradicts (6), which is right.

    Args:
        position: Position of the hand, SX of shape (3, 1), in [m].
        rotation: Rotation of the hand, SX of shape (3, 3).
        lengths: l4 (upper arm) and l3 (forearm), SX of shape (2, 1), in [m].
        phi: φ, in [rad].

    Returns:
        Joint angles, SX of shape (7, 1), in [rad].

    Source:
        Al-Faiz, eq. 6, 20-22, 26-35, 36-47.
    """
    l4, l3 = lengths[0], lengths[1]
    dx, dy, dz = ca.vertsplit(position)
    theta4 = ca.acos((ca.sumsqr(position) - l4**2 - l3**2) / (2 * l4 * l3))
    theta1 = ca.if_else(dz == 0, -ca.pi / 2, ca.atan(-dx / dz)) - phi
    r = -dx / ca.sin(theta1 + phi)
    theta3 = ca.asin(r * ca.cos(phi) / (l3 * ca.cos(theta4) + l4))
    k2, k3, k4 = (
        r * ca.sin(phi),
        l3 * ca.cos(theta4) * ca.cos(theta3) + l4 * ca.cos(theta3),
        l3 * ca.sin(theta4),
    )
    k5, k6 = (k3 * k2 + k4 * dy) / (k3**2 + k4**2), (k4 * k2 - k3 * dy) / (k3**2 + k4**2)
    theta2 = _arc_tangent(k5, k6)
    R = upper_rotation(ca.vertcat(theta1, theta2, theta3), theta4).T @ rotation
    theta5, theta6 = _arc_tangent(-R[2, 2], R[0, 2]), ca.asin(R[1, 2])
    return ca.vertcat(theta1, theta2, theta3, theta4, theta5, theta6, _arc_tangent(-R[1, 1], R[1, 0]))


def printed_function() -> ca.Function:
    """The printed closed form as a CasADi Function.

    `alfaiz_printed` (pose 12, lengths 2, phi 1) → 7: `printed_posture`.

    Returns:
        The Function.

    Source:
        Al-Faiz, eq. 6-47.
    """
    pose, lengths, phi = ca.SX.sym("pose", 12), ca.SX.sym("lengths", 2), ca.SX.sym("phi")
    q = printed_posture(pose[:3], row_major(pose[3:]), lengths, phi)
    return dense_function("alfaiz_printed", {"pose": pose, "lengths": lengths, "phi": phi}, q)


def _arc_tangent(numerator: ca.SX, denominator: ca.SX) -> ca.SX:
    """The pattern of eq. (35), (44) and (47)."""
    return ca.if_else(denominator == 0, ca.pi / 2, ca.atan(numerator / denominator))
