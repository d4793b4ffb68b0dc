"""Whole postures of the E-HMCS as postures of the human arm, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.catalog import ehmcs, human
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.elbow.checks import checked_angles
from armik_sym.elbow.conversion import device_to_human, human_to_device, other_device, other_human
from armik_sym.elbow.nearest import turned_to

Array = NDArray[np.float64]

# q' of the hanging arm, flexion = abduction = internal rotation = 0, and what turns q' into these.
_HANGING = np.array([0.0, -np.pi / 2, np.pi / 2])
_SIGNS = np.array([-1.0, 1.0, 1.0])


def human_posture(q: ArrayLike, neighbour: ArrayLike | None = None) -> Array:
    """Postures of `catalog.human` that look like postures of the device `catalog.ehmcs`.

    flexion = -q'1, abduction = q'2 + 90°, internal rotation = q'3 - 90° with q' of `device_to_human`; from
    the elbow on the angles are the same.

    Args:
        q: Device postures, at least the three shoulder angles, shape (n, k) or (k,), k ≥ 3, in [rad].
        neighbour: Shoulder angles (flexion, abduction, internal rotation) close by, shape (3,), in [rad]: a
            continuous path that begins near it. None: each sample by itself, of its two solutions the one
            inside the range of motion of the human shoulder (at most one is, as they differ by half a turn
            of internal rotation), or if none is the one that leaves it less.

    Returns:
        Human postures, same shape, in [rad].

    Raises:
        ShapeError: If there are fewer than three angles, or one is not finite.

    Source:
        Nguyen 2021, §2.3 and §5 (Fig. 15), eq. 8 (ledger: nguyen2021 8).
    """
    posture = checked_angles(q, "human_posture, postures", more=True)
    if neighbour is None:
        one = device_to_human(posture[..., :3])
        shoulder = _inside(human().rom, _anatomical(one), _anatomical(other_human(one)))
    else:
        near = checked_angles(neighbour, "human_posture, neighbour") * _SIGNS + _HANGING
        shoulder = _anatomical(device_to_human(posture[..., :3], near))
    return np.concatenate([shoulder, posture[..., 3:]], axis=-1)


def device_posture(q_human: ArrayLike, neighbour: ArrayLike | None = None) -> Array:
    """Postures of the device `catalog.ehmcs` that look like postures of `catalog.human`.

    q'1 = -flexion, q'2 = abduction - 90°, q'3 = internal rotation + 90°, then `human_to_device`; from the
    elbow on the angles are the same.

    Args:
        q_human: Human postures, at least the three shoulder angles, shape (n, k) or (k,), k ≥ 3, in [rad].
        neighbour: Device angles q1, q2, q3 close by, shape (3,), in [rad]: a continuous path that begins
            near it. None: each sample by itself, of its two solutions the one inside the range of motion of
            the device, or if none is the one that leaves it less.

    Returns:
        Device postures, same shape, in [rad].

    Raises:
        ShapeError: If there are fewer than three angles, or one is not finite.

    Source:
        Nguyen 2021, §2.3, eq. 8 inverted (ledger: nguyen2021 8).
    """
    posture = checked_angles(q_human, "device_posture, postures", more=True)
    shoulder_human = posture[..., :3] * _SIGNS + _HANGING
    if neighbour is None:
        one = human_to_device(shoulder_human)
        shoulder = _inside(ehmcs().rom, one, other_device(one))
    else:
        near = checked_angles(neighbour, "device_posture, neighbour")
        shoulder = human_to_device(shoulder_human, near)
    return np.concatenate([shoulder, posture[..., 3:]], axis=-1)


def _anatomical(q_human: Array) -> Array:
    return np.asarray((q_human - _HANGING) * _SIGNS)


def _inside(rom: RangeOfMotion, one: Array, other: Array) -> Array:
    """Of two solutions the one farther inside the first three ranges, full turns chosen likewise."""
    lower, upper = rom.lower[:3], rom.upper[:3]
    middle = np.broadcast_to((lower + upper) / 2, one.shape)
    one, other = turned_to(one, middle), turned_to(other, middle)

    def margin(angles: Array) -> Array:
        return np.asarray(np.minimum(angles - lower, upper - angles).min(axis=-1))

    return np.where((margin(one) >= margin(other))[..., np.newaxis], one, other)
