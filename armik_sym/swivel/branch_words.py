"""What the branches of the closed form are called: by the angles of the joint that tells them apart."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import TURN
from armik_sym.swivel.geometry import ELBOW_ZERO, pose_geometry, position_geometry
from armik_sym.swivel.spherical_arm import SphericalArm

ONLY_BRANCH = "the only branch the range of motion allows"

# Less overlap with the range of motion than this is none, in [rad].
_NO_ROOM = 1e-9

Half = tuple[float, float]


def branch_names(
    spherical: SphericalArm, branches: NDArray[np.int64], rest: NDArray[np.float64]
) -> list[str]:
    """One name per branch, such as "shoulder flexion -90° to 90°".

    A branch is a choice of sign for the sine of the elbow, of the second joint of the shoulder and of the
    second joint of the wrist, that is, of one half of their turn. Only joints whose range of motion leaves
    a choice are named, and those whose range excludes the branch.

    Args:
        spherical: The arm.
        branches: Signs of elbow, shoulder and wrist, shape (b, 3).
        rest: Angles of the joints after the elbow if they are given, shape (dof - 4,), in [rad]; empty for
            poses.

    Returns:
        The names.

    Source:
        None (this package).
    """
    return [_name(spherical, [int(sign) for sign in signs], rest) for signs in branches]


def _name(spherical: SphericalArm, signs: list[int], rest: NDArray[np.float64]) -> str:
    parts = []
    for joint, offset, sign in zip(*_tellers(spherical, rest), signs, strict=False):
        mine, other = (_half(spherical, joint, offset, s) for s in (sign, -sign))
        if not _room(spherical, joint, mine):
            parts.append(_words(spherical, joint, mine) + " (outside its range)")
        elif _room(spherical, joint, other):
            parts.append(_words(spherical, joint, mine))
    return ", ".join(parts) or ONLY_BRANCH


def _tellers(spherical: SphericalArm, rest: NDArray[np.float64]) -> tuple[list[int], list[float]]:
    """The joints whose sines tell the branches apart, and from where their angles count."""
    dof = spherical.arm.dof
    still = rest if rest.size else np.zeros(dof - 4)
    # Without joints after the elbow that were given, the elbow's zero is that of the wrist.
    zero = _elbow_zero(spherical, still, bool(rest.size) or spherical.wrist is None)
    joints, offsets = [3, 1], [zero, spherical.shoulder.offset]
    if spherical.wrist is not None and not rest.size:
        joints.append(5)
        offsets.append(spherical.wrist.offset)
    return joints, offsets


def _elbow_zero(spherical: SphericalArm, rest: NDArray[np.float64], to_hand: bool) -> float:
    if to_hand:
        return float(position_geometry(spherical, rest[None])[0, ELBOW_ZERO[0]])
    return float(pose_geometry(spherical)[ELBOW_ZERO[0]])


def _half(spherical: SphericalArm, joint: int, offset: float, sign: int) -> Half:
    """The half turn of a joint in which sin(q + offset) has a sign, where it overlaps the range most."""
    start = -offset if sign > 0 else -math.pi - offset
    middle = float(spherical.arm.rom.middle[joint])
    start += TURN * round((middle - start - math.pi / 2) / TURN)
    return start, start + math.pi


def _room(spherical: SphericalArm, joint: int, half: Half) -> bool:
    rom = spherical.arm.rom
    return min(half[1], float(rom.upper[joint])) - max(half[0], float(rom.lower[joint])) > _NO_ROOM


def _words(spherical: SphericalArm, joint: int, half: Half) -> str:
    name = spherical.arm.joint_names[joint].replace("_", " ")
    low, high = (round(math.degrees(angle), 1) + 0.0 for angle in half)
    if abs(low + high) == 360:
        return f"{name} beyond ±{min(abs(low), abs(high)):g}°"
    return f"{name} {low:g}° to {high:g}°"
