"""Where the elbow points, in words, for swivel angles: lowest, highest, outermost, innermost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.axis_lines import turned
from armik_sym.swivel.map_class import SwivelMap
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.reference import wrist_directions

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Where a direction is nearly along the line shoulder-wrist, swiveling hardly moves the elbow in it.
_LEAST_ACROSS = 0.35
# A direction whose swivel angle changes more than this is drawn one way only, in [rad].
_STEADY = 1.2
# Shorter vectors have no direction, in [m].
_TINY = 1e-9


@dataclass(frozen=True, eq=False)
class Guide:
    """The swivel angle at which the elbow is farthest in one direction.

    Attributes:
        words: What the elbow is there, such as "elbow lowest".
        psi_deg: That angle at each sample, in [-180, 180], shape (m,), in [deg]; NaN where swiveling
            hardly moves the elbow in that direction.
    """

    words: str
    psi_deg: Array


def elbow_guides(map_: SwivelMap, samples: Indices) -> list[Guide]:
    """Swivel angles at which the elbow is lowest, highest, outermost and innermost.

    The elbow is off the line shoulder-wrist by a length times e(ψ) = cos ψ·g + sin ψ·u. Its part along a
    direction d is largest where ψ = atan2(d·u, d·g). g and u are taken from the elbow itself: from e at ψ = 0
    and ψ = 90°.

    Args:
        map_: The map.
        samples: Indices of the samples, shape (m,).

    Returns:
        Guides for the directions that the arm tells of (`Arm.up`, `Arm.outward`); none if it tells of none.

    Source:
        None (vector algebra; this package).
    """
    arm, guides = map_.arm, []
    g, u = elbow_directions(map_, samples)
    names = ((arm.up, "highest", "lowest"), (arm.outward, "outermost", "innermost"))
    for direction, most, least in names:
        if direction is None:
            continue
        along_g, along_u = g @ direction, u @ direction
        seen = np.hypot(along_g, along_u) > _LEAST_ACROSS
        words = [(1, most), (-1, least)]
        if _wanders(np.arctan2(along_u[seen], along_g[seen])):  # four crossing lines explain nothing
            words = words[:1] if direction is arm.outward else words[1:]
        for sign, word in words:
            psi = np.rad2deg(np.arctan2(sign * along_u, sign * along_g))
            guides.append(Guide(f"elbow {word}", np.where(seen, psi, np.nan)))
    return guides


def _wanders(psi: Array) -> bool:
    return bool(psi.size and np.ptp(np.unwrap(psi)) > _STEADY)


def elbow_directions(map_: SwivelMap, samples: Indices) -> tuple[Array, Array]:
    """Directions from the line shoulder-wrist to the elbow at ψ = 0 and at ψ = 90°, from its positions.

    Args:
        map_: The map.
        samples: Indices of the samples, shape (m,).

    Returns:
        Unit vectors in the base frame, shape (m, 3) each; 0 where the elbow is on the line.

    Source:
        Siciliano et al., Robotics (2009), eq. 2.25 (turns about the shoulder's axes).
    """
    lines, upper_arm = map_.spherical.lines, map_.spherical.upper_arm
    along = _unit(_towards_target(map_)[samples])
    found = []
    for psi in (0.0, 0.5 * np.pi):
        q = postures_at(map_.intervals.curves, samples, 0, psi, backend=map_.backend).q
        elbow = np.broadcast_to(upper_arm, (len(q), 3))
        for joint in (2, 1, 0):
            elbow = np.einsum("nij,nj->ni", turned(lines.direction[joint], q[:, joint]), elbow)
        found.append(_unit(elbow - along * (elbow * along).sum(axis=1, keepdims=True)))
    return found[0], found[1]


def _towards_target(map_: SwivelMap) -> Array:
    path = map_.path
    if map_.wrist is None and path.rotation is not None:
        return wrist_directions(map_.spherical, path.position, path.rotation)
    return np.asarray(path.position - map_.spherical.shoulder.centre)


def _unit(v: Array) -> Array:
    size = np.linalg.norm(v, axis=1, keepdims=True)
    return np.where(size > _TINY, v / np.maximum(size, _TINY), 0.0)
