"""How far the hand is from one sample of the path, as smooth equations for a solver."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import casadi as ca

from armik_sym.symbolic.arm_expressions import ArmExpressions
from armik_sym.symbolic.orientation import vee_of_difference


class Orientation(Enum):
    """How much of the hand's orientation a path prescribes.

    FULL: all of it. POINTING: only where the fingers point. NONE: nothing, position only.
    """

    FULL = "full"
    POINTING = "pointing"
    NONE = "none"

    @property
    def target_size(self) -> int:
        """Numbers in one target: position (3) and rotation (9), or direction and two normals (9)."""
        return 3 if self is Orientation.NONE else 12

    @property
    def equations(self) -> int:
        """Equations per sample."""
        return {Orientation.FULL: 6, Orientation.POINTING: 5, Orientation.NONE: 3}[self]


@dataclass(frozen=True, eq=False)
class TrackingResidual:
    """Residual of one sample and the symbols it depends on.

    Attributes:
        target: The sample's target, SX of shape (orientation.target_size, 1).
        residual: SX of shape (orientation.equations, 1): position [m], then orientation [rad].
    """

    target: ca.SX
    residual: ca.SX


def tracking_residual(arm: ArmExpressions, orientation: Orientation) -> TrackingResidual:
    """Residual r(q, target) that is zero exactly where the hand is on the sample.

    r = [p(q) - p*; e]. Full: e = 2 tan(θ/2)·axis of E = R*ᵀ R(q), which is 2 vee(E - Eᵀ)/(1 + tr E);
    unlike sin θ·axis it does not vanish at 180°. Pointing: with f = R(q)·pointing_axis, wanted
    direction d and normals b1, b2: e = 2 (b1·f, b2·f)/(1 + d·f), zero only for f = d.

    Args:
        arm: Symbolic kinematics.
        orientation: What the path prescribes.

    Returns:
        The residual and its target symbol: position [m], then R* row by row, or d, b1, b2.

    Source:
        None (Gibbs-Rodrigues vector); compare Al-Faiz, eq. 50-53.
    """
    target = ca.SX.sym("target", orientation.target_size)
    parts = [arm.position - target[:3]]
    if orientation is Orientation.FULL:
        R_target = ca.reshape(target[3:], 3, 3).T
        E = R_target.T @ arm.rotation
        parts.append(2 * vee_of_difference(E) / (1 + ca.trace(E)))
    elif orientation is Orientation.POINTING:
        fingers = arm.rotation @ ca.DM(arm.arm.pointing_axis)
        direction, b1, b2 = target[3:6], target[6:9], target[9:12]
        across = ca.vertcat(ca.dot(b1, fingers), ca.dot(b2, fingers))
        parts.append(2 * across / (1 + ca.dot(direction, fingers)))
    return TrackingResidual(target, ca.vertcat(*parts))
