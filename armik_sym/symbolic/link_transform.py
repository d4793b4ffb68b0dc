"""One DH row as a CasADi expression."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from armik_sym.arm.dh import DHConvention, DHLink, JointType
from armik_sym.arm.exact_angle import cos_sin, quarter_turns


def link_transform(
    link: DHLink, convention: DHConvention, q: ca.SX, lengths: Mapping[str, ca.SX | float]
) -> ca.SX:
    """Transform of one DH row.

    Standard: T = Rz(θ) Tz(d) Tx(a) Rx(α). Modified: T = Rx(α) Tx(a) Rz(θ) Tz(d).
    With θ = theta + sign·q (revolute) or d = d + sign·q (prismatic).

    Args:
        link: The row.
        convention: Standard or modified.
        q: Joint variable, scalar SX, in [rad] or [m]; ignored by a fixed row.
        lengths: Segment lengths by name, SX or number, in [m].

    Returns:
        Homogeneous transform, SX of shape (4, 4), in [m].

    Source:
        Nguyen 2021, eq. 1 (standard rows, corrected); Al-Faiz, eq. 2 (modified rows).
    """
    c, s = joint_cos_sin(link, q)
    c_alpha, s_alpha = cos_sin(link.alpha)
    d = lengths[link.d] if isinstance(link.d, str) else link.d
    a = lengths[link.a] if isinstance(link.a, str) else link.a
    if link.joint is JointType.PRISMATIC:
        d = d + link.sign * q
    if convention is DHConvention.STANDARD:
        rows = [
            [c, -s * c_alpha, s * s_alpha, a * c],
            [s, c * c_alpha, -c * s_alpha, a * s],
            [0, s_alpha, c_alpha, d],
        ]
    else:
        rows = [
            [c, -s, 0, a],
            [s * c_alpha, c * c_alpha, -s_alpha, -d * s_alpha],
            [s * s_alpha, c * s_alpha, c_alpha, d * c_alpha],
        ]
    return ca.vertcat(*[ca.horzcat(*row) for row in rows], ca.horzcat(0, 0, 0, 1))


def joint_cos_sin(link: DHLink, q: ca.SX) -> tuple[ca.SX | float, ca.SX | float]:
    """Cosine and sine of a row's angle θ = theta + sign·q, with right-angle offsets taken out.

    cos(±q + k·π/2) is ±cos q or ±sin q: all rows then share the same two calls per joint, and no
    rounding of π/2 enters.

    Args:
        link: The row.
        q: Joint variable, scalar SX, in [rad].

    Returns:
        cos θ and sin θ.

    Source:
        None (angle addition).
    """
    if link.joint is not JointType.REVOLUTE:
        return cos_sin(link.theta)
    if quarter_turns(link.theta) is None:
        theta = link.theta + link.sign * q
        return ca.cos(theta), ca.sin(theta)
    c_k, s_k = cos_sin(link.theta)
    c, s = ca.cos(q), link.sign * ca.sin(q)
    return c * c_k - s * s_k, s * c_k + c * s_k
