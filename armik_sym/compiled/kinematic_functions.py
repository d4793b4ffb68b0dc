"""The kinematic quantities that are compiled, as CasADi Functions of (q, lengths)."""

from __future__ import annotations

import casadi as ca

from armik_sym.symbolic import ArmExpressions
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.symbolic.row_order import row_by_row


def kinematic_functions(arm: ArmExpressions) -> dict[str, ca.Function]:
    """CasADi Functions for one posture; every output is a vector with the entries row by row.

    position p(q), rotation R(q), jacobian J(q), and all three at once, which shares the sines.

    Args:
        arm: Symbolic kinematics with segment lengths as parameters.

    Returns:
        Functions (q, lengths) → vector: `position` (3), `rotation` (9), `jacobian` (6·dof),
        `pose_and_jacobian` (3 + 9 + 6·dof).

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    rotation, jacobian = row_by_row(arm.rotation), row_by_row(arm.jacobian)
    quantities = {
        "position": arm.position,
        "rotation": rotation,
        "jacobian": jacobian,
        "pose_and_jacobian": ca.vertcat(arm.position, rotation, jacobian),
    }
    inputs = {"q": arm.q, "lengths": arm.lengths}
    return {name: dense_function(name, inputs, value) for name, value in quantities.items()}
