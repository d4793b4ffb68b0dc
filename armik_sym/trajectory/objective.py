"""What a joint trajectory costs: the objective both problems minimise, recomputed from the angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.posture_cost import posture_cost, preferred_posture
from armik_sym.trajectory.rates import sample_durations, smoothness_weights

Array = NDArray[np.float64]


def objective(
    arm: Arm, time: Array, q: Array, options: TrajectoryOptions, backend: Backend = "auto"
) -> float:
    """½∫ speed_weight·|q̇|² + acceleration_weight·|q̈|² + posture_weight·|q - preferred|² dt + ∫ ℓ(q) dt.

    ℓ is what clearance and preferred elbow direction cost; tracking errors are not in it.

    Args:
        arm: The arm.
        time: Time stamps, shape (n,), in [s].
        q: Joint angles, shape (n, dof), in [rad].
        options: The weights.
        backend: "auto", "c" or "vm".

    Returns:
        The cost, in [1/s].

    Source:
        None (this package).
    """
    weights = options.speed_weight, options.acceleration_weight, options.posture_weight
    away = q - preferred_posture(arm, options.prefer)
    speed, bend, hold = smoothness_weights(time, *weights)
    total = 0.5 * float(np.square(speed[:, None] * np.diff(away, axis=0)).sum())
    bent = sum(bend[:, i, None] * away[i : len(away) - 2 + i] for i in range(3))
    total += 0.5 * float(np.square(bent).sum()) + 0.5 * float(np.square(hold[:, None] * away).sum())
    extra = posture_cost(arm, options, backend)
    if extra is not None:
        total += float(sample_durations(time) @ extra.evaluate(q))
    return total
