"""What residuals say: a wrong angle, a bent characteristic, postures that contradict each other."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.calibration.data import JointData
from armik_sym.device.calibration.line import Line, bend, without_each
from armik_sym.errors import CalibrationError

Array = NDArray[np.float64]

WORTH_A_NOTE = math.radians(2.0)
_SIGNIFICANT = 1e-3
_FEWEST_FOR_OUTLIER = 4
_FEWEST_FOR_BEND = 5


def refuse_large_residuals(data: JointData, line: Line, turned: Array, largest_residual: float) -> None:
    """Refuse postures that are far from the line, and say which is likely wrong.

    Args:
        data: The joint.
        line: Its line.
        turned: Known angles with the full turns of the line added, shape (n,), in [rad].
        largest_residual: How far a posture may be from the line, in [rad].

    Raises:
        CalibrationError: If one is further away.

    Source:
        None (deleted residuals; F test).
    """
    worst = int(np.abs(line.residuals).argmax())
    off = abs(float(line.residuals[worst]))
    if off <= largest_residual:
        return
    joint, limit = data.setup.joint, math.degrees(largest_residual)
    suspect = _outlier(data, turned, largest_residual)
    if suspect is not None:
        k, by = suspect
        raise CalibrationError(
            f"joint {joint!r}: posture {data.names[k]!r} was given as {math.degrees(data.angles[k]):.1f}°, "
            f"but the other {len(data.angles) - 1} postures say {math.degrees(data.angles[k] - by):.1f}°: "
            "correct the angle, or leave the posture out"
        )
    if _bent(data, turned) > largest_residual / 2:
        raise CalibrationError(
            f"joint {joint!r}: its angle is no straight line over its counts, postures are up to "
            f"{math.degrees(off):.1f}° off (allowed: {limit:.1f}°): the sensor is worn or loaded "
            "electrically, or its shaft is off the joint's axis"
        )
    raise CalibrationError(
        f"joint {joint!r}: its postures contradict each other by up to {math.degrees(off):.1f}° (allowed: "
        f"{limit:.1f}°), most at {data.names[worst]!r}: one of the angles is wrong, or the device slipped on "
        "the arm; more postures would tell which"
    )


def notes_on(data: JointData, line: Line, turned: Array) -> list[str]:
    """What is worth knowing about a fit that is accepted.

    Args:
        data: The joint.
        line: Its line.
        turned: Known angles with the full turns of the line added, shape (n,), in [rad].

    Returns:
        Sentences.

    Source:
        None (F test).
    """
    joint, notes = data.setup.joint, []
    worst = int(np.abs(line.residuals).argmax())
    off = abs(float(line.residuals[worst]))
    if off > WORTH_A_NOTE:
        notes.append(f"{joint}: posture {data.names[worst]!r} is {math.degrees(off):.1f}° off the line.")
    bent = _bent(data, turned)
    if bent > WORTH_A_NOTE / 4:
        notes.append(f"{joint}: its characteristic is bent by up to {math.degrees(bent):.1f}°.")
    if np.ptp(turned - data.angles) > 0:
        notes.append(
            f"{joint}: the dead zone of its potentiometer lies inside its range; there it has no angle. "
            "Turning the shaft by half a turn would move it out of the way."
        )
    return notes


def _outlier(data: JointData, turned: Array, largest_residual: float) -> tuple[int, float] | None:
    """The one posture without which all others agree, and by how much it is off."""
    if len(data.angles) < _FEWEST_FOR_OUTLIER:
        return None
    own, rest = without_each(data.counts, turned)
    if np.isnan(rest).all():
        return None
    k = int(np.nanargmin(rest))
    others = np.delete(rest, k)
    clear = rest[k] <= largest_residual and rest[k] <= abs(own[k]) / 4 and rest[k] < np.nanmin(others) / 2
    return (k, float(own[k])) if clear else None


def _bent(data: JointData, turned: Array) -> float:
    """How far the characteristic is bent, 0 if not significantly, in [rad]."""
    if len(np.unique(data.counts)) < _FEWEST_FOR_BEND:
        return 0.0
    size, chance = bend(data.counts, turned)
    return size if chance < _SIGNIFICANT else 0.0
