"""How far a trajectory can be from the best one, as a certificate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LowerBound:
    """How far a trajectory can be from the best one.

    Attributes:
        value: No feasible trajectory has a lower objective.
        objective: Objective of the trajectory in hand.
        cells: Stretches of the swivel map that were bounded.
        seconds: Time it took.
        suspect: None if the gap asked for was reached. Otherwise a smooth trajectory near where the bound is
            lowest, shape (n, dof), in [rad]. It does not follow the path exactly; a solver started there may
            find a better trajectory than the one in hand.
        known_first: Whether it holds only for trajectories that begin with the posture that the one in hand
            begins with.
    """

    value: float
    objective: float
    cells: int
    seconds: float
    suspect: Array | None = None
    known_first: bool = False

    @property
    def gap(self) -> float:
        """(objective - value)/objective: by which part the best trajectory may be better."""
        return (self.objective - self.value) / self.objective if self.objective > 0 else 0.0

    @property
    def certified(self) -> str:
        """What is certified, in one sentence."""
        begins = "begins with the same posture and " if self.known_first else ""
        return (
            f"No trajectory that {begins}brings the hand to every sample with every joint inside its range "
            "of motion, on any branch and with any swivel angles, has an objective below "
            f"{self.value:.6g}; the best can have at most {100 * self.gap:.2g} % less than the "
            f"{self.objective:.6g} of this one."
        )
