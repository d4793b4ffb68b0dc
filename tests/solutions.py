"""Solutions made by hand, for tests of what they say about themselves."""

from __future__ import annotations

from typing import Any

import numpy as np
from smooth_motions import path_of

from armik_sym.arm import Arm
from armik_sym.motion.hand_path import HandPath
from armik_sym.solution import Requirements, Solution
from armik_sym.symbolic import Orientation


def of_motion(
    arm: Arm,
    q: np.ndarray,
    *,
    time: np.ndarray | None = None,
    path: HandPath | None = None,
    orientation: Orientation = Orientation.FULL,
    max_speed: float | np.ndarray = np.inf,
    max_acceleration: float | np.ndarray = np.inf,
    **more: Any,
) -> Solution:
    """The solution that consists of these angles; exact tracking of its own path unless one is given."""
    if path is None:
        path = path_of(arm, q, time)
    limits = (np.broadcast_to(limit, arm.dof).copy() for limit in (max_speed, max_acceleration))
    return Solution(arm, path, q, "by hand", orientation, Requirements(1e-9, 1e-9, *limits), **more)
