"""The geometric Jacobian from the joint axes, without differentiation."""

from __future__ import annotations

from collections.abc import Sequence

import casadi as ca

from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHConvention, JointType


def geometric_jacobian(chain: DHChain, frames: Sequence[ca.SX], T_base_hand: ca.SX) -> ca.SX:
    """Geometric Jacobian of the hand in the base frame: [v; ω] = J q̇.

    Revolute column: [z × (p_hand - p); z]·sign. Prismatic column: [z; 0]·sign. z and p belong to the
    frame the joint turns about: the one before the row (standard) or after it (modified).

    Args:
        chain: The DH chain.
        frames: T_base_i for the base and after every row, SX of shape (4, 4) each.
        T_base_hand: Pose of the hand, SX of shape (4, 4).

    Returns:
        SX of shape (6, dof); upper rows in [m/rad], lower rows in [1].

    Source:
        Siciliano et al., Robotics (2009), eq. 3.30.
    """
    p_hand = T_base_hand[:3, 3]
    columns = []
    for i, link in enumerate(chain.links):
        if not link.moves:
            continue
        frame = frames[i] if chain.convention is DHConvention.STANDARD else frames[i + 1]
        z = link.sign * frame[:3, 2]
        if link.joint is JointType.REVOLUTE:
            columns.append(ca.vertcat(ca.cross(z, p_hand - frame[:3, 3]), z))
        else:
            columns.append(ca.vertcat(z, ca.SX.zeros(3)))
    return ca.horzcat(*columns)
