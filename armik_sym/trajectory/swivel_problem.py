"""The whole trajectory as a problem over the swivel angle: what is given and what is asked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.compiled.build import Library
from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.one_curve.limits import Limits
from armik_sym.trajectory.posture_cost import PostureCost

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SwivelProblem:
    """What is to be solved.

    Attributes:
        arm: The arm.
        path: The hand path.
        intervals: Feasible swivel angles of every sample.
        reference: Reference directions they are counted from, shape (n, 3).
        weights: Of squared speed, squared acceleration [s²], squared distance from `aim` [1/s²].
        aim: Where the posture is drawn to, shape (dof,), in [rad].
        limits: Speed, acceleration, range of motion.
        first: The posture at sample 0 if it is known, shape (dof,), in [rad].
        library: The compiled loops; None for NumPy.
        backend: "auto", "c" or "vm".
        posture_cost: Clearance and preferred elbow direction; None if not asked for.
        max_iterations: IPOPT iterations per run.
        output: Let IPOPT print.
    """

    arm: Arm
    path: HandPath
    intervals: FeasibleIntervals
    reference: Array
    weights: tuple[float, float, float]
    aim: Array
    limits: Limits
    first: Array | None
    library: Library | None
    backend: Backend
    posture_cost: PostureCost | None = None
    max_iterations: int = 300
    output: bool = False
