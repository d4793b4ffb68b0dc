"""Reference directions that follow a path, so that the swivel angle has a zero everywhere and never jumps."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import ShapeError
from armik_sym.swivel.closed_form import checked_reference
from armik_sym.swivel.geometry import WRIST_IN_HAND, pose_geometry
from armik_sym.swivel.spherical_arm import SphericalArm

Array = NDArray[np.float64]

_TINY = 1e-30
_SEEN = 1e-9


def wrist_directions(spherical: SphericalArm, position: ArrayLike, rotation: ArrayLike) -> Array:
    """From the shoulder to the wrist, for poses of the hand.

    Args:
        spherical: The arm.
        position: Positions of the hand, shape (n, 3), in [m].
        rotation: Rotations of the hand, shape (n, 3, 3).

    Returns:
        Vectors in the base frame, shape (n, 3), in [m].

    Raises:
        OptionError: If the arm has no spherical wrist.

    Source:
        Al-Faiz, eq. 4 (tg is their length).
    """
    p, R = np.asarray(position, dtype=np.float64), np.asarray(rotation, dtype=np.float64)
    in_hand = pose_geometry(spherical)[slice(*WRIST_IN_HAND)]
    return np.asarray(p + R @ in_hand - spherical.shoulder.centre)


def transported_reference(
    spherical: SphericalArm, directions: ArrayLike, reference: ArrayLike | None = None
) -> Array:
    """Reference directions carried along a path without turning about the line shoulder-wrist.

    From sample to sample the direction takes part in the smallest rotation that brings ŵ to the next ŵ
    (parallel transport), starting as ŵ-perpendicular part of `reference` at the first sample that shows it.
    A fixed reference turns by half a turn when the wrist passes through the line of that reference; this
    one never does. It depends on the path: equal poses at two times may have different swivel angles.

    Args:
        spherical: The arm.
        directions: From the shoulder to the wrist (or hand), shape (n, 3), as of `wrist_directions`, in [m].
        reference: Direction to begin with, unit vector, shape (3,); `spherical.reference` if left out.

    Returns:
        Unit vectors at right angles to the directions, shape (n, 3).

    Raises:
        ShapeError: If `directions` does not have shape (n, 3).

    Source:
        Bishop (1975), There is more than one way to frame a curve (the rotation-minimising frame).
    """
    v = np.asarray(directions, dtype=np.float64)
    if v.ndim != 2 or v.shape[1] != 3:
        raise ShapeError(f"directions {v.shape}: expected (n, 3)")
    if not len(v):
        return np.zeros((0, 3))
    w = _unit(v, _held(v))
    g = _unit(np.cross(np.cross(w, _away_from(w)), w), np.zeros(3))
    u = np.cross(w, g)
    carried = _carried(w[:-1], w[1:], g[:-1])
    steps = np.arctan2((carried * u[1:]).sum(axis=1), (carried * g[1:]).sum(axis=1))
    turn = np.concatenate([[0.0], np.cumsum(steps)])
    r = checked_reference(spherical, reference, len(v))
    seen = np.linalg.norm(np.cross(w, r), axis=1) > _SEEN
    if seen.any():
        k = int(np.argmax(seen))
        turn += np.arctan2(r[k] @ u[k], r[k] @ g[k]) - turn[k]
    return np.asarray(np.cos(turn)[:, None] * g + np.sin(turn)[:, None] * u)


def _carried(before: Array, after: Array, vectors: Array) -> Array:
    """Vectors at right angles to `before`, turned by the smallest rotation from `before` to `after`."""
    total = before + after
    square = (total * total).sum(axis=1, keepdims=True)
    along = (vectors * after).sum(axis=1, keepdims=True)
    return np.asarray(vectors - total * (2 * along / np.maximum(square, _TINY)))


def _held(v: Array) -> Array:
    """For every sample the last direction that had a length, x before the first."""
    has = np.linalg.norm(v, axis=1) > _TINY
    last = np.maximum.accumulate(np.where(has, np.arange(len(v)), -1))
    return np.where((last >= 0)[:, None], v[last], np.array([1.0, 0.0, 0.0]))


def _unit(v: Array, instead: Array) -> Array:
    size = np.linalg.norm(v, axis=1, keepdims=True)
    v = np.where(size > _TINY, v, instead)
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=1, keepdims=True), _TINY))


def _away_from(w: Array) -> Array:
    """The axis of the base at the largest angle to each direction."""
    return np.asarray(np.eye(3)[np.argmin(np.abs(w), axis=1)])
