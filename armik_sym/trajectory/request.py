"""What is asked of the whole-trajectory method, checked and complete."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.motion.hand_path import HandPath
from armik_sym.progress import Progress, ProgressCallback
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.options import TrajectoryOptions

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Request:
    """One call of the method.

    Attributes:
        arm: The arm.
        path: The hand path.
        orientation: What of the path's orientation is tracked.
        options: The user's choices.
        max_speed: Speed limits, shape (dof,), in [rad/s].
        max_acceleration: Acceleration limits, shape (dof,), in [rad/s²].
        start: Known posture at the beginning, shape (dof,), in [rad], or None.
        seed: Seed of everything random.
        backend: "auto", "c" or "vm".
        progress: Told what is going on.
    """

    arm: Arm
    path: HandPath
    orientation: Orientation
    options: TrajectoryOptions
    max_speed: Array
    max_acceleration: Array
    start: Array | None
    seed: int
    backend: Backend
    progress: ProgressCallback | None

    def tell(self, stage: str) -> None:
        """Report a new stage to whoever watches.

        Args:
            stage: What is going on.

        Source:
            None (reporting).
        """
        if self.progress is not None:
            self.progress(Progress(stage))
