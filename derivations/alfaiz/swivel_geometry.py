r"""The elbow circle of the arm of Al-Faiz, in numbers.

For a wrist at w the elbow lies on a circle about the line shoulder-wrist. ψ (swivel angle) counts along it,
from the lowest point, right-handed about w. β is the elevation of w above the horizontal plane, γ the angle
at the shoulder between upper arm and w: tan γ = l3·|sin θ4| / (l4 + l3·cos θ4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from derivations.alfaiz.closed_form import Lengths

_UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class ElbowCircle:
    """The circle for one wrist position.

    Attributes:
        wrist: Position, shape (3,), in [m]; not on the vertical axis through the shoulder.
        lengths: Segment lengths.
    """

    wrist: np.ndarray
    lengths: Lengths

    @property
    def gamma(self) -> float:
        """γ in [rad], between 0 and π, whatever the sign of θ4."""
        distance = np.linalg.norm(self.wrist)
        l4, l3 = self.lengths.l4, self.lengths.l3
        return float(np.arccos((l4**2 + distance**2 - l3**2) / (2 * l4 * distance)))

    @property
    def beta(self) -> float:
        """β in [rad]."""
        return float(np.arctan2(self.wrist[1], np.hypot(self.wrist[0], self.wrist[2])))

    def _directions(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        along = self.wrist / np.linalg.norm(self.wrist)
        down = -_UP + (_UP @ along) * along
        down /= np.linalg.norm(down)
        return along, down, np.cross(along, down)

    def elbow(self, psi: float) -> np.ndarray:
        """Elbow for a swivel angle.

        Args:
            psi: In [rad].

        Returns:
            Position, shape (3,), in [m].

        Source:
            Tolani, Goswami & Badler (2000), real-time inverse kinematics of a human arm (swivel angle).
        """
        along, down, side = self._directions()
        l4, gamma = self.lengths.l4, self.gamma
        elbow: np.ndarray = l4 * (
            np.cos(gamma) * along + np.sin(gamma) * (np.cos(psi) * down + np.sin(psi) * side)
        )
        return elbow

    def psi(self, elbow: np.ndarray) -> float:
        """Swivel angle of an elbow on the circle.

        Args:
            elbow: Position, shape (3,), in [m].

        Returns:
            ψ in [rad].

        Source:
            Tolani, Goswami & Badler (2000).
        """
        _, down, side = self._directions()
        return float(np.arctan2(elbow @ side, elbow @ down))
