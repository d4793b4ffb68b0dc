"""The weighted hand error of eq. (16), for many postures at once, in NumPy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.kinematics import compile
from armik_sym.pointwise.differential_evolution.options import IsadeOptions, Measure

Array = NDArray[np.float64]

_DIAGONAL = (0, 4, 8)


class HandCost:
    """b·√(|p - p*|² + w²·turned²) of an arm.

    turned² is 0 ("position"), the squared difference of the diagonals of R and R* ("cosines") or
    |R - R*|²_F / 2 = 4 sin²(angle/2) ("pose").

    Args:
        arm: The arm.
        options: Weights.
        measure: What of the error counts.

    Source:
        Nguyen 2021, eq. 16.
    """

    def __init__(self, arm: Arm, options: IsadeOptions, measure: Measure) -> None:
        self._kinematics = compile(arm, "vm")
        self._measure = measure
        self._hand_weight = options.hand_weight
        self._rotation_weight = options.rotation_weight

    def __call__(self, q: Array, target: Array) -> Array:
        """Weighted hand error of postures.

        Args:
            q: Postures, shape (n, dof), in [rad].
            target: Position and rotation row by row, shape (12,).

        Returns:
            Shape (n,), in [m].

        Source:
            Nguyen 2021, eq. 16.
        """
        shift = self._kinematics.position(q) - target[:3]
        squared = np.square(shift).sum(axis=1)
        if self._measure != "position":
            off = self._kinematics.rotation(q).reshape(-1, 9) - target[3:]
            if self._measure == "cosines":
                turned = np.square(off[:, _DIAGONAL]).sum(axis=1)
            else:
                turned = np.square(off).sum(axis=1) / 2
            squared = squared + self._rotation_weight**2 * turned
        return np.asarray(self._hand_weight * np.sqrt(squared))
