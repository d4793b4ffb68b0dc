"""`swivel_map`: the map of an arm and a hand path."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.errors import ArmModelError, LimitError, OptionError, ShapeError
from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.closed_form import position_curve
from armik_sym.swivel.intervals import feasible_intervals, intervals_of_curves
from armik_sym.swivel.map_class import BranchBreak, SwivelMap, SwivelPath
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import SphericalArm, recognise

__all__ = ["BranchBreak", "SwivelMap", "SwivelPath", "swivel_map"]

Array = NDArray[np.float64]


def swivel_map(
    arm: Arm,
    path: HandPath,
    reference: ArrayLike | None = None,
    backend: Backend = "auto",
    *,
    wrist: ArrayLike | None = None,
) -> SwivelMap:
    """The swivel map of an arm and a hand path.

    Args:
        arm: The arm: spherical shoulder, hinge elbow, spherical wrist.
        path: The hand path, with rotation, n samples.
        reference: Where the elbow points at ψ = 0 at the first sample, a direction in the base frame, shape
            (3,); where it points at q = 0 if left out. It is carried along the path without turning about
            the line from shoulder to wrist, so that ψ never jumps.
        backend: "auto" (compiled C if possible), "c" or "vm".
        wrist: Angles of the joints after the elbow, shape (dof - 4,) or (n, dof - 4), in [rad]: then only
            the positions of the path are followed, with these joints standing still or moving as given, and
            the elbow swivels about the line from shoulder to hand.

    Returns:
        The map.

    Raises:
        ArmModelError: If the arm has no closed form; says why.
        OptionError: If arm or path is none, the reference has no length, or the path has no rotation and
            `wrist` is left out.
        LimitError: If `wrist` is outside the range of motion.
        ShapeError: If shapes do not fit.

    Source:
        Shimizu et al. (2008); Al-Faiz, eq. 4-47, corrected; None (this package) for the map.
    """
    _check_types(arm, path)
    direction = _checked_direction(reference)
    spherical = recognise(arm)
    if wrist is not None:
        return _of_positions(spherical, path, direction, wrist, backend)
    if path.rotation is None:
        raise OptionError(
            "the path has no rotation: its positions leave the wrist free, too, and there is one map for "
            "each posture of the wrist: give the angles of the joints after the elbow as wrist="
        )
    if spherical.wrist is None:
        raise ArmModelError(f"no swivel map: {spherical.why_no_wrist}")
    along = wrist_directions(spherical, path.position, path.rotation)
    carried = transported_reference(spherical, along, direction)
    intervals = feasible_intervals(spherical, path.position, path.rotation, carried, backend)
    return SwivelMap(arm, path, spherical, carried, intervals, backend=backend)


def _of_positions(
    spherical: SphericalArm, path: HandPath, direction: Array | None, wrist: ArrayLike, backend: Backend
) -> SwivelMap:
    rest = _checked_wrist(spherical.arm, wrist, len(path))
    carried = transported_reference(spherical, path.position - spherical.shoulder.centre, direction)
    one, other = (position_curve(spherical, path.position, rest, side, carried, backend) for side in (1, -1))
    intervals = intervals_of_curves((one, other), backend)
    return SwivelMap(spherical.arm, path, spherical, carried, intervals, rest, backend)


def _check_types(arm: object, path: object) -> None:
    if not isinstance(arm, Arm):
        raise OptionError(f"arm is {arm!r}, expected an Arm: use load_arm(NAME or FILE)")
    if not isinstance(path, HandPath):
        raise OptionError(f"path is a {type(path).__name__}, expected a HandPath: use read_path(FILE)")


def _checked_direction(reference: ArrayLike | None) -> Array | None:
    if reference is None:
        return None
    try:
        direction = np.array(reference, dtype=np.float64)
    except (TypeError, ValueError):
        raise OptionError(f"reference is {reference!r}, expected a direction (3,)") from None
    if direction.shape != (3,):
        raise ShapeError(f"reference {direction.shape}: expected a direction (3,)")
    return direction


def _checked_wrist(arm: Arm, wrist: ArrayLike, n: int) -> Array:
    rest, after = np.array(wrist, dtype=np.float64), arm.dof - 4
    if rest.shape not in ((after,), (n, after)):
        raise ShapeError(
            f"wrist {rest.shape}: expected ({after},) or ({n}, {after}), the joints after the elbow"
        )
    rest = np.broadcast_to(rest, (n, after)).copy()
    outside = np.argwhere(~((rest >= arm.rom.lower[4:]) & (rest <= arm.rom.upper[4:])))
    if outside.size:
        sample, j = (int(i) for i in outside[0])
        low, high = (np.rad2deg(limit[4 + j]) for limit in (arm.rom.lower, arm.rom.upper))
        raise LimitError(
            f"wrist: {arm.joint_names[4 + j]} is {np.rad2deg(rest[sample, j]):.4g}° at sample {sample}, its "
            f"range of motion is {low:.4g}° to {high:.4g}°"
        )
    return rest
