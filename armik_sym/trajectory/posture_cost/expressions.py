"""The cost of one posture and its exact derivatives, as CasADi Functions."""

from __future__ import annotations

import casadi as ca

from armik_sym.symbolic import ArmExpressions
from armik_sym.symbolic.dense_function import dense_function


def cost_functions(arm: ArmExpressions, *, elbow: bool) -> dict[str, ca.Function]:
    """Value, gradient and Hessian of what a posture costs per second.

    ℓ(q) = ½ Σ_j w_j·[φ((q_j - lower_j)/c_j) + φ((upper_j - q_j)/c_j)] + ½ w_e·(1 - d·u(q))

    with φ(x) = max(1 - x, 0)³ and the unit vector u(q) from shoulder to elbow. u is fixed to the upper arm:
    u(q) = R_base_upperarm(q)·u_upperarm, where R_base_upperarm comes from the kinematic chain.

    Args:
        arm: Symbolic kinematics with lengths as parameters.
        elbow: Whether the second term is there; without it, all arms with equally many joints share the
            functions.

    Returns:
        `posture_value` (q, lengths, parameters) → ℓ, shape (1, 1); `posture_gradient` → dℓ/dq, shape
        (dof, 1); `posture_hessian` → d²ℓ/dq² column by column, shape (dof·dof, 1). Parameters: w, lower,
        upper, c, (dof,) each; with the second term also w_e, u_upperarm (3,), d (3,). The lengths are there
        because all functions of one sample have them; the cost does not depend on them.

    Source:
        None (this package).
    """
    dof = arm.arm.dof
    parameters = ca.SX.sym("parameters", 4 * dof + (7 if elbow else 0))
    weight, lower, upper, distance = ca.vertsplit(parameters[: 4 * dof], dof)
    near = _near((arm.q - lower) / distance) + _near((upper - arm.q) / distance)
    cost = 0.5 * ca.dot(weight, near)
    if elbow:
        elbow_weight, in_upper_arm, wanted = ca.vertsplit(parameters[4 * dof :], [0, 1, 4, 7])
        direction = arm.frames[upper_arm_frame(arm)][:3, :3] @ in_upper_arm
        cost += 0.5 * elbow_weight * (1 - ca.dot(wanted, direction))
    hessian, gradient = ca.hessian(cost, arm.q)
    inputs = {"q": arm.q, "lengths": arm.lengths, "parameters": parameters}
    values = {"value": cost, "gradient": gradient, "hessian": ca.vec(hessian)}
    return {
        f"posture_{name}": dense_function(f"posture_{name}", inputs, expression)
        for name, expression in values.items()
    }


def upper_arm_frame(arm: ArmExpressions) -> int:
    """Index of the frame that turns with the third joint and no further one: it is fixed to the upper arm.

    Args:
        arm: Symbolic kinematics of an arm with three joints in the shoulder.

    Returns:
        Index into `arm.frames`.

    Source:
        Siciliano et al., Robotics (2009), §2.8.
    """
    moving = [i for i, link in enumerate(arm.arm.chain.links) if link.moves]
    return moving[2] + 1


def _near(x: ca.SX) -> ca.SX:
    return ca.fmax(1 - x, 0) ** 3
