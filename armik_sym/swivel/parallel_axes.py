"""Where the outer two of three axes are parallel and share one angle: who takes how much."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import NEAR
from armik_sym.swivel.equivalent_angles import without_turns

Array = NDArray[np.float64]


def first_at_pole(Q: Array, lower: Array, upper: Array, wish: Array | None = None) -> Array:
    """Angle of the first joint where only the sum α + γ (β = 0) or difference α - γ (β = π) is determined.

    Without a wish both joints get the same distance from their limits, as far as possible; with one, the
    angle nearest to it that keeps both inside. If nothing keeps both inside, they miss their limits by the
    same.

    Args:
        Q: Rz(α)·Ry(β)·Rz(γ), row by row, shape (n, 9).
        lower: Lower limits of the three joints, shape (3,), in [rad].
        upper: Upper limits of the three joints, shape (3,), in [rad].
        wish: Wished angles of the first, shape (n,), in [rad].

    Returns:
        Angles, shape (n,), in [rad]; the wish, or the middle of the range, where the axes are not parallel.

    Source:
        None (this package).
    """
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    out = np.full(len(Q), middle[0]) if wish is None else np.array(wish, dtype=np.float64)
    near = np.flatnonzero(Q[:, 2] ** 2 + Q[:, 5] ** 2 < NEAR)
    if not near.size:
        return out
    R = Q[near]
    sign = np.where(R[:, 8] < 0, -1.0, 1.0)
    shared = np.arctan2(sign * R[:, 3] - R[:, 1], sign * R[:, 0] + R[:, 4])
    away = without_turns(shared - (middle[0] + sign * middle[2]))
    split = 0.5 * (half[0] - half[2] + np.abs(away))
    best = np.sign(away) * np.clip(split, 0.0, np.abs(away))
    if wish is not None:
        least, most = np.maximum(-half[0], away - half[2]), np.minimum(half[0], away + half[2])
        wished = without_turns(out[near] - middle[0])
        best = np.where(least <= most, np.clip(wished, least, np.maximum(least, most)), best)
    out[near] = middle[0] + best
    return out
