"""What `fit_arm` answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.fitting.quality import FitQuality
from armik_sym.fitting.spread import Spread
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.joint_motion import JointMotion

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False, repr=False)
class FittedArm:
    """An arm fitted to recorded points, the path of its hand, and what its joints did.

    All vectors of n samples are in the base frame of `arm` unless said otherwise; that of a right arm is
    mirrored, right ↔ left, because the arms of the catalogue are left ones: its angles keep their anatomical
    meaning, its positions are those of a left arm.

    Attributes:
        arm: The arm with the segment lengths of the person.
        path: What the hand did.
        measured: Joint angles inside the range of motion: the hand as in `path`, the elbow of its circle
            nearest to the recorded one, and each joint at its limit where `unlimited` is outside.
        unlimited: The same before the limits.
        lengths: Segment lengths with their spread.
        side: "left" or "right": the arm that was recorded.
        base: "fixed" or "moving".
        shoulder: Mean shoulder centre in the axes of the recording, shape (3,), in [m].
        shoulder_sd: Its standard deviation along these axes, shape (3,), in [m].
        to_base: Turns vectors of the recording into the base frame, shape (3, 3); det = -1 for a right arm.
        elbow: Recorded elbow, shape (n, 3), in [m].
        wrist: Recorded wrist, shape (n, 3), in [m].
        sample: Indices of the n samples in the recording, shape (n,).
        outside: Whether `unlimited` leaves the range of motion, shape (n,).
        out_of_reach: Whether the hand is farther away than the arm is long, shape (n,).
        straight: Whether the arm is so straight that the elbow does not tell the swivel angle, shape (n,).
        quality: How far all this can be trusted.
    """

    arm: Arm
    path: HandPath
    measured: JointMotion
    unlimited: JointMotion
    lengths: Mapping[str, Spread]
    side: str
    base: str
    shoulder: Array
    shoulder_sd: Array
    to_base: Array
    elbow: Array
    wrist: Array
    sample: NDArray[np.int64]
    outside: Flags
    out_of_reach: Flags
    straight: Flags
    quality: FitQuality

    @property
    def mirrored(self) -> bool:
        """Whether positions are mirrored, right ↔ left."""
        return self.side == "right"

    @property
    def n(self) -> int:
        """Number of samples."""
        return len(self.sample)

    def __str__(self) -> str:
        from armik_sym.fitting.text import summary  # it reads this class

        return summary(self)

    def __repr__(self) -> str:
        return (
            f"FittedArm({self.side} arm, {self.n} samples, {self.base} base, "
            f"{', '.join(f'{name} {1000 * s.mean:.1f} mm' for name, s in self.lengths.items())})"
        )
