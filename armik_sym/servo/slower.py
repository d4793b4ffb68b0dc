"""How much slower a motion must be: the smallest uniform factor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armik_sym.servo.reference import Reference
from armik_sym.servo.setup import Setup

Array = NDArray[np.float64]

PRECISION = 2e-3
_ROUNDING = 1e-12
_GROWTH = 1.5


def limit_factor(setup: Setup, reference: Reference) -> float | None:
    """Smallest factor f ≥ 1 by which a motion must be slowed for speeds and torques of the drives, exactly.

    With x = 1/f, speed is x q̇ and torque h + x B q̇ + x² (M q̈ + c), h holding the posture against gravity and
    dry friction. Every limit is a polynomial in x, so the largest x that keeps all is a root of one of them.

    Args:
        setup: Arm and drives.
        reference: The motion at its own speed.

    Returns:
        The factor; None if a drive cannot even hold the postures.

    Source:
        Hollerbach 1984, Dynamic scaling of manipulator trajectories; this package (friction and RMS).
    """
    joints = setup.drive.joints
    still = np.zeros_like(reference.q)
    gravity = setup.body_torque(reference.q, still, still)
    hold = gravity + setup.dry_friction(reference.speed)
    viscous = np.array([j.viscous for j in joints]) * reference.speed
    moving = setup.torque_needed(reference.q, reference.speed, reference.acceleration) - hold - viscous
    peak, rated = np.array([j.peak_torque for j in joints]), np.array([j.rated_torque for j in joints])
    top = np.array([j.top_speed for j in joints])

    fastest = np.abs(reference.speed).max(axis=0)
    first = float(np.min(top / np.maximum(fastest, top), initial=1.0))
    roots = [np.array([first])]
    roots += [_roots(moving, viscous, hold - peak), _roots(moving, viscous, hold + peak)]
    squares = np.stack([(moving**2).mean(axis=0), 2 * (moving * viscous).mean(axis=0),
                        (viscous**2 + 2 * moving * hold).mean(axis=0), 2 * (viscous * hold).mean(axis=0),
                        (hold**2).mean(axis=0) - rated**2])  # fmt: skip
    roots += [_real(np.roots(squares[:, j])) for j in range(len(joints))]
    candidates = np.unique(np.concatenate(roots))
    candidates = candidates[(candidates > 0) & (candidates <= first)]

    def keeps(x: float) -> bool:
        torque = hold + x * viscous + x * x * moving
        mean = np.sqrt((torque**2).mean(axis=0))
        slack = 1 + 1e3 * _ROUNDING
        return bool((np.abs(torque) <= peak * slack).all() and (mean <= rated * slack).all())

    for x in candidates[::-1]:
        if keeps(float(x)):
            return float(1.0 / x)
    return None


def _roots(a: Array, b: Array, c: Array) -> Array:
    """Roots in (0, 1] of a x² + b x + c, all together, shape (k,)."""
    under = b * b - 4 * a * c
    root = np.sqrt(np.maximum(under, 0.0))
    half = -0.5 * (b + np.where(b >= 0, 1.0, -1.0) * root)
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([half / a, c / half])
    good = (under >= 0) & np.isfinite(both) & (both > 0) & (both <= 1)
    return np.asarray(both[good])


def _real(roots: NDArray[Any]) -> Array:
    return np.asarray(np.real(roots[np.abs(np.imag(roots)) <= _ROUNDING * np.maximum(np.abs(roots), 1.0)]))


def smallest_factor(
    good: Callable[[float], bool], start: float, largest: float, precision: float = PRECISION
) -> float | None:
    """Smallest factor from `start` on at which a simulated motion is good, to a relative precision.

    Factors grow by half until one is good; bisection follows between the last two. Where a motion is good at
    one factor and bad at a larger one, the one found is good, with a bad one just below it.

    Args:
        good: Whether the motion slowed by a factor is good.
        start: First factor to try.
        largest: Largest factor to try.
        precision: Relative distance of the last good and bad factor.

    Returns:
        The factor, or None if none up to `largest` is good.

    Source:
        None (bisection).
    """
    if start > largest:
        return None
    if good(start):
        return start
    bad, factor = start, min(start * _GROWTH, largest)
    while not good(factor):
        if factor >= largest:
            return None
        bad, factor = factor, min(factor * _GROWTH, largest)
    while factor / bad > 1 + precision:
        middle = (factor * bad) ** 0.5
        if good(middle):
            factor = middle
        else:
            bad = middle
    return factor
