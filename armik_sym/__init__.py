"""Whole-trajectory inverse kinematics of the human arm.

Give it a hand path and an arm; get back the whole joint trajectory, inside the range of motion, and
the kinematics as C code.
"""

from armik_sym import symbolic
from armik_sym._version import __version__
from armik_sym.arm import (
    Arm,
    DHChain,
    DHConvention,
    DHLink,
    JointType,
    RangeOfMotion,
    catalog,
    load_arm,
    segment_lengths,
)
from armik_sym.compiled import Kinematics, compile, emit_c
from armik_sym.errors import ArmikError
from armik_sym.motion import HandPath, load_task, read_path, task_names, write_path
from armik_sym.progress import Progress
from armik_sym.solution import Solution
from armik_sym.solving import methods, solve

__all__ = [
    "Arm",
    "ArmikError",
    "DHChain",
    "DHConvention",
    "DHLink",
    "HandPath",
    "JointType",
    "Kinematics",
    "Progress",
    "RangeOfMotion",
    "Solution",
    "__version__",
    "catalog",
    "compile",
    "emit_c",
    "load_arm",
    "load_task",
    "methods",
    "read_path",
    "segment_lengths",
    "solve",
    "symbolic",
    "task_names",
    "write_path",
]
