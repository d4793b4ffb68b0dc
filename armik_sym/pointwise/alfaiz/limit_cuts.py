"""At which swivel angles joints are at their limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion

Array = NDArray[np.float64]

_ROUNDING = 1e-12
_R13, _R21, _R22, _R23, _R33 = 2, 3, 4, 5, 8


def limit_cuts(parts: Array, rom: RangeOfMotion) -> Array:
    """Swivel angles at which a joint other than the elbow is at a limit, or half a turn from it.

    cos θ6·sin(limit - θ5) = sin(limit)·r13 + cos(limit)·r33; sin θ6 = r23;
    -cos θ6·sin(limit - θ7) = sin(limit)·r21 + cos(limit)·r22. The shoulder has the same with angles reversed.
    Between neighbours every joint stays on one side of its limits.

    Args:
        parts: C0, C1, C2 of the rotations of shoulder and wrist, shape (2, 3, 9).
        rom: Range of motion.

    Returns:
        Swivel angles from -π to π, sorted, in [rad].

    Source:
        Al-Faiz, eq. 39, 41-42 and 45-46, over the swivel angle.
    """
    cuts: list[float] = []
    for group in (0, 1):
        for limits in (rom.lower, rom.upper):
            for i in range(3):
                j = 4 * group + i
                if rom.width[j] >= 2 * np.pi - _ROUNDING:
                    continue
                s, c = np.sin(limits[j]) * (1 if group else -1), np.cos(limits[j])
                C = parts[group]
                if i == 1:
                    coefficients = C[:, _R23] - np.array([s, 0.0, 0.0])
                else:
                    sine, cosine = (_R21, _R22) if i else (_R13, _R33)
                    coefficients = s * C[:, sine] + c * C[:, cosine]
                cuts += _zeros(*coefficients)
    return np.sort(np.array(cuts))


def _zeros(a: float, b: float, c: float) -> list[float]:
    """Where a + b·cos ψ + c·sin ψ = 0."""
    h = np.sqrt(b * b + c * c)
    square = (h - a) * (h + a)
    if not h > _ROUNDING or square < -_ROUNDING * h * h:
        return []
    towards, aside = np.arctan2(c, b), np.arctan2(np.sqrt(max(square, 0.0)), -a)
    return [_wrapped(towards + aside), _wrapped(towards - aside)]


def _wrapped(psi: float) -> float:
    if psi >= np.pi:
        psi -= 2 * np.pi
    return psi + 2 * np.pi if psi < -np.pi else psi
