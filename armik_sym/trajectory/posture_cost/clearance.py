"""How near a limit a joint of an arm begins to cost, and how much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError

Array = NDArray[np.float64]

# A joint with less room than this on either side of mid-range cannot move, in [rad].
_NO_ROOM = 1e-9

_EXPECTED = "expected one number ≥ 0 in [rad], or one per joint"


@dataclass(frozen=True, eq=False)
class Clearance:
    """Distance and weight of every joint.

    Attributes:
        distance: Distance from a limit at which the cost begins, shape (dof,), in [rad] (prismatic: [m]);
            positive, at most half the range.
        weight: Cost at the limit, shape (dof,), in [1/s²].
    """

    distance: Array
    weight: Array


def check_clearance(clearance: object) -> None:
    """Refuse distances that no arm could have.

    Args:
        clearance: One number, or one per joint.

    Raises:
        OptionError: If they are not finite numbers ≥ 0.

    Source:
        None (input check).
    """
    try:
        values = np.asarray(clearance)
    except ValueError:
        values = np.empty((0, 0))
    if values.ndim > 1 or values.size == 0 or values.dtype.kind not in "iuf":
        raise OptionError(f"clearance is {clearance!r}, {_EXPECTED}")
    bad = np.flatnonzero(~(np.isfinite(values) & (values >= 0)))
    if bad.size:
        where = f"joint {bad[0] + 1}: " if values.ndim else ""
        raise OptionError(f"clearance: {where}{values.ravel()[bad[0]]} makes no sense, {_EXPECTED}")


def clearance_of_joints(arm: Arm, clearance: ArrayLike, weight: float) -> Clearance:
    """The clearance of every joint, as far as its range has room for it.

    c_j = min(clearance_j, half range), w_j = weight·(c_j/clearance_j)²: in the middle of a range nothing
    costs, and the second derivative at a limit, 3·weight/clearance², does not grow as the range shrinks.

    Args:
        arm: The arm.
        clearance: The option, checked by `check_clearance`. One number is for all joints that turn; joints
            that slide count only if there is a number for each joint, theirs in [m].
        weight: Cost at a limit, in [1/s²].

    Returns:
        Distances and weights; joints that have no range, or whose clearance is 0, cost nothing.

    Raises:
        OptionError: If their number does not fit the arm.

    Source:
        None (this package).
    """
    wanted = np.asarray(clearance, dtype=np.float64)
    if wanted.ndim == 1 and wanted.shape != (arm.dof,):
        raise OptionError(
            f"clearance has {wanted.size} numbers, but arm {arm.name!r} has {arm.dof} joints: {_EXPECTED}"
        )
    if wanted.ndim == 0:
        wanted = np.where(arm.rotates, wanted, 0.0)
    distance = np.minimum(wanted, 0.5 * arm.rom.width)
    share = np.divide(distance, wanted, out=np.zeros(arm.dof), where=wanted > 0)
    room = distance > _NO_ROOM
    return Clearance(np.where(room, distance, 1.0), np.where(room, weight * share**2, 0.0))
