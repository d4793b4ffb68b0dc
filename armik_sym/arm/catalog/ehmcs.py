"""The exoskeleton E-HMCS of Nguyen 2021."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armik_sym.arm.catalog.wrist_rows import (
    ELBOW_TO_WRIST_LOWER_DEG,
    ELBOW_TO_WRIST_UPPER_DEG,
    RIGHT_ANGLE,
    elbow_to_wrist,
)
from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHLink, JointType
from armik_sym.arm.model import Arm
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.errors import OptionError

_BASE_TO_SHOULDER = 0.143
_UPPER_ARM = 0.2869
_FOREARM = 0.336

_SHOULDER_LOWER_DEG = (-50.0, -180.0, -45.0)
_SHOULDER_UPPER_DEG = (175.0, 180.0, 70.0)

# Of a left arm with x up and y to the right.
_UP = np.array([1.0, 0.0, 0.0])
_LEFT = np.array([0.0, -1.0, 0.0])

_FINGERS = np.array([1.0, 0.0, 0.0])
_FOREARM_OF_FRAME_5 = np.array([0.0, 1.0, 0.0])


def ehmcs(dof: int = 7) -> Arm:
    r"""The arm-worn measuring exoskeleton E-HMCS; the hand frame sits at the wrist.

    T_0^7 = Π Rz(θ_i) Tz(d_i) Tx(a_i) Rx(α_i), position as in eq. (3).

    Printed, used, and why:

    - *Convention.* Eq. (1) is printed in the layout of the modified (proximal) convention, with two
      sign errors and one wrong factor in its third row, so that it is no rigid transform. Read as
      modified rows, Table 4 misses eq. (3) by up to 0.96 m. Read as **standard** rows it gives eq. (3)
      exactly: standard is used.
    - *Row 2, d.* Table 4 prints 7 mm; eq. (3) holds with 0 only (7 mm misses it by 7 mm). Which of the two
      is wrong cannot be told; eq. (3) is followed: **0** is used.
    - *Range of motion.* Table 3 says "equivalent to the human arm": Table 2, column "Model". Table 2
      does not say which joint turns which way; the geometry does. At q = 0 the upper arm points along
      -x, and the elbow bends it towards +z: x is up, z forward, y therefore to the right. With these
      axes q1…q5 increase in abduction, flexion, internal rotation, elbow flexion and pronation, each
      as in Table 2, **if the arm is a left arm**; a right arm is its mirror image (y → -y). The same
      geometry makes q7 increase towards *ulnar* deviation, so Table 2's "radial 20 / ulnar -40"
      becomes -20…+40 here, and q6 increase in extension (±73, symmetric).

    Args:
        dof: 7 for all joints of Table 4; 5 for the joints the device measures (q1…q5); 4 for those
            the wrist position depends on (q1…q4). The joints left out stay at 0; with 4 and 5 the
            chain ends at frame 5, whose origin is the wrist.

    Returns:
        The arm; segment lengths `upper_arm` 0.2869 m and `forearm` 0.336 m.

    Raises:
        OptionError: If `dof` is not 4, 5 or 7.

    Source:
        Nguyen 2021, Table 4 and eq. 1-3 (chain), Tables 2 and 3 (range of motion); ledger: nguyen2021 1,
        nguyen2021 3, nguyen2021 Table 2, nguyen2021 Table 4.
    """
    if dof not in (4, 5, 7):
        raise OptionError(f"ehmcs: dof is {dof!r}, expected 7 (all), 5 (measured) or 4 (wrist position)")
    rows = [
        DHLink("shoulder_abduction", d=_BASE_TO_SHOULDER, alpha=RIGHT_ANGLE),
        DHLink("shoulder_flexion", theta=RIGHT_ANGLE, sign=-1, alpha=-RIGHT_ANGLE),
        DHLink("shoulder_internal_rotation", d="upper_arm", alpha=-RIGHT_ANGLE),
        *elbow_to_wrist(),
    ]
    if dof < 7:
        rows = rows[:5]
    if dof == 4:
        rows[4] = replace(rows[4], joint=JointType.FIXED)
    lower = (_SHOULDER_LOWER_DEG + ELBOW_TO_WRIST_LOWER_DEG)[:dof]
    upper = (_SHOULDER_UPPER_DEG + ELBOW_TO_WRIST_UPPER_DEG)[:dof]
    return Arm(
        name="ehmcs" if dof == 7 else f"ehmcs_{dof}dof",
        chain=DHChain(tuple(rows)),
        rom=RangeOfMotion.from_degrees(lower, upper),
        lengths={"upper_arm": _UPPER_ARM, "forearm": _FOREARM},
        pointing_axis=_FINGERS if dof == 7 else _FOREARM_OF_FRAME_5,
        description="E-HMCS exoskeleton, Nguyen 2021, Table 4 (left arm, x up, z forward)",
        up=_UP,
        outward=_LEFT,
    )
