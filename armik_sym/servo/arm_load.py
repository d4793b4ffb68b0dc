"""Bodies of an arm: where upper arm, forearm and hand are on its chain, and what they weigh."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import DHConvention
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.errors import DriveError
from armik_sym.servo.body import SHARES, RigidBody, SegmentShare, Subject, slender_body

Array = NDArray[np.float64]

# A part of the device: a thin rod of the length of the segment, its mass in the middle.
_ROD = SegmentShare(1.0, 0.5, 12**-0.5, 12**-0.5, 0.0)
_SAME = 1e-9


def bodies_of(
    arm: Arm, subject: Subject | None = None, moving_mass: Mapping[str, float] | None = None
) -> tuple[RigidBody, ...]:
    """The segments of the person, and what moves with them of the device.

    Upper arm and forearm lie where the chain uses the segment lengths of these names; the hand begins at the
    wrist and points along the fingers. The whole forearm turns with pronation, which makes its torque a
    little too large.

    Args:
        arm: The arm.
        subject: The person; None for the mean male subject.
        moving_mass: Mass of the device at upper_arm, forearm and hand, in [kg]; None for none.

    Returns:
        Bodies, those without mass left out.

    Raises:
        DriveError: If the chain has no segment lengths `upper_arm` and `forearm`.

    Source:
        de Leva 1996, Table 4 (segments); this package (the rest).
    """
    person = Subject() if subject is None else subject
    extra = moving_mass or {}
    middle = joint_frames(arm.chain, arm.rom.middle[None], arm.lengths)[0]
    bodies: list[RigidBody] = []
    for name in ("upper_arm", "forearm"):
        frame, proximal, distal = _ends(arm, middle, name)
        length = float(np.linalg.norm(distal - proximal))
        if length < _SAME:
            raise DriveError(f"arm {arm.name!r}: segment {name!r} has no length")
        along = (distal - proximal) / length
        bodies += _pair(name, frame, proximal, along, length, person, extra)
    wrist = (middle[frame] @ np.append(distal, 1.0))[:3]
    last = len(middle) - 1
    start = middle[last, :3, :3].T @ (wrist - middle[last, :3, 3])
    bodies += _pair("hand", last, start, arm.pointing_axis, person.hand_length, person, extra)
    return tuple(body for body in bodies if body.mass > 0)


def _pair(
    name: str,
    frame: int,
    start: Array,
    along: Array,
    length: float,
    person: Subject,
    extra: Mapping[str, float],
) -> list[RigidBody]:
    share = SHARES[person.sex][name]
    mass, device = person.segment_mass(name), float(extra.get(name, 0.0))
    return [
        slender_body(name, frame, mass, start, along, length, share),
        slender_body(f"device at {name}", frame, device, start, along, length, _ROD),
    ]


def _ends(arm: Arm, frames: Array, name: str) -> tuple[int, Array, Array]:
    """The frame a segment moves with, and its ends in that frame."""
    for i, link in enumerate(arm.chain.links, 1):
        if name not in link.length_names:
            continue
        # A shift along x of a modified row comes before the joint turns, so it belongs to the frame before.
        before = arm.chain.convention is DHConvention.MODIFIED and link.a == name
        frame = i - 1 if before else i
        T = frames[frame]
        ends = [T[:3, :3].T @ (frames[k][:3, 3] - T[:3, 3]) for k in (i - 1, i)]
        return frame, ends[0], ends[1]
    raise DriveError(
        f"arm {arm.name!r} has no segment length {name!r} (it has {', '.join(arm.lengths) or 'none'}), so it "
        "is not known where the masses are: give them as bodies=(RigidBody(...), ...)"
    )
