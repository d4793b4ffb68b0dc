"""Rows 4 to 7 of Nguyen 2021, Table 4: elbow, forearm and wrist.

The E-HMCS and the human-arm model share them: "from q4 onward the angles coincide" (§2.3).
"""

from __future__ import annotations

import math

from armik_sym.arm.dh import DHLink

RIGHT_ANGLE = math.pi / 2

# Table 2, column "Model", for the five movements both arms share, in degrees and with the sign in
# which the joint variable counts (see `ehmcs` for how the geometry decides the signs).
ELBOW_TO_WRIST_LOWER_DEG = (0.0, -110.0, -73.0, -20.0)
ELBOW_TO_WRIST_UPPER_DEG = (145.0, 75.0, 73.0, 40.0)


def elbow_to_wrist(hand: float | str = 0.0) -> tuple[DHLink, ...]:
    """Rows 4 to 7 of Table 4: T = Rz(θ) Tz(d) Tx(a) Rx(α) each.

    Args:
        hand: Shift along the fingers in the last row, in [m], or the name of a segment length;
            Table 4 prints 0, which puts the end of the chain at the wrist.

    Returns:
        Four links.

    Source:
        Nguyen 2021, Table 4.
    """
    return (
        DHLink("elbow_flexion", alpha=RIGHT_ANGLE),
        DHLink("forearm_pronation", theta=RIGHT_ANGLE, d="forearm", alpha=RIGHT_ANGLE),
        DHLink("wrist_extension", theta=RIGHT_ANGLE, alpha=-RIGHT_ANGLE),
        DHLink("wrist_ulnar_deviation", a=hand),
    )
