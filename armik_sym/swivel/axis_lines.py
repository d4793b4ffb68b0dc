"""The lines about which the joints of an arm turn at q = 0."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import DHConvention
from armik_sym.arm.model import Arm
from armik_sym.symbolic import express

Array = NDArray[np.float64]

# Entries this near to -1, 0 and 1 are rounding of right angles.
_DUST = 4e-16


@dataclass(frozen=True, eq=False)
class AxisLines:
    """T(q) = Π turn(direction_i, point_i, q_i) · (rotation, position).

    Attributes:
        direction: Unit vectors about which positive angles turn, in the base frame, shape (dof, 3).
        point: A point on each line, shape (dof, 3), in [m].
        rotation: Rotation of the hand at q = 0, shape (3, 3).
        position: Position of the hand at q = 0, shape (3,), in [m].
    """

    direction: Array
    point: Array
    rotation: Array
    position: Array


def axis_lines(arm: Arm) -> AxisLines:
    """The lines about which the joints turn, where they are at q = 0.

    A standard row turns about z of the frame before it, a modified row about z of its own frame.

    Args:
        arm: The arm; only revolute joints.

    Returns:
        Lines and pose of the hand.

    Source:
        Siciliano et al., Robotics (2009), §2.8 (both conventions); Lynch and Park (2017), §4.1 (product of
        exponentials).
    """
    expressions = express(arm, lengths="baked")
    transforms = ca.horzcat(*expressions.frames, expressions.T_base_hand)
    at_zero = ca.Function("at_zero", [expressions.q], [transforms])(np.zeros(arm.dof))
    frames = np.split(np.array(at_zero, dtype=np.float64), len(expressions.frames) + 1, axis=1)
    own = arm.chain.convention is DHConvention.MODIFIED
    moving = [(i, link.sign) for i, link in enumerate(arm.chain.links) if link.moves]
    T = np.array([frames[i + own] for i, _ in moving])
    signs = np.array([sign for _, sign in moving], dtype=np.float64)
    hand = frames[-1]
    return AxisLines(_swept(T[:, :3, 2] * signs[:, None]), T[:, :3, 3], _swept(hand[:3, :3]), hand[:3, 3])


def turned(direction: Array, angle: Array) -> Array:
    """Rotation matrices about one unit vector, by Rodrigues' formula.

    Args:
        direction: Unit vector, shape (3,).
        angle: Angles, shape (n,), in [rad].

    Returns:
        Shape (n, 3, 3).

    Source:
        Siciliano et al., Robotics (2009), eq. 2.25.
    """
    x, y, z = direction
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    along = np.outer(direction, direction)
    c, s = np.cos(angle)[:, None, None], np.sin(angle)[:, None, None]
    return np.asarray(along + c * (np.eye(3) - along) + s * cross)


def _swept(entries: Array) -> Array:
    whole = np.rint(entries)
    return np.where(np.abs(entries - whole) <= _DUST, whole, entries)
