"""What the fit needs to know of an arm: its anatomical directions, and that its segments are plain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import ArmModelError, OptionError
from armik_sym.fitting.named_axes import BODY, named_axes
from armik_sym.swivel.spherical_arm import recognise

Array = NDArray[np.float64]

_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class ArmFrame:
    """Anatomical directions of an arm of the left side.

    Attributes:
        body: Columns up, right, forward in the base frame, shape (3, 3).
        hand: Columns fingers, ulnar, dorsal in the hand frame, shape (3, 3).
        has_hand: Whether the arm has a length `hand`, from wrist to the end of the chain.
    """

    body: Array
    hand: Array
    has_hand: bool

    def to_base(self, frame: str | ArrayLike, side: str) -> Array:
        """The matrix that turns vectors of a recording into the base frame of the (left) arm.

        A right arm is mirrored, right ↔ left: then the matrix is a reflection, det = -1.

        Args:
            frame: The axes of the recording, such as "x forward, y up, z right", or the rotation matrix
                R_base_recording, before mirroring, shape (3, 3).
            side: "left" or "right".

        Returns:
            Shape (3, 3).

        Raises:
            OptionError: If frame or side cannot be understood.

        Source:
            None (definition).
        """
        if side not in ("left", "right"):
            raise OptionError(f"side is {side!r}, expected 'left' or 'right'")
        mirror = self.body @ np.diag([1.0, -1.0 if side == "right" else 1.0, 1.0]) @ self.body.T
        if isinstance(frame, str):
            return np.asarray(mirror @ self.body @ named_axes(frame, BODY, "frame"))
        return np.asarray(mirror @ _rotation(frame))


def arm_frame(arm: Arm) -> ArmFrame:
    """The anatomical directions of an arm, if it is one that points can be fitted to.

    Args:
        arm: Spherical shoulder, hinge elbow and spherical wrist, with the lengths `upper_arm`, `forearm`
            and perhaps `hand`, all in line at q = 0 or bent at the elbow only.

    Returns:
        Its directions.

    Raises:
        ArmModelError: If it is another arm; says what is missing.

    Source:
        None (this package).
    """
    if arm.up is None or arm.outward is None:
        raise ArmModelError(f"arm {arm.name!r} does not say which way is up and outward: set both")
    _check_segments(arm)
    right = -arm.outward
    return ArmFrame(
        np.column_stack([arm.up, right, np.cross(arm.up, right)]), _hand_axes(arm), "hand" in arm.lengths
    )


def _check_segments(arm: Arm) -> None:
    spherical = recognise(arm)
    if spherical.wrist is None:
        raise ArmModelError(f"points cannot be fitted: {spherical.why_no_wrist}")
    wanted = {"upper_arm", "forearm"}
    if not wanted <= arm.lengths.keys() <= wanted | {"hand"}:
        raise ArmModelError(
            f"arm {arm.name!r} has the lengths {', '.join(arm.lengths) or 'none'}, expected upper_arm, "
            "forearm and perhaps hand"
        )
    has = {
        "upper_arm": spherical.upper_arm,
        "forearm": spherical.wrist.centre - spherical.elbow,
        "hand": spherical.lines.position - spherical.wrist.centre,
    }
    for name, segment in has.items():
        length = float(np.linalg.norm(segment))
        if abs(length - arm.lengths.get(name, 0.0)) > _ROUNDING:
            raise ArmModelError(
                f"arm {arm.name!r}: the {name.replace('_', ' ')} is {length:g} m long, its length is given "
                f"as {arm.lengths.get(name, 0.0):g} m: an arm with offsets cannot be fitted to points"
            )


def _hand_axes(arm: Arm) -> Array:
    signs = {"wrist_ulnar_deviation": 1.0, "wrist_radial_deviation": -1.0}
    last = arm.joint_names[-1]
    if last not in signs:
        raise ArmModelError(
            f"arm {arm.name!r}: the last joint is {last!r}; expected wrist_ulnar_deviation or "
            "wrist_radial_deviation, which tells the sides of the hand apart"
        )
    lines = recognise(arm).lines
    axis = lines.rotation.T @ lines.direction[-1]
    fingers = np.asarray(arm.pointing_axis)
    ulnar = signs[last] * np.cross(axis, fingers)
    return np.column_stack([fingers, ulnar, np.cross(fingers, ulnar)])


def _rotation(frame: ArrayLike) -> Array:
    try:
        R = np.array(frame, dtype=np.float64)
    except (TypeError, ValueError):
        R = np.zeros(0)
    if R.shape != (3, 3) or not np.allclose(R @ R.T, np.eye(3), atol=1e-6) or np.linalg.det(R) < 0:
        raise OptionError(
            f"frame is {frame!r}, expected words such as 'x forward, y up, z right' or a rotation "
            "matrix (3, 3)"
        )
    return R
