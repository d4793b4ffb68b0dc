"""What the option `prefer` means for an arm: a posture, or a direction for the elbow."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.display_units import joint_unit
from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError

Array = NDArray[np.float64]

ElbowWish = Literal["elbow_low", "elbow_high", "elbow_out", "elbow_in"]

ELBOW_WISHES: tuple[str, ...] = get_args(ElbowWish)

# The field of `Arm` that a word refers to, and its sign.
_MEANING: dict[str, tuple[str, float]] = {
    "elbow_low": ("up", -1.0),
    "elbow_high": ("up", 1.0),
    "elbow_out": ("outward", 1.0),
    "elbow_in": ("outward", -1.0),
}

_VECTORS = "a posture (dof,) in [rad], or a direction (3,) in the base frame"

# Joints an arm needs to have an elbow whose direction can be chosen: three in the shoulder and a hinge.
_FEWEST = 4


def check_preference(prefer: object) -> None:
    """Refuse a preference that no arm could fulfil.

    Args:
        prefer: None, one of `ELBOW_WISHES`, or a vector of finite numbers.

    Raises:
        OptionError: If it is anything else.

    Source:
        None (input check).
    """
    if prefer is None:
        return
    if isinstance(prefer, str):
        if prefer not in ELBOW_WISHES:
            raise OptionError(f"prefer is {prefer!r}: valid are {', '.join(ELBOW_WISHES)}, {_VECTORS}")
        return
    try:
        values = np.asarray(prefer)
    except ValueError:
        values = np.empty(0)
    if values.ndim != 1 or values.size == 0 or values.dtype.kind not in "iuf":
        raise OptionError(f"prefer is {prefer!r}: valid are {', '.join(ELBOW_WISHES)}, {_VECTORS}")
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise OptionError(f"prefer: number {bad[0] + 1} is {values[bad[0]]}, expected finite numbers")


def preferred_posture(arm: Arm, prefer: str | ArrayLike | None) -> Array:
    """The posture that the posture term is drawn to.

    Args:
        arm: The arm.
        prefer: The option, checked by `check_preference`.

    Returns:
        The posture given, or the middle of the range of motion if none is given, shape (dof,), in [rad].

    Raises:
        OptionError: If a posture does not fit the arm or lies outside its range of motion.

    Source:
        None (this package).
    """
    if prefer is None or wants_elbow(arm, prefer):
        return arm.rom.middle
    q = np.array(prefer, dtype=np.float64)
    if q.shape != (arm.dof,):
        direction = (
            ", or 3 numbers, a direction for the elbow in the base frame" if arm.dof >= _FEWEST else ""
        )
        raise OptionError(
            f"prefer has {q.size} numbers, but arm {arm.name!r} has {arm.dof} joints: expected {arm.dof} "
            f"angles in [rad]{direction}"
        )
    outside = np.flatnonzero(arm.rom.margin(q) < 0)
    if outside.size:
        i = int(outside[0])
        unit = joint_unit(arm, i)
        hint = "; angles are in radians" if np.abs(q).max() > 2 * np.pi else ""
        raise OptionError(
            f"prefer: {arm.joint_names[i]} is {q[i]:.6g} {unit.si} ({unit.text(q[i], 4)}), outside its range "
            f"of motion {arm.rom.lower[i]:.6g} to {arm.rom.upper[i]:.6g} {unit.si}{hint}"
        )
    return q


def wants_elbow(arm: Arm, prefer: str | ArrayLike | None) -> bool:
    """Whether a preference is about the elbow.

    Three numbers are a direction; only an arm of three joints has no elbow that could point: there they are
    a posture.

    Args:
        arm: The arm.
        prefer: The option, checked by `check_preference`.

    Returns:
        True for a word or a direction, False for a posture or nothing.

    Source:
        None (this package).
    """
    if prefer is None or isinstance(prefer, str):
        return prefer is not None
    return np.shape(prefer) == (3,) and arm.dof != 3


def elbow_direction(arm: Arm, prefer: ArrayLike) -> Array:
    """The direction from the shoulder in which the elbow is preferred.

    Args:
        arm: The arm.
        prefer: A word or a direction, checked by `check_preference`.

    Returns:
        Unit vector in the base frame, shape (3,).

    Raises:
        OptionError: If the arm does not say where up or outward is, or the vector is zero.

    Source:
        None (this package).
    """
    if isinstance(prefer, str):
        field, sign = _MEANING[prefer]
        known = getattr(arm, field)
        if known is None:
            raise OptionError(
                f"prefer is {prefer!r}, but arm {arm.name!r} does not say where {field} is: give the "
                f"direction as a vector (3,) in the base frame, or the arm a unit vector {field!r}"
            )
        return np.asarray(sign * known)
    vector = np.array(prefer, dtype=np.float64)
    largest = float(np.abs(vector).max())
    if largest == 0:
        raise OptionError("prefer is the vector 0, 0, 0, which points nowhere: expected a direction (3,)")
    vector = vector / largest  # so that no square overflows or vanishes
    return np.asarray(vector / np.linalg.norm(vector))
