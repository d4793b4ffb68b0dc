"""From recorded points to an arm, its hand path and the measured joint angles."""

from armik_sym.fitting.fit import fit_arm
from armik_sym.fitting.fitted_arm import FittedArm
from armik_sym.fitting.marker_map import MarkerMap, read_marker_map
from armik_sym.fitting.quality import FitQuality, Misfit
from armik_sym.fitting.spread import Spread

__all__ = ["FitQuality", "FittedArm", "MarkerMap", "Misfit", "Spread", "fit_arm", "read_marker_map"]
