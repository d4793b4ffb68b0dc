"""Joint angles over time with their arm: the least a servo can be asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import HandPathError, ShapeError

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ArmMotion:
    """A motion of an arm, for example one read from a file.

    Attributes:
        arm: The arm.
        time: Strictly increasing times, shape (n,), in [s].
        q: Joint angles, shape (n, dof), in [rad].

    Raises:
        ShapeError: If shapes do not fit.
        HandPathError: If time or an angle is no number, or time does not increase.

    Source:
        None (definition).
    """

    arm: Arm
    time: Array
    q: Array

    def __post_init__(self) -> None:
        try:
            time, q = np.asarray(self.time, dtype=np.float64), np.asarray(self.q, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise HandPathError(f"time and q must be arrays of numbers: {error}") from None
        if time.ndim != 1 or q.shape != (len(time), self.arm.dof):
            raise ShapeError(
                f"time is {time.shape} and q {q.shape}, expected (n,) and (n, {self.arm.dof}): one column "
                f"per joint of arm {self.arm.name!r}"
            )
        if not (np.isfinite(time).all() and (np.diff(time) > 0).all()):
            raise HandPathError("time does not increase: a motion needs finite, strictly increasing times")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "q", q)
