"""Counts of a potentiometer as angles: absolute, without an angle over the gap of its track."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.calibration.joint import FULL_TURN, JointCalibration, steps_between

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

OVERLAP = math.pi / 4
"""How far beyond half a turn from the middle a continuous motion is followed, in [rad]."""

SETTLED = 5
"""Readings in a row that have to follow each other before a wiper that jumped is trusted again."""


@dataclass(slots=True)
class WiperState:
    """What has to be remembered of one potentiometer from sample to sample.

    Attributes:
        angle: Latest angle, NaN if there was none, in [rad].
        reading: Latest reading, None before the first, in [count].
        since: Readings since the latest jump, the one that jumped included; large if there was none.
    """

    angle: float = math.nan
    reading: int | None = None
    since: int = SETTLED


def potentiometer_angles(joint: JointCalibration, counts: Counts, state: WiperState) -> Array:
    """Angles of a potentiometer: direction · scale · (counts - zero), plus full turns to get near the middle.

    An endless potentiometer repeats each turn. Of the angles full turns apart the one nearest the middle of
    the joint's range is meant. Within 45° of half a turn from the middle two are equally good; there the one
    nearer to the angle before is taken, so motion through the wrap stays continuous and a single wrong
    reading has no lasting effect.

    There is no angle where the counts are off the track, and none from a reading that is further from the one
    before than a joint can move until five readings in a row have followed each other: over the gap of the
    track the input may float and read anything.

    Args:
        joint: The joint.
        counts: Consecutive readings, shape (n,), in [count].
        state: What is remembered; changed.

    Returns:
        Angles, shape (n,), NaN in the dead zone, in [rad].

    Source:
        None (this package).
    """
    if not counts.size:
        return np.empty(0)
    lowest, highest = joint.track
    angles = np.asarray((joint.direction * joint.scale) * (counts - joint.zero))
    angles = angles - FULL_TURN * np.rint((angles - joint.middle) / FULL_TURN)
    angles[(counts < lowest) | (counts > highest) | _jumping(joint, counts, state)] = np.nan
    valid = np.flatnonzero(~np.isnan(angles))
    if valid.size:
        far = np.abs(angles[valid] - joint.middle) > math.pi - OVERLAP
        for place in np.flatnonzero(far):
            before = float(angles[valid[place - 1]]) if place else state.angle
            angles[valid[place]] = _nearer(float(angles[valid[place]]), before, joint.middle)
        state.angle = float(angles[valid[-1]])
    return angles


def _jumping(joint: JointCalibration, counts: Counts, state: WiperState) -> NDArray[np.bool_]:
    """Which readings come too soon after a jump, shape (n,)."""
    before = int(counts[0]) if state.reading is None else state.reading
    steps = joint.scale * steps_between(counts, before)
    jumps = np.abs(steps - FULL_TURN * np.rint(steps / FULL_TURN)) > joint.largest_step
    place = np.arange(len(counts))
    latest = np.maximum.accumulate(np.where(jumps, place, -1))
    since = np.where(latest >= 0, place - latest, np.minimum(state.since + place, SETTLED))
    state.reading, state.since = int(counts[-1]), int(since[-1]) + 1
    return np.asarray(since < SETTLED)


def _nearer(angle: float, before: float, middle: float) -> float:
    """The angle, or the same a full turn towards the other side of the middle, whichever is nearer."""
    other = angle - math.copysign(FULL_TURN, angle - middle)
    # Comparing with NaN is False: without an angle before, the one nearest the middle stays.
    return other if abs(other - before) < abs(angle - before) else angle
