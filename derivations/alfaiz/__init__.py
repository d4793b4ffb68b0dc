"""Al-Faiz, Ali, Miry: the arm in closed form around one variable φ, and the optimisation of φ.

Human arm inverse kinematic solution based geometric relations and optimization algorithm.
"""

from __future__ import annotations

import re

from derivations.claim import Claim


def claims() -> tuple[Claim, ...]:
    """The claims about this paper, in its order; what it does not say itself comes last.

    Returns:
        The claims.

    Source:
        Al-Faiz.
    """
    from derivations.alfaiz import (
        damped_svd_step,
        elbow_angle,
        levenberg_marquardt,
        newton_step,
        orientation_residual,
        residuals,
        shoulder_phi,
        shoulder_position,
        shoulder_radius,
        shoulder_second_angle,
        shoulder_third_angle,
        solution_count,
        swivel_meaning,
        table,
        transforms,
        wrist_angles,
        wrist_rotation,
    )

    modules = (
        transforms,
        table,
        elbow_angle,
        shoulder_position,
        shoulder_phi,
        shoulder_radius,
        shoulder_third_angle,
        shoulder_second_angle,
        wrist_rotation,
        wrist_angles,
        residuals,
        orientation_residual,
        newton_step,
        levenberg_marquardt,
        damped_svd_step,
        solution_count,
        swivel_meaning,
    )
    return tuple(sorted((claim for module in modules for claim in module.CLAIMS), key=_place))


def _place(claim: Claim) -> float:
    """Number of the equation; Table 1 and its matrices stand between (2) and (3)."""
    number = re.match(r"\d+", claim.equation)
    if number:
        return float(number[0])
    return 2.5 if claim.equation in ("Table 1", "A_1…A_7") else float("inf")
