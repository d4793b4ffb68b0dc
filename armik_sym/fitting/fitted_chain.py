"""Segment lengths and range of motion of the fitted arm."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.errors import OptionError, ShapeError
from armik_sym.fitting.arm_frame import ArmFrame
from armik_sym.fitting.landmarks import Landmarks
from armik_sym.fitting.recording_checks import check_plausible
from armik_sym.fitting.spread import Spread, spread

Array = NDArray[np.float64]
Limits = str | RangeOfMotion


def fitted_lengths(marks: Landmarks, anatomy: ArmFrame, source: str) -> dict[str, Spread]:
    """Segment lengths: robust means of the distances between neighbouring points.

    Args:
        marks: The points of all samples, NaN where missing.
        anatomy: Which lengths the arm has.
        source: Name of the recording, for messages.

    Returns:
        Spread by name of the length; without `hand` if the arm has none or no point of the hand is given.

    Raises:
        UnitError: If one is no length of a person.

    Source:
        As for `Spread`.
    """
    found = {
        "upper_arm": spread(_distance(marks.elbow, marks.shoulder)),
        "forearm": spread(_distance(marks.wrist, marks.elbow)),
    }
    if anatomy.has_hand and marks.has_hand:
        found["hand"] = spread(_distance(marks.hand, marks.wrist))
    check_plausible({name: s.mean for name, s in found.items()}, source)
    return found


def lengthened(arm: Arm, lengths: Mapping[str, Spread]) -> Arm:
    """The arm with these mean lengths; a hand of which there is no point gets length 0.

    Args:
        arm: The arm.
        lengths: Spread by name.

    Returns:
        A new arm.

    Source:
        None (bookkeeping).
    """
    return arm.with_lengths(**{name: lengths[name].mean if name in lengths else 0.0 for name in arm.lengths})


def checked_limits(rom: str | RangeOfMotion | tuple[ArrayLike, ArrayLike] | None, arm: Arm) -> Limits | None:
    """What a user may say about the range of motion.

    Args:
        rom: None, "widened", a range of motion, or lower and upper limits, each of shape (dof,), in [rad].
        arm: The arm.

    Returns:
        None, "widened" or a range of motion.

    Raises:
        OptionError: If it is something else.
        ShapeError: If the limits are not as many as joints.

    Source:
        None (bookkeeping).
    """
    if rom is None or (isinstance(rom, str) and rom == "widened"):
        return rom
    if isinstance(rom, tuple) and len(rom) == 2:
        rom = RangeOfMotion(np.asarray(rom[0]), np.asarray(rom[1]))
    if not isinstance(rom, RangeOfMotion):
        raise OptionError(f"rom is {rom!r}, expected 'widened', or lower and upper limits as a tuple")
    if rom.dof != arm.dof:
        raise ShapeError(f"rom has limits for {rom.dof} joints, arm {arm.name!r} has {arm.dof}")
    return rom


def limited(arm: Arm, limits: Limits | None, q: Array) -> Arm:
    """The arm with the range of motion asked for.

    Args:
        arm: The arm.
        limits: None for its own, "widened" to hold the angles too, or a range of motion.
        q: Measured angles, shape (n, dof), in [rad].

    Returns:
        A new arm.

    Source:
        None (this package).
    """
    if limits is None:
        return arm
    if isinstance(limits, RangeOfMotion):
        return arm.with_rom(limits.lower, limits.upper)
    return arm.with_rom(np.minimum(arm.rom.lower, q.min(axis=0)), np.maximum(arm.rom.upper, q.max(axis=0)))


def _distance(one: Array, other: Array) -> Array:
    return np.asarray(np.linalg.norm(one - other, axis=1))
