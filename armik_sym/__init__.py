"""Whole-trajectory inverse kinematics of the human arm.

Give it a hand path and an arm; get back the whole joint trajectory, inside the range of motion, and
the kinematics as C code.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from armik_sym._version import __version__

if TYPE_CHECKING:
    from armik_sym import device, elbow, servo, symbolic
    from armik_sym.arm import (
        Arm,
        DHChain,
        DHConvention,
        DHLink,
        JointType,
        RangeOfMotion,
        catalog,
        load_arm,
        save_arm,
        save_urdf,
        segment_lengths,
    )
    from armik_sym.comparison import Comparison, compare, constant_swivel
    from armik_sym.compiled import Kinematics, compile
    from armik_sym.emitting import emit_c
    from armik_sym.errors import ArmikError
    from armik_sym.fitting import FittedArm, fit_arm
    from armik_sym.motion import (
        BvhMotion,
        HandPath,
        JointMotion,
        MarkerRecording,
        StorageTable,
        load_task,
        read_bvh,
        read_markers,
        read_motion,
        read_path,
        read_storage,
        task_names,
        write_bvh,
        write_markers,
        write_motion,
        write_path,
        write_storage,
    )
    from armik_sym.progress import Progress
    from armik_sym.solution import Solution
    from armik_sym.solving import methods, solve
    from armik_sym.swivel.map import SwivelMap, swivel_map

__all__ = [
    "Arm",
    "ArmikError",
    "BvhMotion",
    "Comparison",
    "DHChain",
    "DHConvention",
    "DHLink",
    "FittedArm",
    "HandPath",
    "JointMotion",
    "JointType",
    "Kinematics",
    "MarkerRecording",
    "Progress",
    "RangeOfMotion",
    "Solution",
    "StorageTable",
    "SwivelMap",
    "__version__",
    "catalog",
    "compare",
    "compile",
    "constant_swivel",
    "device",
    "elbow",
    "emit_c",
    "fit_arm",
    "load_arm",
    "load_task",
    "methods",
    "read_bvh",
    "read_markers",
    "read_motion",
    "read_path",
    "read_storage",
    "save_arm",
    "save_urdf",
    "segment_lengths",
    "servo",
    "solve",
    "swivel_map",
    "symbolic",
    "task_names",
    "write_bvh",
    "write_markers",
    "write_motion",
    "write_path",
    "write_storage",
]

# Where each public name lives. Loaded when first used: the command line answers --help, and reports a
# broken CasADi, without importing CasADi.
_HOMES = {
    "armik_sym.arm": (
        "Arm", "DHChain", "DHConvention", "DHLink", "JointType", "RangeOfMotion", "catalog", "load_arm",
        "save_arm", "save_urdf", "segment_lengths",
    ),
    "armik_sym.comparison": ("Comparison", "compare", "constant_swivel"),
    "armik_sym.compiled": ("Kinematics", "compile"),
    "armik_sym.emitting": ("emit_c",),
    "armik_sym.errors": ("ArmikError",),
    "armik_sym.fitting": ("FittedArm", "fit_arm"),
    "armik_sym.motion": (
        "BvhMotion", "HandPath", "JointMotion", "MarkerRecording", "StorageTable", "load_task", "read_bvh",
        "read_markers", "read_motion", "read_path", "read_storage", "task_names", "write_bvh",
        "write_markers", "write_motion", "write_path", "write_storage",
    ),
    "armik_sym.progress": ("Progress",),
    "armik_sym.solution": ("Solution",),
    "armik_sym.solving": ("methods", "solve"),
    "armik_sym.swivel.map": ("SwivelMap", "swivel_map"),
}  # fmt: skip
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name in ("device", "elbow", "servo", "symbolic"):
        return importlib.import_module(f"armik_sym.{name}")
    if name not in _HOME_OF:
        raise AttributeError(f"module 'armik_sym' has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
