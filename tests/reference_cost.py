"""The trajectory objective at given angles, and the optimum the full-space problem finds next to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armik_sym.arm import Arm
from armik_sym.arm.rate_limit import rate_limit
from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.motion.hand_path import HandPath
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.attempts import attempt
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.rates import smoothness_matrix
from armik_sym.trajectory.task import Task


@dataclass(frozen=True, eq=False)
class Reference:
    """Where the full-space problem ended that began at given angles; `cost` is ½∫…, constants included."""

    q: np.ndarray
    cost: float
    converged: bool
    status: str


def cost(arm: Arm, path: HandPath, q: np.ndarray, options: TrajectoryOptions | None = None) -> float:
    """½∫ w_v|q̇|² + w_a|q̈|² + w_p|q - middle|² dt by the solver's own matrix.

    Task leaves the constant ½ w_p Σ d_k |middle|² out; here it is in, so that the cost is never negative.
    """
    o = options or TrajectoryOptions()
    K = smoothness_matrix(path.time, o.speed_weight, o.acceleration_weight, o.posture_weight)
    away = q - arm.rom.middle  # speeds and accelerations do not see the constant
    return 0.5 * float(np.sum(away * (K @ away)))


def full_space_from(
    arm: Arm, path: HandPath, q0: np.ndarray, options: TrajectoryOptions | None = None
) -> Reference:
    """Solve the full-space problem from `q0`, no posture fixed.

    Where IPOPT does not converge the answer is `q0` itself: it is feasible, so it bounds the optimum.
    """
    o = options or TrajectoryOptions()
    stage = compile_stage(arm, Orientation.FULL)
    speed, acceleration = (
        rate_limit("max_speed", o.max_speed, arm),
        rate_limit("max_acceleration", o.max_acceleration, arm),
    )
    task = Task(arm, path, Orientation.FULL, o, speed, acceleration, None, stage)
    found = attempt(task, q0, soft=False, progress=None)
    q = arm.rom.clip(found.q) if found.result.converged else q0
    return Reference(q, cost(arm, path, q, o), found.result.converged, found.result.status)
