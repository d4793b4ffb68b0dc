"""CasADi expressions of an arm: forward kinematics, Jacobians, residuals."""

from armik_sym.symbolic.arm_expressions import ArmExpressions, express
from armik_sym.symbolic.tracking_residual import Orientation, TrackingResidual, tracking_residual

__all__ = ["ArmExpressions", "Orientation", "TrackingResidual", "express", "tracking_residual"]
