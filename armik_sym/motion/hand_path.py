"""What the hand does: where it is, and optionally how it is turned, over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import UnitError
from armik_sym.motion.checks import (
    Place,
    check_finite,
    check_increasing,
    check_shape,
    float_copy,
    sample_place,
)
from armik_sym.motion.rotations import check_rotations, nearest_rotations, quaternions_to_rotations

Array = NDArray[np.float64]

_FARTHEST = 10.0


@dataclass(frozen=True, eq=False, repr=False)
class HandPath:
    """A path of the hand in the base frame of the arm: t_i ↦ p_i, or (p_i, R_i).

    Attributes:
        time: Strictly increasing times, shape (n,) with n ≥ 2, in [s]; read-only.
        position: Origin of the hand frame, shape (n, 3), in [m]; read-only.
        rotation: R_base_hand, shape (n, 3, 3), or None if only the position matters; read-only.
            Matrices are accepted within 1e-6 and replaced by the nearest rotation.
        note: Where the path comes from, one line; goes along into files and figures.

    Raises:
        ShapeError: If shapes do not fit, or there are fewer than two samples.
        HandPathError: If a value is not finite, time does not increase, or a matrix is no rotation.
        UnitError: If a position is farther than 10 m from the base, as millimetres would be.

    Source:
        None (definition).
    """

    time: Array
    position: Array
    rotation: Array | None = None
    note: str = ""

    def __post_init__(self) -> None:
        checked = checked_path(self.time, self.position, self.rotation)
        for key, values in zip(("time", "position", "rotation"), checked, strict=True):
            object.__setattr__(self, key, values)

    @classmethod
    def from_quaternions(
        cls, time: ArrayLike, position: ArrayLike, quaternion_wxyz: ArrayLike, note: str = ""
    ) -> HandPath:
        """Build a path from unit quaternions, scalar first.

        Args:
            time: Times, shape (n,), in [s].
            position: Positions, shape (n, 3), in [m].
            quaternion_wxyz: Quaternions (w, x, y, z) with |q| = 1 to 1e-3, normalised here, shape (n, 4).
            note: Where the path comes from.

        Returns:
            The path.

        Raises:
            ShapeError: As for the class.
            HandPathError: As for the class, and if a quaternion is not of unit length.
            UnitError: As for the class.

        Source:
            None (definition).
        """
        t = float_copy(time, "time")
        q = float_copy(quaternion_wxyz, "quaternion")
        check_shape(q, "quaternion", (len(np.atleast_1d(t)), 4), f"({len(np.atleast_1d(t))}, 4)")
        check_finite(q, "quaternion")
        return cls(t, float_copy(position, "position"), quaternions_to_rotations(q), note)

    @property
    def n(self) -> int:
        """Number of samples."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample, in [s]."""
        return float(self.time[-1] - self.time[0])

    def __len__(self) -> int:
        return self.n

    def __repr__(self) -> str:
        turned = "position only" if self.rotation is None else "with rotation"
        return f"HandPath({self.n} samples, {self.duration:g} s, {turned})"


def checked_path(
    time: ArrayLike, position: ArrayLike, rotation: ArrayLike | None, place: Place = sample_place
) -> tuple[Array, Array, Array | None]:
    """Check the parts of a path and return read-only copies of them.

    t_i > t_{i-1}, |p| ≤ 10 m in every coordinate, RᵀR = I to 1e-6, det R = +1.

    Args:
        time: Times, shape (n,), in [s].
        position: Positions, shape (n, 3), in [m].
        rotation: Rotation matrices, shape (n, 3, 3), or None.
        place: Words for where a sample is; readers of files name the line.

    Returns:
        Time, position and rotation; the rotations exact to rounding.

    Raises:
        ShapeError: If shapes do not fit, or there are fewer than two samples.
        HandPathError: If a value is not finite, time does not increase, or a matrix is no rotation.
        UnitError: If a position is farther than 10 m from the base.

    Source:
        None (definition).
    """
    t, p = float_copy(time, "time"), float_copy(position, "position")
    if t.ndim != 1 or len(t) < 2:
        check_shape(t, "time", (None,), "(n,)")
        check_shape(t, "time", (2,), "(n,) with n ≥ 2: a path needs at least two samples")
    n = len(t)
    check_shape(p, "position", (n, 3), f"({n}, 3), one row for each of the {n} times")
    check_finite(t, "time", place)
    check_finite(p, "position", place)
    check_increasing(t, place)
    _check_metres(p, place)
    return t, p, None if rotation is None else _checked_rotation(rotation, n, place)


def _checked_rotation(rotation: ArrayLike, n: int, place: Place) -> Array:
    R = float_copy(rotation, "rotation")
    check_shape(R, "rotation", (n, 3, 3), f"({n}, 3, 3), one matrix for each of the {n} times")
    check_finite(R, "rotation", place)
    check_rotations(R, place)
    R = nearest_rotations(R)
    R.flags.writeable = False
    return R


def _check_metres(position: Array, place: Place) -> None:
    far = np.flatnonzero((np.abs(position) > _FARTHEST).any(axis=1))
    if far.size:
        i = int(far[0])
        x, y, z = position[i]
        raise UnitError(
            f"position of {place(i)} is ({x:g}, {y:g}, {z:g}) m: more than any arm reaches "
            f"({_FARTHEST:g} m); if these are millimetres, divide by 1000, or in a file write [mm] in the "
            "header"
        )
