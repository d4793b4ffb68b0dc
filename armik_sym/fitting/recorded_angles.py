"""Joint angles of an arm that follows the recorded hand with the recorded elbow."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.closed_form import SwivelCurve, pose_curve
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.equivalent_angles import margin, without_turns
from armik_sym.swivel.spherical_arm import SphericalArm

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Elbow, shoulder and wrist branch of the closed form.
_BRANCHES = tuple((e, s, w) for e in (1, -1) for s in (1, -1) for w in (1, -1))
# Branches are parallel but where they touch: steps must cost so much that a jump between them never pays,
# even if the joints are outside their range of motion for thousands of samples.
_STEP_WEIGHT = 1e4
# A step this large is no movement from sample to sample, in [rad]: the arm is (all but) straight and noise
# turns the elbow about the line from shoulder to wrist. There no sequence is continuous.
_NO_STEP = np.deg2rad(60.0)
# With the elbow this near to the line from shoulder to wrist its direction says nothing, in [m].
_ON_LINE = 1e-3


@dataclass(frozen=True, eq=False)
class RecordedAngles:
    """Joint angles without regard to limits, continuous over time.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad].
        branch: Branch of the closed form of each sample, shape (n,).
        shortfall: By how far the hand is out of reach, shape (n,), in [m].
        straight: Whether the elbow is within 1 mm of the line from shoulder to wrist, so that the recorded
            elbow does not tell the swivel angle, shape (n,).
    """

    q: Array
    branch: Indices
    shortfall: Array
    straight: NDArray[np.bool_]


def recorded_angles(
    spherical: SphericalArm, position: Array, rotation: Array, elbow: Array
) -> RecordedAngles:
    """Joint angles from the pose of the hand and the direction of the elbow, by the closed form.

    The elbow of the arm is on its circle about the line from shoulder to wrist; of this circle the point
    nearest in direction to the recorded elbow is taken: ψ = 0 with the recorded elbow as reference. Of the
    eight branches the one sequence is taken that never jumps and is outside the range of motion least
    (shortest path); angles go on over ±180°. Where noise turns the elbow of a straight arm by more than 60°
    from one sample to the next, the angles after it are again those that are outside least.

    Args:
        spherical: The arm.
        position: Positions of the hand in the base frame, shape (n, 3), in [m].
        rotation: Rotations of the hand, shape (n, 3, 3).
        elbow: From the shoulder to the recorded elbow, shape (n, 3), in [m].

    Returns:
        The angles.

    Source:
        Al-Faiz, eq. 4-47, corrected; Shimizu et al. (2008); Viterbi (1967) for the branches.
    """
    curves = _curves(spherical, position, rotation, elbow)
    every = np.stack([_postures(curves, branch) for branch in range(len(_BRANCHES))], axis=1)
    branch = _least_way(spherical, every)
    q = every[np.arange(len(every)), branch]
    q = _inside_by_turns(spherical, np.unwrap(q, axis=0))
    curve = curves[0]
    straight = (curve.off_line < _ON_LINE) | (curve.reference_sine * np.linalg.norm(elbow, axis=1) < _ON_LINE)
    return RecordedAngles(q, branch, curve.shortfall, straight)


def angles_on_branches(
    spherical: SphericalArm, position: Array, rotation: Array, elbow: Array, branch: Indices
) -> Array:
    """The same on known branches; angles may differ by whole turns.

    Args:
        spherical: The arm.
        position: Positions of the hand in the base frame, shape (n, 3), in [m].
        rotation: Rotations of the hand, shape (n, 3, 3).
        elbow: From the shoulder to the recorded elbow, shape (n, 3), in [m].
        branch: As in `RecordedAngles`, shape (n,).

    Returns:
        Joint angles, shape (n, dof), in [rad].

    Source:
        As for `recorded_angles`.
    """
    curves = _curves(spherical, position, rotation, elbow)
    q = np.empty((len(position), spherical.arm.dof))
    for number in np.unique(branch):
        mine = branch == number
        q[mine] = _postures((curves[0].rows(mine), curves[1].rows(mine)), int(number))
    return q


def _curves(
    spherical: SphericalArm, position: Array, rotation: Array, elbow: Array
) -> tuple[SwivelCurve, SwivelCurve]:
    one, other = (pose_curve(spherical, position, rotation, side, elbow) for side in (1, -1))
    return one, other


def _postures(curves: tuple[SwivelCurve, SwivelCurve], branch: int) -> Array:
    side, shoulder, wrist = _BRANCHES[branch]
    curve = curves[0] if side > 0 else curves[1]
    return curve.postures(np.zeros(len(curve.elbow)), shoulder, wrist).q


def _least_way(spherical: SphericalArm, every: Array) -> Indices:
    """Branches of the cheapest sequence through all postures, shape (n, branches, dof)."""
    rom = spherical.arm.rom
    outside = np.minimum(margin(every, rom.lower, rom.upper), 0.0)
    price = np.sum(outside**2, axis=2)
    best, came_from = price[0], np.zeros(every.shape[:2], dtype=np.int64)
    for i in range(1, len(every)):
        step = without_turns(every[i][None] - every[i - 1][:, None])
        way = best[:, None] + _STEP_WEIGHT * np.sum(np.minimum(step**2, _NO_STEP**2), axis=2)
        came_from[i] = np.argmin(way, axis=0)
        best = way[came_from[i], np.arange(len(best))] + price[i]
    branch = np.empty(len(every), dtype=np.int64)
    branch[-1] = int(np.argmin(best))
    for i in range(len(every) - 1, 0, -1):
        branch[i - 1] = came_from[i, branch[i]]
    return branch


def _inside_by_turns(spherical: SphericalArm, q: Array) -> Array:
    """Whole turns for each joint, the same from break to break, that leave its range of motion least."""
    rom, turns = spherical.arm.rom, np.arange(-2, 3) * TURN
    out = q.copy()
    for joint in range(q.shape[1]):
        breaks = np.flatnonzero(np.abs(np.diff(q[:, joint])) > _NO_STEP) + 1
        so_far = 0.0
        for first, end in pairwise([0, *breaks.tolist(), len(q)]):
            shifted = q[first:end, joint, None] + so_far + turns
            outside = np.maximum(shifted - rom.upper[joint], 0) + np.maximum(rom.lower[joint] - shifted, 0)
            # Of equal prices the least turns.
            chosen = int(np.argmin(outside.sum(axis=0) + 1e-9 * np.abs(turns)))
            so_far += turns[chosen]
            out[first:end, joint] = shifted[:, chosen]
    return out
