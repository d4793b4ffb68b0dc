"""Rotation matrices and unit quaternions (w, x, y, z) of recorded motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

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
        Siciliano et al., Robotics (2009), eq. 2.33.
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
    w, x, y, z = (quaternion_wxyz / norm[:, None]).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows, dtype=np.float64), 2, 0)


def rotations_to_quaternions(rotation: Array) -> Array:
    """Unit quaternions (w, x, y, z) of rotation matrices, without jumps of sign.

    q and -q are the same rotation: the first sample gets w ≥ 0, each further one the sign nearer to
    the sample before it.

    Args:
        rotation: Rotation matrices, shape (n, 3, 3).

    Returns:
        Unit quaternions, shape (n, 4).

    Source:
        Siciliano et al., Robotics (2009), eq. 2.34-2.35; sign without loss of digits: Shepperd (1978).
    """
    q = _unsigned_quaternions(rotation)
    sign = np.where(np.einsum("ij,ij->i", q[1:], q[:-1]) < 0, -1.0, 1.0)
    first = -1.0 if q[0, 0] < 0 else 1.0
    return np.asarray(q * (first * np.cumprod(np.concatenate(([1.0], sign))))[:, None], dtype=np.float64)


def _unsigned_quaternions(rotation: Array) -> Array:
    """Each from the largest of w², x², y², z², which loses no digits."""
    R = np.moveaxis(np.asarray(rotation, dtype=np.float64), 0, 2)
    # Row i of the symmetric matrix 4·q·qᵀ is the quaternion times 4·q_i.
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    outer = np.empty((4, 4, R.shape[2]))
    outer[0, 0] = 1 + trace
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        outer[i + 1, i + 1] = 1 + 2 * R[i, i] - trace
        outer[0, i + 1] = outer[i + 1, 0] = R[k, j] - R[j, k]
        outer[j + 1, k + 1] = outer[k + 1, j + 1] = R[j, k] + R[k, j]
    largest = np.einsum("iin->ni", outer).argmax(axis=1)
    q = outer[largest, :, np.arange(R.shape[2])]
    return np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))


def _deviation(rotation: Array) -> Array:
    with np.errstate(over="ignore", invalid="ignore"):
        gram = np.swapaxes(rotation, 1, 2) @ rotation
    return np.asarray(np.abs(gram - np.eye(3)).max(axis=(1, 2)), dtype=np.float64)
