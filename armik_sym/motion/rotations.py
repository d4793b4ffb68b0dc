"""Rotation matrices and unit quaternions (w, x, y, z) of recorded motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armik_sym.errors import HandPathError
from armik_sym.motion.checks import Place, sample_place

Array = NDArray[np.float64]

_ROTATION_TOLERANCE = 1e-6
_QUATERNION_TOLERANCE = 1e-3
_EXACT = 1e-15


def check_rotations(rotation: Array, place: Place = sample_place) -> None:
    """Refuse matrices that do not turn: RᵀR = I to 1e-6 and det R = +1.

    Args:
        rotation: Matrices, shape (n, 3, 3).
        place: Words for where a sample is.

    Raises:
        HandPathError: If a matrix is not orthogonal, or is a reflection.

    Source:
        None (definition of SO(3)).
    """
    deviation = _deviation(rotation)
    bad = np.flatnonzero(~(deviation <= _ROTATION_TOLERANCE))
    if bad.size:
        i = int(bad[0])
        raise HandPathError(
            f"rotation of {place(i)} is no rotation: RᵀR differs from I by {deviation[i]:.2g}, allowed "
            f"{_ROTATION_TOLERANCE:g} ({bad.size} of {len(rotation)} samples): the columns must be unit "
            "vectors at right angles, given with at least 7 digits"
        )
    mirrored = np.flatnonzero(np.linalg.det(rotation) < 0)
    if mirrored.size:
        raise HandPathError(
            f"rotation of {place(int(mirrored[0]))} is a reflection, det R = -1 ({mirrored.size} of "
            f"{len(rotation)} samples): mirrored axes? A left-handed frame must be made right-handed first"
        )


def nearest_rotations(rotation: Array) -> Array:
    """The rotations nearest to matrices that already are rotations but for rounding.

    R ← ½ R (3 I - RᵀR), twice: Newton's iteration for the factor U Vᵀ of the singular value
    decomposition U Σ Vᵀ. From 1e-6 it lands on rounding; the decomposition itself would be off by
    some 2e-15. Matrices exact to 1e-15 stay as they are, so that doing it again changes nothing.

    Args:
        rotation: Matrices that pass `check_rotations`, shape (n, 3, 3).

    Returns:
        Rotation matrices, shape (n, 3, 3).

    Source:
        Higham (1986), Computing the polar decomposition - with applications.
    """
    R = rotation
    for _ in range(2):
        better = 0.5 * R @ (3.0 * np.eye(3) - np.swapaxes(R, 1, 2) @ R)
        R = np.where((_deviation(R) <= _EXACT)[:, None, None], R, better)
    return np.asarray(R, dtype=np.float64)


def quaternions_to_rotations(quaternion_wxyz: Array, place: Place = sample_place) -> Array:
    """Rotation matrices of unit quaternions (w, x, y, z).

    Args:
        quaternion_wxyz: Quaternions with |q| = 1 to 1e-3, normalised here, shape (n, 4).
        place: Words for where a sample is.

    Returns:
        Rotation matrices, shape (n, 3, 3).

    Raises:
        HandPathError: If a quaternion is not of unit length.

    Source:
        None (elementary).
    """
    with np.errstate(over="ignore"):
        norm = np.linalg.norm(quaternion_wxyz, axis=1)
    bad = np.flatnonzero(np.abs(norm - 1.0) > _QUATERNION_TOLERANCE)
    if bad.size:
        i = int(bad[0])
        raise HandPathError(
            f"quaternion of {place(i)} is {quaternion_wxyz[i].tolist()} with length {norm[i]:.6g}, expected "
            f"a unit quaternion (w, x, y, z), 1 ± {_QUATERNION_TOLERANCE:g}"
        )
    return np.asarray(Rotation.from_quat(quaternion_wxyz[:, [1, 2, 3, 0]]).as_matrix(), dtype=np.float64)


def rotations_to_quaternions(rotation: Array) -> Array:
    """Unit quaternions (w, x, y, z) of rotation matrices, without jumps of sign.

    q and -q are the same rotation: the first sample gets w ≥ 0, each further one the sign nearer to
    the sample before it.

    Args:
        rotation: Rotation matrices, shape (n, 3, 3).

    Returns:
        Unit quaternions, shape (n, 4).

    Source:
        None (elementary).
    """
    q = Rotation.from_matrix(rotation).as_quat()[:, [3, 0, 1, 2]]
    sign = np.where(np.einsum("ij,ij->i", q[1:], q[:-1]) < 0, -1.0, 1.0)
    first = -1.0 if q[0, 0] < 0 else 1.0
    return np.asarray(q * (first * np.cumprod(np.concatenate(([1.0], sign))))[:, None], dtype=np.float64)


def _deviation(rotation: Array) -> Array:
    with np.errstate(over="ignore", invalid="ignore"):
        gram = np.swapaxes(rotation, 1, 2) @ rotation
    return np.asarray(np.abs(gram - np.eye(3)).max(axis=(1, 2)), dtype=np.float64)
