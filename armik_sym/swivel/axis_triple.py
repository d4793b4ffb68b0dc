"""Three joints whose axes meet in one point, each at right angles to the next."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import ArmModelError
from armik_sym.swivel.axis_lines import AxisLines

Array = NDArray[np.float64]

# What rounding of DH parameters may do to axes: cosine of the angle between them, and metres between lines.
_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class AxisTriple:
    """Three turns about axes z1 ⟂ z2 ⟂ z3 through one point: Rz·Ry·Rz in frames adapted to them.

    before' · turn(z1, q1)·turn(z2, q2)·turn(z3, q3) · after = Rz(q1)·Ry(q2 + offset)·Rz(q3).

    Attributes:
        first: Index of the first joint.
        centre: Where the axes meet at q = 0, shape (3,), in [m].
        before: Frame [z2 × z1, z2, z1] in the base, shape (3, 3).
        after: Frame [z2 × z3, z2, z3] in the base, shape (3, 3).
        offset: Angle from z1 to z3 about z2 at q = 0, in [rad].
    """

    first: int
    centre: Array
    before: Array
    after: Array
    offset: float


def axis_triple(arm: Arm, lines: AxisLines, first: int, what: str) -> AxisTriple:
    """Three consecutive joints as a spherical joint.

    Args:
        arm: The arm.
        lines: Its lines.
        first: Index of the first of the three joints.
        what: What they are, for messages.

    Returns:
        The triple.

    Raises:
        ArmModelError: If the axes do not meet in one point, or neighbours are not at right angles.

    Source:
        Siciliano et al., Robotics (2009), §2.4.1 (ZYZ angles).
    """
    names = arm.joint_names[first : first + 3]
    z1, z2, z3 = lines.direction[first : first + 3]
    for a, b, i in ((z1, z2, 0), (z2, z3, 1)):
        if abs(float(a @ b)) > _ROUNDING:
            angle = math.degrees(math.acos(min(1.0, max(-1.0, float(a @ b)))))
            raise ArmModelError(
                f"arm {arm.name!r}: the axes of {names[i]!r} and {names[i + 1]!r} make {angle:.10g}°, a "
                f"spherical {what} of this closed form needs 90°"
            )
    points = lines.point[first : first + 3]
    centre = points[0] + z1 * float(z1 @ (points[1] - points[0]))
    for direction, point, name in zip((z2, z3), points[1:], names[1:], strict=True):
        away = float(np.linalg.norm(np.cross(direction, centre - point)))
        if away > _ROUNDING:
            raise ArmModelError(
                f"arm {arm.name!r}: the axis of {name!r} misses that of {names[0]!r} by {away:.3g} m: no "
                f"spherical {what}"
            )
    offset = math.atan2(float(z2 @ np.cross(z1, z3)), float(z1 @ z3))
    before = np.column_stack([np.cross(z2, z1), z2, z1])
    after = np.column_stack([np.cross(z2, z3), z2, z3])
    return AxisTriple(first, centre, before, after, offset)
