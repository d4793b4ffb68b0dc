"""The seven-joint human arm of Al-Faiz, Ali and Miry."""

from __future__ import annotations

import math

import numpy as np

from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHConvention, DHLink
from armik_sym.arm.model import Arm
from armik_sym.arm.range_of_motion import RangeOfMotion

_RIGHT_ANGLE = math.pi / 2
_LOWER_DEG = (-180.0, -180.0, -180.0, 0.0, -90.0, -90.0, -180.0)
_UPPER_DEG = (180.0, 180.0, 180.0, 145.0, 90.0, 90.0, 180.0)


def alfaiz(upper_arm: float = 0.30, forearm: float = 0.24) -> Arm:
    r"""The arm of Al-Faiz: spherical shoulder, hinge elbow, spherical wrist; hand frame at the wrist.

    T = A_1 … A_7 with A_i = Rx(α_i) Tx(a_i) Rz(θ_i) Tz(d_i) (eq. 2).

    Printed, used, and why:

    - *Convention.* Eq. (2) is the **modified** (proximal) transform, printed with b_i for a_i; the
      product in words before it ("Rot_z,α Trans_x Rot_z Trans_z") misprints Rot_x as Rot_z.
    - *Row 6, α.* Table 1 prints -π/2, matrix A_6 is written with +π/2. Eq. (38)-(46) hold with
      **+π/2** only; it is used.
    - *s2, c2, s6, c6.* Eq. (7), (8), (23) and (38)-(46) hold with sines and cosines of the joint angle
      q_i without the offset of Table 1, although A_2 and A_6 are printed "of theta".
    - *Lengths.* The upper arm is L4 in Table 1 and l4 in the equations; the forearm is L5 in Table 1,
      l5 in A_5 and l3 in the equations. Table 1 is in centimetres. No numbers are printed; the averages
      of Nguyen 2021, Table 1 (0.30 and 0.24 m) are used.
    - *Range of motion.* None is printed. These joints are no anatomical movements: q2 and q3 swing the
      upper arm, q7 rolls the hand about its own axis. Used: the elbow as in Nguyen 2021, Table 2
      (0…145°), ±90° for the two bends of the wrist (where asin in eq. 40 is one-to-one), a full turn
      elsewhere. Narrow it for a patient with `with_rom` or a patient file.

    Args:
        upper_arm: Shoulder to elbow (l4), in [m].
        forearm: Elbow to wrist (l3 in eq. 5, L5 in Table 1), in [m].

    Returns:
        The arm.

    Raises:
        ArmModelError: If a length is negative, not finite or above 5 m.

    Source:
        Al-Faiz, Table 1, eq. 2-3, checked against eq. 7, 8, 23 and 38-46; ledger: alfaiz 2, alfaiz Table 1,
        alfaiz 7, alfaiz 23, alfaiz 38.
    """
    rows = (
        DHLink("shoulder_1", alpha=_RIGHT_ANGLE),
        DHLink("shoulder_2", theta=_RIGHT_ANGLE, alpha=_RIGHT_ANGLE),
        DHLink("shoulder_3", alpha=-_RIGHT_ANGLE),
        DHLink("elbow_flexion", a="upper_arm", alpha=_RIGHT_ANGLE),
        DHLink("wrist_1", a="forearm", alpha=-_RIGHT_ANGLE),
        DHLink("wrist_2", theta=-_RIGHT_ANGLE, alpha=_RIGHT_ANGLE),
        DHLink("wrist_3", alpha=-_RIGHT_ANGLE),
    )
    return Arm(
        name="alfaiz",
        chain=DHChain(rows, convention=DHConvention.MODIFIED),
        rom=RangeOfMotion.from_degrees(_LOWER_DEG, _UPPER_DEG),
        lengths={"upper_arm": upper_arm, "forearm": forearm},
        pointing_axis=np.array([0.0, 0.0, 1.0]),
        description="seven-joint human arm, Al-Faiz, Table 1 (y up)",
        up=np.array([0.0, 1.0, 0.0]),
    )
