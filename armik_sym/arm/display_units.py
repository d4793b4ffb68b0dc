"""Joint values in the units people read: degrees, or millimetres for a prismatic joint."""

from __future__ import annotations

import math
from dataclasses import dataclass

from armik_sym.arm.dh import JointType
from armik_sym.arm.model import Arm


@dataclass(frozen=True)
class JointUnit:
    """The unit a joint is shown in.

    Attributes:
        name: "deg" or "mm", for headers and axes.
        symbol: "°" or " mm", for running text.
        factor: Shown value = factor · value in SI.
        si: The SI unit, "rad" or "m".

    Source:
        SI.
    """

    name: str
    symbol: str
    factor: float
    si: str

    def text(self, value: float, digits: int = 3, per: str = "") -> str:
        """A joint value in words: 0.5 rad → "28.6°", with per="/s" → "28.6°/s".

        Args:
            value: Joint angle in [rad] or length in [m], or a rate of it.
            digits: Significant digits.
            per: What follows the unit.

        Returns:
            The text.

        Source:
            None (reporting).
        """
        return f"{self.factor * value:.{digits}g}{self.symbol}{per}"


_ANGLE = JointUnit("deg", "°", 180.0 / math.pi, "rad")
_LENGTH = JointUnit("mm", " mm", 1000.0, "m")


def joint_unit(arm: Arm, i: int) -> JointUnit:
    """The unit joint i is shown in.

    Args:
        arm: The arm.
        i: Index of the joint.

    Returns:
        Degrees for a revolute joint, millimetres for a prismatic one.

    Source:
        SI.
    """
    return _LENGTH if arm.chain.moving_links[i].joint is JointType.PRISMATIC else _ANGLE


def joint_units(arm: Arm) -> tuple[JointUnit, ...]:
    """The units of all joints, from base to hand.

    Args:
        arm: The arm.

    Returns:
        One unit per joint.

    Source:
        SI.
    """
    return tuple(joint_unit(arm, i) for i in range(arm.dof))
