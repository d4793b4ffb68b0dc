"""ISADE and Pro-ISADE: differential evolution, one hand pose after another."""

from armik_sym.pointwise.differential_evolution.options import IsadeOptions, ProIsadeOptions
from armik_sym.pointwise.differential_evolution.run import PathJob, run_isade, run_many

__all__ = ["IsadeOptions", "PathJob", "ProIsadeOptions", "run_isade", "run_many"]
