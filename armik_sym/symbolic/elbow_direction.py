"""Elbow-direction matrices of device and human arm, and the angle conversion between them.

Both shoulders are spherical, but the E-HMCS abducts first and flexes second, the human arm the other way
round. H = diag(-1, 1, -1) is the half turn about y by which the zero of the human angles q' differs from
that of the device, in the base and in the arm: eq. (8) is the solution of H R_0^3(q) H = C_3(q').
"""

from __future__ import annotations

import functools

import casadi as ca
import numpy as np

from armik_sym.arm.catalog import ehmcs, human
from armik_sym.symbolic.arm_expressions import express

# Below this sine of the middle angle, rounding alone decides the first angle: only the sum or difference of
# the first and third is known.
SINGULAR = 1e-13

_HALF_TURN_ABOUT_Y = ca.DM(np.diag([-1.0, 1.0, -1.0]))


def device_elbow_direction(q: ca.SX) -> ca.SX:
    """Matrix B of the E-HMCS: rotation of frame 3, B = R_0^3(q).

    Args:
        q: Device angles q1, q2, q3, SX of shape (3, 1), in [rad].

    Returns:
        Rotation matrix, SX of shape (3, 3); its second column points from the elbow to the shoulder.

    Source:
        Nguyen 2021, eq. 4-5 (ledger: nguyen2021 4-5; the sign of B12 is misprinted).
    """
    return _device_frame_3()(ca.vertcat(q, ca.DM.zeros(4)))


def human_elbow_direction(q_human: ca.SX) -> ca.SX:
    """Matrix C of the human arm: C = Ry(-q'1) Rz(-q'2) Ry(-q'3).

    With flexion = -q'1, abduction = q'2 + 90° and internal rotation = q'3 - 90° of the catalogue's human
    arm, C = H R_0^3 H, H = diag(-1, 1, -1).

    Args:
        q_human: Human angles q'1, q'2, q'3, SX of shape (3, 1), in [rad].

    Returns:
        Rotation matrix, SX of shape (3, 3).

    Source:
        Nguyen 2021, eq. 6-7 (ledger: nguyen2021 6-7).
    """
    R = _human_frame_3()(ca.vertcat(shoulder_angles(q_human), ca.DM.zeros(4)))
    return _turned(R)


def shoulder_angles(q_human: ca.SX) -> ca.SX:
    """Anatomical angles of q': flexion = -q'1, abduction = q'2 + 90°, internal rotation = q'3 - 90°.

    Args:
        q_human: Human angles q', shape (3, n), in [rad]; SX or DM.

    Returns:
        Flexion, abduction and internal rotation as `catalog.human` counts them, shape (3, n), in [rad].

    Source:
        Nguyen 2021, eq. 6-8 (ledger: nguyen2021 6-7).
    """
    right_angle = np.pi / 2
    return ca.vertcat(-q_human[0, :], q_human[1, :] + right_angle, q_human[2, :] - right_angle)


def device_to_human(q: ca.SX, first_if_singular: ca.SX) -> ca.SX:
    """Human angles q' with C(q') = H B(q) H, the branch -180° ≤ q'2 ≤ 0 of eq. (8).

    q'1 = atan2(B32, B12), q'2 = -acos(B22), q'3 = atan2(B23, -B21); the last from rows turned back by q'1,
    so that rounding in q'1 never spoils the matrix.

    Args:
        q: Device angles, SX of shape (3, 1), in [rad].
        first_if_singular: q'1 to take where the upper arm lies along y and only q'1 ± q'3 is determined, in
            [rad].

    Returns:
        SX of shape (4, 1): q'1, q'2, q'3 in [rad], and |sin q'2|, 0 where singular.

    Source:
        Nguyen 2021, eq. 8 (ledger: nguyen2021 8), simplified.
    """
    C = _turned(device_elbow_direction(q))
    sine = _hypot(C[0, 1], C[2, 1])
    p1 = ca.if_else(sine < SINGULAR, first_if_singular, ca.atan2(-C[2, 1], -C[0, 1]))
    p2 = -ca.atan2(sine, C[1, 1])
    c, s = ca.cos(p1), ca.sin(p1)
    p3 = ca.atan2(C[2, 0] * c - C[0, 0] * s, C[2, 2] * c - C[0, 2] * s)
    return ca.vertcat(p1, p2, p3, sine)


def human_to_device(q_human: ca.SX, first_if_singular: ca.SX) -> ca.SX:
    """Device angles q with B(q) = H C(q') H, the branch -90° ≤ q2 ≤ 90°.

    q1 = atan2(B22, B12), q2 = atan2(-B32, √(B12² + B22²)), q3 from the rows turned back by q1.

    Args:
        q_human: Human angles q', SX of shape (3, 1), in [rad].
        first_if_singular: q1 to take where the upper arm lies along the base axis x and only q1 ± q3 is
            determined, in [rad].

    Returns:
        SX of shape (4, 1): q1, q2, q3 in [rad], and cos q2, 0 where singular.

    Source:
        Nguyen 2021, eq. 5-8 inverted (ledger: nguyen2021 8).
    """
    B = _turned(human_elbow_direction(q_human))
    cosine = _hypot(B[0, 1], B[1, 1])
    q1 = ca.if_else(cosine < SINGULAR, first_if_singular, ca.atan2(B[1, 1], B[0, 1]))
    q2 = ca.atan2(-B[2, 1], cosine)
    c, s = ca.cos(q1), ca.sin(q1)
    q3 = ca.atan2(B[1, 0] * c - B[0, 0] * s, B[1, 2] * c - B[0, 2] * s)
    return ca.vertcat(q1, q2, q3, cosine)


def _turned(R: ca.SX) -> ca.SX:
    """The same rotation seen from frames that are turned by half a turn about y: H R H."""
    return _HALF_TURN_ABOUT_Y @ R @ _HALF_TURN_ABOUT_Y


def _hypot(a: ca.SX, b: ca.SX) -> ca.SX:
    return ca.sqrt(a * a + b * b)


@functools.cache
def _device_frame_3() -> ca.Function:
    expressions = express(ehmcs(), lengths="baked")
    return ca.Function("R_0_3", [expressions.q], [expressions.frames[3][:3, :3]])


@functools.cache
def _human_frame_3() -> ca.Function:
    expressions = express(human(), lengths="baked")
    return ca.Function("R_0_3", [expressions.q], [expressions.frames[3][:3, :3]])
