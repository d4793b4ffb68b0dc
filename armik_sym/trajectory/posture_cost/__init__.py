"""Costs of single postures: room to the limits of the joints, and where the elbow should be."""

from armik_sym.trajectory.posture_cost.cost import PostureCost, posture_cost
from armik_sym.trajectory.posture_cost.preference import preferred_posture

__all__ = ["PostureCost", "posture_cost", "preferred_posture"]
