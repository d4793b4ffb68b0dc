"""Angles of three axes that meet in a point, and bounds of their rates over a stretch of swivel angles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.constants import TURN

Array = NDArray[np.float64]

# |sin b| below which the outer two axes count as parallel: their rates have no bound there.
_POLE = 1e-3
_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class TripleRates:
    """Three angles a, b, c over stretches |ψ - centre| ≤ half; infinite bounds where a pole is near.

    Attributes:
        angles: At the centres, shape (m, 3), in [rad].
        rate: Their derivatives by ψ at the centres, shape (m, 3); 0 where a pole is near.
        largest_rate: Bound of |dq/dψ| over the stretch, shape (m, 3).
        largest_curvature: Bound of |d²q/dψ²| over the stretch, shape (m, 3).
    """

    angles: Array
    rate: Array
    largest_rate: Array
    largest_curvature: Array


def triple_rates(parts: Array, side: Array, centre: Array, half: Array) -> TripleRates:
    r"""Angles, rates and bounds of Rz(a)·Ry(b)·Rz(c) = C0 + C1·cos ψ + C2·sin ψ.

    The matrix turns about one fixed unit axis: ω in the frame before the triple, ω' in the one after it. With
    x = Rz(a)·eₓ and y = Rz(a)·e_y

        b' = ω·y,  c'·sin b = ω·x,  a' = ω_z - cos b·c',
        b'² + (c'·sin b)² = 1 - ω_z²,  b'² + (a'·sin b)² = 1 - ω'_z²,
        b'' = -a'·c'·sin b,  c'' = b'·(a' - cos b·c')/sin b,  a'' = b'·(c' - cos b·a')/sin b.

    With S the least |sin b| over the stretch (cos b = q33 is a cosine in ψ) these give bounds of rates and
    second derivatives; and rates at the centre + half·(bound of the second derivative) again smaller ones.

    Args:
        parts: C0, C1, C2, shape (m, 3, 9).
        side: Sign of sin b, ±1, shape (m,).
        centre: Centres, shape (m,), in [rad].
        half: Half widths, shape (m,), in [rad].

    Returns:
        The angles (b with its offset) and bounds.

    Source:
        None (this package); the rates invert the Jacobian of Siciliano et al. (2009), eq. 3.64.
    """
    Q = parts[:, 0] + parts[:, 1] * np.cos(centre)[:, None] + parts[:, 2] * np.sin(centre)[:, None]
    x, y = side * Q[:, 2], side * Q[:, 5]
    sine, cosine = np.hypot(x, y), Q[:, 8]
    angles = np.arctan2(np.stack([y, side * sine, side * Q[:, 7]]), np.stack([x, cosine, -side * Q[:, 6]])).T
    omega, along_before, along_after = _turning(parts)
    least, flat = least_sine(parts[:, :, 8], centre, half)
    pole = least < _POLE
    S, size = np.where(pole, 1.0, least), np.where(pole, 1.0, sine)
    ca, sa = np.cos(angles[:, 0]), np.sin(angles[:, 0])
    c = (omega[:, 0] * ca + omega[:, 1] * sa) / (side * size)
    rate = np.stack([omega[:, 2] - cosine * c, omega[:, 1] * ca - omega[:, 0] * sa, c], axis=1)
    before, after = _rest_of_unit(along_before), _rest_of_unit(along_after)
    largest = np.stack([after / S, np.minimum(before, after), before / S], axis=1)
    bending = np.empty_like(largest)
    for _ in range(3):
        A, B, C = largest.T
        bending = np.stack([B * (C + flat * A) / S, A * C, B * (A + flat * C) / S], axis=1)
        largest = np.minimum(largest, np.abs(rate) + half[:, None] * bending + _ROUNDING)
    largest[pole] = np.stack(
        [np.full(len(S), np.inf), np.minimum(before, after), np.full(len(S), np.inf)], 1
    )[pole]
    bending[pole], rate[pole] = np.inf, 0.0
    return TripleRates(angles, rate, largest, bending)


def _turning(parts: Array) -> tuple[Array, Array, Array]:
    """ω, ω_z and ω'_z from the matrix and its derivative at ψ = 0."""
    Q, dQ = (parts[:, 0] + parts[:, 1]).reshape(-1, 3, 3), parts[:, 2].reshape(-1, 3, 3)
    before, after = dQ @ np.swapaxes(Q, 1, 2), np.swapaxes(Q, 1, 2) @ dQ
    omega = np.stack([before[:, 2, 1], before[:, 0, 2], before[:, 1, 0]], axis=1)
    return omega, before[:, 1, 0], after[:, 1, 0]


def _rest_of_unit(along: Array) -> Array:
    return np.asarray(np.sqrt(np.maximum((1 - along) * (1 + along), 0.0) + _ROUNDING))


def least_sine(cosine: Array, centre: Array, half: Array) -> tuple[Array, Array]:
    """Least |sin b| and largest |cos b| over stretches where cos b = c0 + c1·cos ψ + c2·sin ψ.

    Args:
        cosine: c0, c1, c2, shape (m, 3).
        centre: Centres, shape (m,), in [rad].
        half: Half widths, shape (m,), in [rad].

    Returns:
        Both, shape (m,).

    Source:
        None (elementary).
    """
    c0, c1, c2 = cosine.T
    amplitude, top = np.hypot(c1, c2), np.arctan2(c2, c1)
    low, high = centre - half - top, centre + half - top
    ends = np.cos(low), np.cos(high)
    most = np.where(np.floor(high / TURN) >= np.ceil(low / TURN), 1.0, np.maximum(*ends))
    bottom = np.floor(high / TURN - 0.5) >= np.ceil(low / TURN - 0.5)
    least = np.where(bottom, -1.0, np.minimum(*ends))
    size = np.maximum(np.abs(c0 + amplitude * most), np.abs(c0 + amplitude * least)) + _ROUNDING
    size = np.minimum(size, 1.0)
    return np.sqrt((1 - size) * (1 + size)), size
