"""Whole postures of the E-HMCS as postures of the human arm, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.elbow.conversion import device_to_human, human_to_device
from armik_sym.errors import ShapeError

Array = NDArray[np.float64]

# q' of the hanging arm, flexion = abduction = internal rotation = 0, and what turns q' into these.
_HANGING = np.array([0.0, -np.pi / 2, np.pi / 2])
_SIGNS = np.array([-1.0, 1.0, 1.0])


def human_posture(q: ArrayLike) -> Array:
    """Postures of `catalog.human` that look like postures of the device `catalog.ehmcs`.

    flexion = -q'1, abduction = q'2 + 90°, internal rotation = q'3 - 90° with q' of `device_to_human`; from
    the elbow on the angles are the same. Of all solutions a continuous path is taken that starts as near to
    the hanging arm as it can.

    Args:
        q: Device postures, at least the three shoulder angles, shape (n, k) or (k,), k ≥ 3, in [rad].

    Returns:
        Human postures, same shape, in [rad].

    Raises:
        ShapeError: If there are fewer than three angles, or one of the shoulder is not finite.

    Source:
        Nguyen 2021, §2.3 and §5 (Fig. 15), eq. 8 (ledger: nguyen2021 8).
    """
    posture = _postures(q, "human_posture")
    shoulder = (device_to_human(posture[..., :3], neighbour=_HANGING) - _HANGING) * _SIGNS
    return np.concatenate([shoulder, posture[..., 3:]], axis=-1)


def device_posture(q_human: ArrayLike) -> Array:
    """Postures of the device `catalog.ehmcs` that look like postures of `catalog.human`.

    q'1 = -flexion, q'2 = abduction - 90°, q'3 = internal rotation + 90°, then `human_to_device`; from the
    elbow on the angles are the same. Of all solutions a continuous path is taken that starts as near to the
    hanging arm as it can.

    Args:
        q_human: Human postures, at least the three shoulder angles, shape (n, k) or (k,), k ≥ 3, in [rad].

    Returns:
        Device postures, same shape, in [rad].

    Raises:
        ShapeError: If there are fewer than three angles, or one of the shoulder is not finite.

    Source:
        Nguyen 2021, §2.3, eq. 8 inverted (ledger: nguyen2021 8).
    """
    posture = _postures(q_human, "device_posture")
    shoulder = human_to_device(posture[..., :3] * _SIGNS + _HANGING, neighbour=np.zeros(3))
    return np.concatenate([shoulder, posture[..., 3:]], axis=-1)


def _postures(values: ArrayLike, name: str) -> Array:
    array = np.asarray(values, dtype=np.float64)
    if array.ndim not in (1, 2) or array.shape[-1] < 3:
        raise ShapeError(f"{name}: the postures have shape {array.shape}, expected (n, k) or (k,) with k ≥ 3")
    return array
