"""At which swivel angles joints are at their limits: the roots of a + b·cos ψ + c·sin ψ = 0."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.axis_triple import AxisTriple
from armik_sym.swivel.closed_form import SwivelCurve
from armik_sym.swivel.constants import PARALLEL, ROUNDING, TURN

Array = NDArray[np.float64]

_Q11, _Q12, _Q13, _Q21, _Q22, _Q23, _Q31, _Q32, _Q33 = range(9)


def limit_cuts(curve: SwivelCurve, extra: Array | float = 0.0) -> Array:
    """Swivel angles at which a joint of shoulder or wrist is at a limit, or half a turn from it.

    With Rz(α)·Ry(β)·Rz(γ) = C0 + C1·cos ψ + C2·sin ψ: sin β·sin(limit - α) = sin(limit)·q13 - cos(limit)·q23;
    cos β = q33; sin β·sin(limit - γ) = -sin(limit)·q31 - cos(limit)·q32. Between neighbours every joint
    stays on one side of its limits, on both branches. Joints that turn all around have none. Where the arm
    is straight along an axis, α ± γ takes the place of α and γ.

    Args:
        curve: The postures of n samples.
        extra: By how much every range of motion is widened at both ends, shape (n,) or a number, in [rad].

    Returns:
        Swivel angles in [-π, π), sorted, shape (n, m), in [rad]; places that are not needed hold -π.

    Source:
        Shimizu et al. (2008), over C0, C1, C2.
    """
    rom = curve.spherical.arm.rom
    wider = np.broadcast_to(np.asarray(extra, dtype=np.float64), (len(curve.elbow),))
    found = []
    for i, triple in enumerate(curve.triples):
        C = curve.parts[:, i]
        for limits, outwards in ((rom.lower, -wider), (rom.upper, wider)):
            for k in range(3):
                j = triple.first + k
                if rom.upper[j] - rom.lower[j] >= TURN - ROUNDING:
                    continue
                found.append(zeros(joint_coefficients(C, triple, k, limits[j] + outwards)))
        part = slice(triple.first, triple.first + 3)
        found += _parallel(C, rom.lower[part], rom.upper[part], wider)
    if not found:
        return np.full((len(curve.elbow), 1), -np.pi)
    cuts = np.concatenate(found, axis=1)
    return np.sort(np.where(np.isnan(cuts), -np.pi, cuts), axis=1)


def joint_coefficients(C: Array, triple: AxisTriple, k: int, limit: Array) -> Array:
    """a, b, c of the equation whose roots are the swivel angles at which a joint has a given angle.

    Args:
        C: C0, C1, C2 of shoulder or wrist, shape (n, 3, 9).
        triple: The three axes.
        k: Which of the three joints.
        limit: The angle, shape (n,), in [rad].

    Returns:
        Shape (n, 3); the roots are also those of the angle half a turn away (k = 0, 2) or its mirror (k = 1).

    Source:
        Shimizu et al. (2008), over C0, C1, C2.
    """
    if k == 1:
        coefficients = C[:, :, _Q33].copy()
        coefficients[:, 0] -= np.cos(limit + triple.offset)
        return coefficients
    s, c = np.sin(limit)[:, None], np.cos(limit)[:, None]
    cosine, sine = (-C[:, :, _Q31], C[:, :, _Q32]) if k else (C[:, :, _Q13], C[:, :, _Q23])
    return np.asarray(s * cosine - c * sine)


def zeros(coefficients: Array) -> Array:
    """Where a + b·cos ψ + c·sin ψ = 0.

    ψ = atan2(c, b) ± atan2(√(h² - a²), -a), h = hypot(b, c).

    Args:
        coefficients: a, b, c, shape (n, 3).

    Returns:
        Both roots in [-π, π), shape (n, 2), in [rad]; NaN if there are none, or if every ψ is a root.

    Source:
        None (elementary).
    """
    a, b, c = coefficients.T
    h = np.hypot(b, c)
    square = (h - a) * (h + a)
    some = (h > ROUNDING) & (square >= -ROUNDING * h * h)
    towards = np.arctan2(c, b)
    aside = np.where(some, np.arctan2(np.sqrt(np.maximum(square, 0.0)), -a), np.nan)
    return wrapped(np.column_stack([towards - aside, towards + aside]))


def wrapped(psi: Array) -> Array:
    """Angles in [-π, π); those that already are, unchanged to the last digit.

    Args:
        psi: Angles between -3π and 3π, in [rad].

    Returns:
        Of the same shape, in [rad].

    Source:
        None (elementary).
    """
    psi = np.where(psi >= np.pi, psi - TURN, psi)
    psi = np.where(psi < -np.pi, psi + TURN, psi)
    return np.asarray(np.where(psi >= np.pi, -np.pi, psi))


def _parallel(C: Array, lower: Array, upper: Array, wider: Array) -> list[Array]:
    """Where the outer axes are parallel for every ψ (straight arm): limits of α + γ, or of α - γ."""
    rows = np.flatnonzero(np.abs(C[:, :, [_Q13, _Q23, _Q31, _Q32]]).max(axis=(1, 2)) < PARALLEL)
    found = []
    for sign in (1.0, -1.0):
        chosen = rows[C[rows, 0, _Q33] * sign > 0]
        third = (lower[2], upper[2]) if sign > 0 else (-upper[2], -lower[2])
        if not chosen.size or upper[0] + third[1] - lower[0] - third[0] >= TURN - ROUNDING:
            continue
        X = sign * C[chosen, :, _Q11] + C[chosen, :, _Q22]
        Y = sign * C[chosen, :, _Q21] - C[chosen, :, _Q12]
        outwards = 2 * wider[chosen]
        for limit in (lower[0] + third[0] - outwards, upper[0] + third[1] + outwards):
            cuts = np.full((len(C), 2), np.nan)
            cuts[chosen] = zeros(np.sin(limit)[:, None] * X - np.cos(limit)[:, None] * Y)
            found.append(cuts)
    return found
