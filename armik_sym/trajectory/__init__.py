"""The whole path in one call: IPOPT problems over all samples."""

from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.solve_trajectory import solve_trajectory

__all__ = ["TrajectoryOptions", "solve_trajectory"]
