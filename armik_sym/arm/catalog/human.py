"""The human-arm model of Nguyen 2021."""

from __future__ import annotations

import math

import numpy as np

from armik_sym.arm.catalog.wrist_rows import (
    ELBOW_TO_WRIST_LOWER_DEG,
    ELBOW_TO_WRIST_UPPER_DEG,
    RIGHT_ANGLE,
    elbow_to_wrist,
)
from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHLink
from armik_sym.arm.model import Arm
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.arm.rigid_transform import rotation_x

_SHOULDER_LOWER_DEG = (-180.0, -50.0, -45.0)
_SHOULDER_UPPER_DEG = (180.0, 175.0, 70.0)

# Of a left arm with x up and y to the right.
_UP = np.array([1.0, 0.0, 0.0])
_LEFT = np.array([0.0, -1.0, 0.0])


def human(upper_arm: float = 0.28, forearm: float = 0.26, hand: float = 0.19) -> Arm:
    r"""The human-arm model: flexion first, then abduction; base at the shoulder centre.

    R_0^3 = H C_3(q') H with C_3 of eq. (7), which is Ry(-q'1) Rz(-q'2) Ry(-q'3), H = diag(-1, 1, -1), and
    q'1 = -flexion, q'2 = abduction - 90°, q'3 = internal rotation + 90°. With the q' of eq. (8) this is
    R_0^3 of the E-HMCS: `armik_sym.elbow.human_posture` converts (ledger: nguyen2021 6-7 and nguyen2021 8).

    Printed, used, and why:

    - *Joint order.* The paper prints no DH table for this arm. Eq. (7) is a rotation and factors into
      turns about y, z, y in the base frame of the E-HMCS (x up, z forward, y right): flexion comes
      first, abduction second, the reverse of the E-HMCS ("different order of the first two joints",
      §2.3). From the elbow on, the rows of Table 4 apply ("will coincide").
    - *Zero.* In the angles q' of eq. (8) the hanging arm is (0°, -90°, 90°). The joints here count from
      the hanging arm, as Table 2's limits do; the shift is the line above. H is the half turn about y
      (in the base and about the upper arm) by which what eq. (8) solves differs from "B3 = C3".
    - *Range of motion.* Table 2, column "Model" (its column "Human" prints 165/-50 for flexion, where
      the model has ±180, and 75/-70 for the wrist, where it has ±73), as printed, but for the wrist
      deviation: the wrist rows of Table 4 count towards ulnar, so "radial 20 / ulnar -40" reads
      -20…+40 (see `ehmcs`). Recorded arms agree: of 27 real trials, 24 can be followed with -20…+40
      and 22 with -40…+20 (`examples/05_real_trials.py`).
    - *Side.* A left arm, as the E-HMCS; mirror y for a right one.

    Args:
        upper_arm: Shoulder to elbow, in [m].
        forearm: Elbow to wrist, in [m].
        hand: Wrist to the end of the chain along the fingers, in [m]; 0 ends it at the wrist.

    Returns:
        The arm; default lengths are those of the model in Table 1.

    Raises:
        ArmModelError: If a length is negative, not finite or above 5 m.

    Source:
        Nguyen 2021, eq. 6-8 (joint order), Table 1 (lengths), Table 2 (range of motion), Table 4.
    """
    rows = (
        DHLink("shoulder_flexion", theta=math.pi, sign=-1, alpha=-RIGHT_ANGLE),
        DHLink("shoulder_abduction", theta=RIGHT_ANGLE, sign=-1, alpha=RIGHT_ANGLE),
        DHLink("shoulder_internal_rotation", theta=-RIGHT_ANGLE, d="upper_arm", alpha=-RIGHT_ANGLE),
        *elbow_to_wrist(hand="hand"),
    )
    return Arm(
        name="human",
        chain=DHChain(rows, base=rotation_x(RIGHT_ANGLE)),
        rom=RangeOfMotion.from_degrees(
            _SHOULDER_LOWER_DEG + ELBOW_TO_WRIST_LOWER_DEG, _SHOULDER_UPPER_DEG + ELBOW_TO_WRIST_UPPER_DEG
        ),
        lengths={"upper_arm": upper_arm, "forearm": forearm, "hand": hand},
        description="human-arm model, Nguyen 2021, eq. 6-7 and Tables 1-2 (left arm, x up, z forward)",
        up=_UP,
        outward=_LEFT,
    )
