"""Solved joint trajectories: errors, margins, verdict, files and text."""

from armik_sym.solution.solution import Solution
from armik_sym.solution.timing import Timing
from armik_sym.solution.verdict import Requirements

__all__ = ["Requirements", "Solution", "Timing"]
