"""The numbers of an arm that enter the closed form: one row of `SIZE` numbers, lengths included."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import OptionError
from armik_sym.swivel.axis_lines import turned
from armik_sym.swivel.spherical_arm import SphericalArm

Array = NDArray[np.float64]

SIZE = 46

# The row, as (first, last + 1):
SHOULDER = (0, 3)  # shoulder centre in the base
WRIST_IN_HAND = (3, 6)  # the point to be reached, in the hand frame
LENGTHS = (6, 9)  # upper arm, forearm at right angles to the hinge, offset along the hinge
ELBOW_ZERO = (9, 10)  # angle from upper arm to forearm about the hinge at q4 = 0
BEFORE_SHOULDER = (10, 19)  # `before` of the shoulder
AFTER_SHOULDER = (19, 28)  # from the frame of the hinge to `after` of the shoulder
BEFORE_WRIST = (28, 37)  # from the frame of the forearm to `before` of the wrist
AFTER_WRIST = (37, 46)  # `after` of the wrist in the hand frame


@functools.lru_cache(maxsize=64)
def pose_geometry(spherical: SphericalArm) -> Array:
    """The numbers for poses of the hand: the point to be reached is the wrist.

    Args:
        spherical: The arm.

    Returns:
        Shape (SIZE,), lengths in [m], angles in [rad].

    Raises:
        OptionError: If the arm has no spherical wrist.

    Source:
        None (this package).
    """
    wrist, lines = spherical.wrist, spherical.lines
    if wrist is None:
        raise OptionError(f"no closed form for poses: {spherical.why_no_wrist}")
    row = _row(spherical, wrist.centre[None])[0]
    frame = _hinge_frame(spherical) @ turned(np.array([0.0, 0.0, 1.0]), row[slice(*ELBOW_ZERO)])[0]
    row[slice(*WRIST_IN_HAND)] = lines.rotation.T @ (wrist.centre - lines.position)
    row[slice(*BEFORE_WRIST)] = (wrist.before.T @ frame).ravel()
    row[slice(*AFTER_WRIST)] = (lines.rotation.T @ wrist.after).ravel()
    row.flags.writeable = False  # the same row serves every caller
    return np.asarray(row)


def position_geometry(spherical: SphericalArm, rest: Array) -> Array:
    """The numbers for positions of the hand: joints after the elbow stand still, the point is the hand.

    Args:
        spherical: The arm.
        rest: Angles of the joints after the elbow, shape (n, dof - 4), in [rad].

    Returns:
        Shape (n, SIZE), lengths in [m], angles in [rad].

    Source:
        None (this package).
    """
    lines = spherical.lines
    hand = np.broadcast_to(lines.position, (len(rest), 3))
    for j in range(rest.shape[1] - 1, -1, -1):
        point = lines.point[4 + j]
        hand = point + np.einsum("nij,nj->ni", turned(lines.direction[4 + j], rest[:, j]), hand - point)
    return _row(spherical, hand)


def _row(spherical: SphericalArm, reached: Array) -> Array:
    """The part that both kinds share; `reached` are the points to be reached at q4 = 0, shape (n, 3)."""
    X = _hinge_frame(spherical)
    forearm = (reached - spherical.elbow) @ X
    rows = np.zeros((len(reached), SIZE))
    rows[:, slice(*SHOULDER)] = spherical.shoulder.centre
    rows[:, LENGTHS[0]] = np.linalg.norm(spherical.upper_arm)
    rows[:, LENGTHS[0] + 1] = np.hypot(forearm[:, 0], forearm[:, 1])
    rows[:, LENGTHS[0] + 2] = forearm[:, 2]
    rows[:, ELBOW_ZERO[0]] = np.arctan2(forearm[:, 1], forearm[:, 0])
    rows[:, slice(*BEFORE_SHOULDER)] = spherical.shoulder.before.ravel()
    rows[:, slice(*AFTER_SHOULDER)] = (spherical.shoulder.after.T @ X).ravel()
    return rows


def _hinge_frame(spherical: SphericalArm) -> Array:
    """Frame [upper arm, hinge × upper arm, hinge] at q = 0, shape (3, 3)."""
    along = spherical.reference
    return np.column_stack([along, np.cross(spherical.hinge, along), spherical.hinge])
