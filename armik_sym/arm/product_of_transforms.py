"""Forward kinematics as a plain product of matrices in NumPy.

Deliberately written a second time, from the definition and without CasADi: solutions judge
themselves with it, and the tests hold the symbolic and the compiled kinematics against it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHConvention, DHLink, JointType

Array = NDArray[np.float64]


def _elementary(n: int) -> Array:
    return np.broadcast_to(np.eye(4), (n, 4, 4)).copy()


def _about_z(angle: Array) -> Array:
    T = _elementary(len(angle))
    T[:, 0, 0] = T[:, 1, 1] = np.cos(angle)
    T[:, 1, 0] = np.sin(angle)
    T[:, 0, 1] = -T[:, 1, 0]
    return T


def _about_x(angle: Array) -> Array:
    T = _elementary(len(angle))
    T[:, 1, 1] = T[:, 2, 2] = np.cos(angle)
    T[:, 2, 1] = np.sin(angle)
    T[:, 1, 2] = -T[:, 2, 1]
    return T


def _along(axis: int, shift: Array) -> Array:
    T = _elementary(len(shift))
    T[:, axis, 3] = shift
    return T


def _link_transform(link: DHLink, convention: DHConvention, q: Array, lengths: Mapping[str, float]) -> Array:
    one = np.ones_like(q)
    theta = link.theta + (link.sign * q if link.joint is JointType.REVOLUTE else 0 * q)
    d = lengths[link.d] * one if isinstance(link.d, str) else link.d * one
    if link.joint is JointType.PRISMATIC:
        d = d + link.sign * q
    a = lengths[link.a] * one if isinstance(link.a, str) else link.a * one
    z_part = _about_z(theta) @ _along(2, d)
    x_part = _along(0, a) @ _about_x(link.alpha * one)
    return z_part @ x_part if convention is DHConvention.STANDARD else x_part @ z_part


def joint_frames(chain: DHChain, q: Array, lengths: Mapping[str, float]) -> Array:
    """Every frame of the chain: base, after each row, and the hand.

    T_0 = base, T_i = T_{i-1} · T_i(q_i), T_hand = T_m · tool.

    Args:
        chain: The DH chain with m rows.
        q: Joint angles [rad] (prismatic: [m]), shape (n, dof).
        lengths: Segment lengths by name, in [m].

    Returns:
        Transforms to the base, shape (n, m + 2, 4, 4), in [m].

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    n = len(q)
    T = np.broadcast_to(chain.base, (n, 4, 4))
    frames = [T]
    column = 0
    for link in chain.links:
        q_i = q[:, column] if link.moves else np.zeros(n)
        column += link.moves
        T = T @ _link_transform(link, chain.convention, q_i, lengths)
        frames.append(T)
    frames.append(T @ chain.tool)
    return np.stack(frames, axis=1)


def hand_pose(chain: DHChain, q: Array, lengths: Mapping[str, float]) -> tuple[Array, Array]:
    """Position and rotation of the hand frame.

    T_base_hand = base · Π T_i(q_i) · tool.

    Args:
        chain: The DH chain.
        q: Joint angles [rad] (prismatic: [m]), shape (n, dof).
        lengths: Segment lengths by name, in [m].

    Returns:
        Position, shape (n, 3), in [m], and rotation, shape (n, 3, 3).

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    T = joint_frames(chain, q, lengths)[:, -1]
    return T[:, :3, 3], T[:, :3, :3]
