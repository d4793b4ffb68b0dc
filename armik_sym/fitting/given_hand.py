"""The orientation of the hand where a recording has it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import ShapeError
from armik_sym.fitting.named_axes import HAND, named_axes
from armik_sym.motion.checks import float_copy
from armik_sym.motion.rotations import check_rotations, quaternions_to_rotations

Array = NDArray[np.float64]


def given_directions(rotation: ArrayLike, n: int, axes: str, side: str) -> Array:
    """Fingers, ulnar and dorsal direction of a hand whose orientation was recorded.

    Args:
        rotation: Rotation matrices R_recording_hand, shape (n, 3, 3), or unit quaternions (w, x, y, z), shape
            (n, 4); NaN where missing.
        n: Number of samples.
        axes: What the axes of the hand are, such as "x palmar, y proximal".
        side: "left" or "right".

    Returns:
        Columns in the axes of the recording, shape (n, 3, 3).

    Raises:
        ShapeError: If the shape is another one.
        HandPathError: If a matrix is no rotation.
        OptionError: If the axes cannot be understood.

    Source:
        None (definition).
    """
    words = named_axes(axes, HAND, "hand_axes", -1 if side == "right" else 1)
    given = float_copy(rotation, "hand_rotation")
    if given.shape not in ((n, 3, 3), (n, 4)):
        raise ShapeError(
            f"hand_rotation has shape {given.shape}, expected ({n}, 3, 3) or quaternions ({n}, 4), one for "
            "each sample of the recording"
        )
    seen = np.flatnonzero(np.isfinite(given.reshape(n, -1)).all(axis=1))

    def place(i: int) -> str:
        return f"sample {seen[i]}"

    matrices = np.full((n, 3, 3), np.nan)
    if given.ndim == 2:
        matrices[seen] = quaternions_to_rotations(given[seen], place)
    else:
        check_rotations(given[seen], place)
        matrices[seen] = given[seen]
    return np.asarray(matrices @ words.T)
