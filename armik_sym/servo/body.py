"""What the segments of an arm weigh: a person of known mass, stature and sex."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import DriveError
from armik_sym.servo.given_number import is_number

Array = NDArray[np.float64]


class SegmentShare(NamedTuple):
    """How a segment is made, relative to the body and to its own length.

    Attributes:
        mass: Part of the mass of the body.
        centre: Distance of the centre of mass from the proximal end, part of the length.
        sagittal: Radius of gyration about the sagittal axis, part of the length.
        transverse: The same about the transverse axis.
        longitudinal: The same about the longitudinal axis.
    """

    mass: float
    centre: float
    sagittal: float
    transverse: float
    longitudinal: float


# de Leva 1996, Table 4. Lengths end at the joint centres; the hand ends at the third knuckle.
# The sagittal radius of the female hand is passed on as 0.531 and as 0.631: only the first can be that of a
# rigid body (0.531² < 0.454² + 0.335²).
SHARES: Mapping[str, Mapping[str, SegmentShare]] = {
    "male": {
        "upper_arm": SegmentShare(0.0271, 0.5772, 0.285, 0.269, 0.158),
        "forearm": SegmentShare(0.0162, 0.4574, 0.276, 0.265, 0.121),
        "hand": SegmentShare(0.0061, 0.7900, 0.628, 0.513, 0.401),
    },
    "female": {
        "upper_arm": SegmentShare(0.0255, 0.5754, 0.278, 0.260, 0.148),
        "forearm": SegmentShare(0.0138, 0.4559, 0.261, 0.257, 0.094),
        "hand": SegmentShare(0.0056, 0.7474, 0.531, 0.454, 0.335),
    },
}
_ROUNDING = 1e-9
# Wrist to third knuckle [m] of the mean subject, and the stature [m] of that subject.
_HAND_LENGTH = {"male": (0.0862, 1.741), "female": (0.0780, 1.735)}


@dataclass(frozen=True)
class Subject:
    """The person in the exoskeleton.

    Attributes:
        mass: Mass of the body, in [kg].
        stature: Height, in [m]; scales the hand, whose length no arm model holds.
        sex: "male" or "female": which column of the table.

    Raises:
        DriveError: If a value is out of range.

    Source:
        de Leva 1996, J. Biomechanics 29(9): 1223-1230, Table 4. The default is the mean male subject there.
    """

    mass: float = 73.0
    stature: float = 1.741
    sex: str = "male"

    def __post_init__(self) -> None:
        if self.sex not in tuple(SHARES):
            raise DriveError(f"subject: sex is {self.sex!r}: valid are {', '.join(SHARES)}")
        for key, least, most, unit in (("mass", 5.0, 400.0, "kg"), ("stature", 0.5, 2.8, "m")):
            value = getattr(self, key)
            if not is_number(value) or not least <= value <= most:
                raise DriveError(f"subject: {key} is {value!r}, expected {least:g} to {most:g} {unit}")

    @property
    def hand_length(self) -> float:
        """Wrist to third knuckle, in [m], scaled by stature."""
        length, stature = _HAND_LENGTH[self.sex]
        return length * self.stature / stature

    def segment_mass(self, segment: str) -> float:
        """Mass of a segment.

        Args:
            segment: "upper_arm", "forearm" or "hand".

        Returns:
            Mass, in [kg].

        Source:
            de Leva 1996, Table 4.
        """
        return self.mass * SHARES[self.sex][segment].mass


@dataclass(frozen=True, eq=False)
class RigidBody:
    """A body that moves with one frame of a chain.

    Attributes:
        name: What it is.
        frame: Index of the frame in `joint_frames`: 0 is the base, i the frame after row i.
        mass: In [kg].
        centre: Centre of mass in that frame, shape (3,), in [m].
        inertia: About the centre of mass in that frame, shape (3, 3), in [kg m²].

    Raises:
        DriveError: If the mass is negative, or a shape or the inertia is not that of a body.

    Source:
        None (definition).
    """

    name: str
    frame: int
    mass: float
    centre: Array
    inertia: Array

    def __post_init__(self) -> None:
        if not is_number(self.mass) or self.mass < 0:
            raise DriveError(f"body {self.name!r}: mass is {self.mass!r} kg, expected a number ≥ 0")
        for key, shape in (("centre", (3,)), ("inertia", (3, 3))):
            value = np.asarray(getattr(self, key), dtype=np.float64)
            if value.shape != shape or not np.isfinite(value).all():
                raise DriveError(
                    f"body {self.name!r}: {key} is {value.tolist()}, expected {shape} finite numbers"
                )
            object.__setattr__(self, key, value)
        size = float(np.abs(self.inertia).max())
        symmetric = np.abs(self.inertia - self.inertia.T).max() <= _ROUNDING * size
        if not symmetric or np.linalg.eigvalsh(self.inertia).min() < -_ROUNDING * size:
            raise DriveError(
                f"body {self.name!r}: inertia is {self.inertia.tolist()}, expected a symmetric matrix "
                "without negative eigenvalues"
            )


def slender_body(
    name: str, frame: int, mass: float, proximal: Array, along: Array, length: float, share: SegmentShare
) -> RigidBody:
    """A segment as a body: I = m L² (k_l² u uᵀ + k_t² (1 - u uᵀ)), its longer transverse radius all round.

    Args:
        name: What it is.
        frame: Index of the frame it moves with.
        mass: In [kg].
        proximal: Its proximal end in that frame, shape (3,), in [m].
        along: Unit vector to its distal end, shape (3,).
        length: In [m].
        share: Its centre of mass and radii of gyration.

    Returns:
        The body.

    Source:
        de Leva 1996, Table 4. The axis of flexion of a chain is not named, so the larger of both is taken.
    """
    outer = np.outer(along, along)
    across = max(share.sagittal, share.transverse)
    inertia = mass * length**2 * (share.longitudinal**2 * outer + across**2 * (np.eye(3) - outer))
    return RigidBody(name, frame, mass, proximal + share.centre * length * along, inertia)
