"""The kinematic quantities that are compiled, as CasADi Functions of (q, lengths)."""

from __future__ import annotations

import casadi as ca

from armik_sym.symbolic import ArmExpressions


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
    return {name: _function(arm, name, value) for name, value in quantities.items()}


def row_by_row(matrix: ca.SX) -> ca.SX:
    """Entries of a matrix row by row, the order of NumPy and C.

    Args:
        matrix: SX of shape (m, n).

    Returns:
        SX of shape (m·n, 1).

    Source:
        None (CasADi stores column by column).
    """
    return ca.vec(ca.densify(matrix).T)


def _function(arm: ArmExpressions, name: str, value: ca.SX) -> ca.Function:
    out = ca.cse(ca.densify(value))
    return ca.Function(name, [arm.q, arm.lengths], [out], ["q", "lengths"], ["out"])
