"""A start posture, checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.display_units import joint_unit
from armik_sym.arm.model import Arm
from armik_sym.errors import HandPathError, LimitError, ShapeError

Array = NDArray[np.float64]


def check_start(arm: Arm, start: ArrayLike | None) -> Array | None:
    """A start posture inside the range of motion: lower ≤ start ≤ upper.

    Args:
        arm: The arm.
        start: Posture, shape (dof,), in [rad], or None.

    Returns:
        The posture, or None.

    Raises:
        ShapeError: If it has not one number per joint.
        LimitError: If an angle is not finite or outside its range.

    Source:
        None (input check).
    """
    if start is None:
        return None
    try:
        q = np.array(start, dtype=np.float64)
    except (TypeError, ValueError):
        raise ShapeError(
            f"start is {start!r}, expected {arm.dof} numbers, one angle per joint in [rad]"
        ) from None
    if q.shape != (arm.dof,):
        raise ShapeError(f"start has shape {q.shape}, expected ({arm.dof},), one angle per joint in [rad]")
    outside = np.flatnonzero(~(arm.rom.margin(q) >= 0))
    if outside.size:
        i = int(outside[0])
        hint = "; angles are in radians" if np.abs(q).max() > 2 * np.pi else ""
        unit = joint_unit(arm, i)
        raise LimitError(
            f"start posture: {arm.joint_names[i]} is {q[i]:.6g} {unit.si} ({unit.text(q[i], 4)}), outside "
            f"its range of motion {arm.rom.lower[i]:.6g} to {arm.rom.upper[i]:.6g} {unit.si} "
            f"({unit.text(arm.rom.lower[i], 4)} to {unit.text(arm.rom.upper[i], 4)}){hint}"
        )
    return q


def finite_posture(arm: Arm, posture: ArrayLike, what: str) -> Array:
    """A posture with one finite angle per joint, which may be outside the range of motion.

    Args:
        arm: The arm.
        posture: Posture, shape (dof,), in [rad].
        what: The argument, for messages.

    Returns:
        A copy, shape (dof,), in [rad].

    Raises:
        ShapeError: If it does not have shape (dof,).
        HandPathError: If it is not finite.

    Source:
        None (input check).
    """
    q = np.array(posture, dtype=np.float64)
    if q.shape != (arm.dof,):
        raise ShapeError(f"{what} has shape {q.shape}, expected ({arm.dof},): {', '.join(arm.joint_names)}")
    if not np.isfinite(q).all():
        raise HandPathError(f"{what} is {q.tolist()}, expected finite angles")
    return q
