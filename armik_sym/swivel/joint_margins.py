"""How far every joint is inside its range of motion, over the swivel angle and on both branches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.closed_form import SwivelCurve, triple_angles
from armik_sym.swivel.constants import POLE
from armik_sym.swivel.equivalent_angles import margin

Array = NDArray[np.float64]


def joint_margins(curve: SwivelCurve, psi: Array) -> Array:
    """Margins of shoulder and wrist; of each joint the best angle among those 2π apart.

    The second branch of (α, β, γ) is (α + π, -β, γ + π).

    Args:
        curve: The postures of n samples.
        psi: Swivel angles, shape (n, m), in [rad].

    Returns:
        Shape (n, m, triples, 2, 3), in [rad]: branch 1 first, then branch -1; negative outside.

    Source:
        None (this package).
    """
    rom = curve.spherical.arm.rom
    Q = curve.rotations(psi)
    out = np.empty((*psi.shape, len(curve.triples), 2, 3))
    for i, triple in enumerate(curve.triples):
        part = slice(triple.first, triple.first + 3)
        lower, upper = rom.lower[part], rom.upper[part]
        angles, _ = triple_angles(triple, Q[:, :, i].reshape(-1, 9), 1, lower, upper, backend="vm")
        parallel = Q[:, :, i, 2] ** 2 + Q[:, :, i, 5] ** 2 < POLE  # both branches are one
        half_turn = np.where(parallel.ravel(), 0.0, np.pi)
        other = angles + np.column_stack([half_turn, np.zeros(len(angles)), half_turn])
        other[:, 1] = -(angles[:, 1] + triple.offset) - triple.offset
        for branch, values in enumerate((angles, other)):
            out[:, :, i, branch] = margin(values, lower, upper).reshape(*psi.shape, 3)
    return out


def elbow_margins(curve: SwivelCurve) -> Array:
    """Margin of the elbow.

    Args:
        curve: The postures of n samples.

    Returns:
        Shape (n,), in [rad]; negative outside.

    Source:
        None (this package).
    """
    rom = curve.spherical.arm.rom
    return margin(curve.elbow, rom.lower[3], rom.upper[3])
