"""What the tests of the damped methods share: libraries with their loops alone, targets, starts."""

from __future__ import annotations

import functools

import numpy as np

from armik_sym.arm import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.backend import build_or_none
from armik_sym.compiled.c_constant import Precision
from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.hand_written import loop_text
from armik_sym.compiled.library_source import PRELUDE
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import PointwiseLibrary, pointwise_functions
from armik_sym.symbolic import Orientation

LOOPS = (
    "random_stream.h",
    "real_math.h",
    "small_cholesky.h",
    "pose_residual.h",
    "bounded_step.h",
    "damped_pose.h",
    "damped_path.h",
)
NUMPY = PointwiseLibrary(None)

# Single functions of the loops, for Python to call.
EXPORTS = """
EXPORT int damped_step_once(const real *J, const real *e, int m, real damping, const real *q,
                            const real *lower, const real *upper, real *d) {
  step_workspace w;
  return armik_damped_step(J, e, m, damping, q, lower, upper, d, &w);
}
EXPORT void rotation_residual(const real *E, int printed, real *out) {
  if (printed)
    armik_printed_rotation_residual(E, out);
  else
    armik_rotation_vector(E, out);
}
"""


def source_of(arm: Arm, prelude: str = PRELUDE, precision: Precision = "double") -> str:
    """C source of the damped loops alone; without vector units, as on a controller, it compiles quickly."""
    function = pointwise_functions(arm)["pose_and_jacobian"]
    kinematics = c_function(function, "armik_pose_and_jacobian", precision)
    head = f"{prelude}\n#define DOF {arm.dof}\n"
    return "\n".join([head, "static " + kinematics, *(loop_text(name) for name in LOOPS)])


@functools.cache
def compiled(arm: Arm) -> PointwiseLibrary:
    """The compiled loops of one arm."""
    quickly = '#pragma GCC optimize("O1")\n'  # a third of the compile time
    return PointwiseLibrary(build_or_none(quickly + source_of(arm) + EXPORTS, "c"))


def reachable(arm: Arm, n: int, seed: int = 0, orientation: Orientation = Orientation.FULL) -> HandTargets:
    """Poses of random postures inside the range of motion."""
    return targets_of(arm, arm.rom.random_postures(np.random.default_rng(seed), n), orientation)


def targets_of(arm: Arm, q: np.ndarray, orientation: Orientation = Orientation.FULL) -> HandTargets:
    """Poses of postures, by code that knows no generated expressions."""
    p, R = hand_pose(arm.chain, q, arm.lengths)
    if orientation is Orientation.NONE:
        R = np.broadcast_to(np.eye(3), R.shape)
    return HandTargets(orientation, np.hstack([p, R.reshape(-1, 9)]))


def middle(arm: Arm, n: int) -> np.ndarray:
    """The middle of the range of motion as the start of n independent samples."""
    return np.tile(arm.rom.middle, (n, 1))


def distance(arm: Arm, q: np.ndarray, targets: HandTargets) -> np.ndarray:
    """|p* - p| plus the largest difference of rotation entries, in [m] and [1]."""
    p, R = hand_pose(arm.chain, q, arm.lengths)
    shift = np.linalg.norm(targets.pose[:, :3] - p, axis=1)
    if targets.orientation is Orientation.NONE:
        return shift
    return shift + np.abs(targets.pose[:, 3:] - R.reshape(-1, 9)).max(axis=1)
