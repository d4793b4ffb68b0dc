"""Recognising arms with a spherical shoulder, a hinge elbow and a spherical wrist from their DH chain.

Every chain is a product of turns about fixed lines, T(q) = Π exp(q_i·ξ_i)·T(0), where line i is where joint i
turns at q = 0. Conventions, base, tool, fixed rows, signs and offsets are all in these lines, so they are all
that is looked at.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import JointType
from armik_sym.arm.model import Arm
from armik_sym.errors import ArmModelError
from armik_sym.swivel.axis_lines import AxisLines, axis_lines
from armik_sym.swivel.axis_triple import AxisTriple, axis_triple

Array = NDArray[np.float64]

# Shortest upper arm and forearm that make an elbow, in [m].
_SHORTEST = 1e-6


@dataclass(frozen=True, eq=False)
class SphericalArm:
    """What the closed form needs to know of an arm, all at q = 0 and in the base frame.

    Attributes:
        arm: The arm.
        lines: The lines about which the joints turn.
        shoulder: Joints 1 to 3.
        wrist: Joints 5 to 7; None if the arm has fewer joints or their axes do not meet: then only the
            position of the hand can be asked for.
        why_no_wrist: The reason if `wrist` is None.
        hinge: Unit vector along the axis of joint 4, shape (3,).
        elbow: Point of the axis of joint 4 nearest to the shoulder, shape (3,), in [m].

    Source:
        Al-Faiz, §2 (an arm of this kind); Siciliano et al., Robotics (2009), §2.12.
    """

    arm: Arm
    lines: AxisLines
    shoulder: AxisTriple
    wrist: AxisTriple | None
    why_no_wrist: str
    hinge: Array
    elbow: Array

    @property
    def upper_arm(self) -> Array:
        """From shoulder to elbow at q = 0, at right angles to the hinge, shape (3,), in [m]."""
        return self.elbow - self.shoulder.centre

    @property
    def reference(self) -> Array:
        """Where the elbow points from the shoulder at q = 0: the default reference direction, shape (3,)."""
        return np.asarray(self.upper_arm / np.linalg.norm(self.upper_arm))


@functools.lru_cache(maxsize=64)
def recognise(arm: Arm) -> SphericalArm:
    """The spherical shoulder, hinge elbow and spherical wrist of an arm.

    Args:
        arm: The arm.

    Returns:
        Its geometry.

    Raises:
        ArmModelError: If the arm has no spherical shoulder with an elbow after it; says what is missing.

    Source:
        None (this package).
    """
    _check_revolute(arm)
    lines = axis_lines(arm)
    shoulder = axis_triple(arm, lines, 0, "shoulder")
    hinge, on_hinge = lines.direction[3], lines.point[3]
    elbow = on_hinge + hinge * float(hinge @ (shoulder.centre - on_hinge))
    if np.linalg.norm(elbow - shoulder.centre) < _SHORTEST:
        raise ArmModelError(
            f"arm {arm.name!r}: joint {arm.joint_names[3]!r} turns about a line through the shoulder: there "
            "is no upper arm between shoulder and elbow"
        )
    wrist, why_no_wrist = _wrist(arm, lines)
    if wrist is not None:
        forearm = wrist.centre - elbow
        if np.linalg.norm(forearm - hinge * float(hinge @ forearm)) < _SHORTEST:
            raise ArmModelError(
                f"arm {arm.name!r}: joint {arm.joint_names[3]!r} turns about a line through the wrist: there "
                "is no forearm between elbow and wrist"
            )
    return SphericalArm(arm, lines, shoulder, wrist, why_no_wrist, hinge, elbow)


def why_not_spherical(arm: Arm) -> str | None:
    """Why an arm has no closed form for poses of the hand.

    Args:
        arm: The arm.

    Returns:
        The reason in one sentence; None if it has the closed form.

    Source:
        None (this package).
    """
    try:
        return recognise(arm).why_no_wrist or None
    except ArmModelError as error:
        return str(error)


def _check_revolute(arm: Arm) -> None:
    if arm.dof < 4:
        raise ArmModelError(
            f"arm {arm.name!r} has {arm.dof} joints: a spherical shoulder and an elbow need at least 4"
        )
    for link in arm.chain.moving_links:
        if link.joint is not JointType.REVOLUTE:
            raise ArmModelError(f"arm {arm.name!r}: joint {link.name!r} shifts: all joints must turn")


def _wrist(arm: Arm, lines: AxisLines) -> tuple[AxisTriple | None, str]:
    if arm.dof != 7:
        return None, f"arm {arm.name!r} has {arm.dof} joints: shoulder, elbow and spherical wrist make 7"
    try:
        return axis_triple(arm, lines, 4, "wrist"), ""
    except ArmModelError as error:
        return None, str(error)
