"""Damped least squares, pose by pose: Levenberg-Marquardt (Al-Faiz) and Sugihara's robust damping."""

from armik_sym.pointwise.damped.options import LmOptions, SugiharaOptions
from armik_sym.pointwise.damped.run import run_damped

__all__ = ["LmOptions", "SugiharaOptions", "run_damped"]
