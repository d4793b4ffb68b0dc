"""A straight line through known angles and mean counts, with standard errors and what speaks against it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """angle = slope · (counts - zero).

    Attributes:
        slope: Angle per count, with its sign, in [rad/count].
        zero: Counts at angle 0, in [count].
        slope_error: Standard error of the slope, in [rad/count].
        zero_error: Standard error of the zero, in [count].
        residuals: Known minus fitted angle, one per posture, in [rad].
    """

    slope: float
    zero: float
    slope_error: float
    zero_error: float
    residuals: Array


def fit_line(counts: Array, angles: Array, count_errors: Array, angle_error: float) -> Line:
    """Weighted least squares: minimise Σ (a_i - s (c_i - z))² / (σ_a² + s² σ_i²).

    Standard errors follow from the errors given, and are enlarged by √(χ²/(n - 2)) where the residuals are
    larger than these can explain.

    Args:
        counts: Mean counts of each posture, shape (n,), n ≥ 2, not all the same, in [count].
        angles: Known angles, shape (n,), in [rad].
        count_errors: Standard errors of the counts, shape (n,), in [count].
        angle_error: Standard error of a known angle, in [rad].

    Returns:
        The line.

    Source:
        York, D. et al. (2004), American Journal of Physics 72, 367 (effective variance), one step from the
        unweighted slope; Birge, R. T. (1932), Physical Review 40, 207 (enlarged errors).
    """
    slope = _slope(counts, angles, np.ones_like(counts))
    sigma = np.sqrt(angle_error**2 + (slope * count_errors) ** 2)
    weights = 1 / np.maximum(sigma, np.finfo(float).tiny ** 0.25) ** 2
    slope = _slope(counts, angles, weights)
    total = weights.sum()
    centre, mean = (weights @ counts) / total, (weights @ angles) / total
    residuals = angles - mean - slope * (counts - centre)
    free = len(counts) - 2
    enlarged = max(1.0, float(weights @ residuals**2) / free) if free else 1.0
    slope_variance = enlarged / float(weights @ (counts - centre) ** 2)
    # zero = centre - mean / slope; mean and slope are uncorrelated around the weighted centre.
    mean_variance = enlarged / float(total)
    zero_variance = mean_variance / slope**2 + (mean / slope**2) ** 2 * slope_variance if slope else math.inf
    zero = float(centre - mean / slope) if slope else math.nan
    return Line(slope, zero, math.sqrt(slope_variance), math.sqrt(zero_variance), residuals)


def fit_zero(counts: Array, angles: Array, count_errors: Array, angle_error: float, slope: float) -> Line:
    """The zero alone, the slope being known: the weighted mean of c_i - a_i / s.

    Args:
        counts: Mean counts of each posture, shape (n,), n ≥ 1, in [count].
        angles: Known angles, shape (n,), in [rad].
        count_errors: Standard errors of the counts, shape (n,), in [count].
        angle_error: Standard error of a known angle, in [rad].
        slope: Angle per count, with its sign, in [rad/count].

    Returns:
        The line; its slope has no error.

    Source:
        None (weighted mean).
    """
    zeros = counts - angles / slope
    sigma = np.sqrt((angle_error / slope) ** 2 + count_errors**2)
    weights = 1 / np.maximum(sigma, np.finfo(float).tiny ** 0.25) ** 2
    zero = float(weights @ zeros / weights.sum())
    residuals = angles - slope * (counts - zero)
    free = len(counts) - 1
    enlarged = max(1.0, float(weights @ (zeros - zero) ** 2) / free) if free else 1.0
    return Line(slope, zero, 0.0, math.sqrt(enlarged / float(weights.sum())), residuals)


def without_each(counts: Array, angles: Array) -> tuple[Array, Array]:
    """For each posture: how far it is from the line through all others, and how far these are from it.

    Args:
        counts: Mean counts, shape (n,), n ≥ 4, in [count].
        angles: Known angles, shape (n,), in [rad].

    Returns:
        Known angle minus the angle the others say, and the largest residual among the others; both shape
        (n,), in [rad]. NaN where the others do not determine a line.

    Source:
        None (deleted residuals).
    """
    own, rest = np.full(len(counts), np.nan), np.full(len(counts), np.nan)
    for k in range(len(counts)):
        keep = np.arange(len(counts)) != k
        c, a = counts[keep], angles[keep]
        if np.ptp(c) > 0:
            slope = _slope(c, a, np.ones_like(c))
            own[k] = angles[k] - a.mean() - slope * (counts[k] - c.mean())
            rest[k] = np.abs(a - a.mean() - slope * (c - c.mean())).max()
    return own, rest


def bend(counts: Array, angles: Array) -> tuple[float, float]:
    """How far angle over counts is from straight: a parabola's largest distance from the line.

    Args:
        counts: Mean counts, shape (n,), n ≥ 5, in [count].
        angles: Known angles, shape (n,), in [rad].

    Returns:
        Largest distance of the parabola through the residuals at the postures, in [rad], and the probability
        of a bend as significant without any (F test).

    Source:
        None (nested least squares).
    """
    from scipy.stats import f

    x = (counts - counts.mean()) / np.ptp(counts)
    line = angles - np.polyval(np.polyfit(x, angles, 1), x)
    curve = np.polyval(np.polyfit(x, line, 2), x)
    left = float(((line - curve) ** 2).sum())
    free = len(x) - 3
    ratio = float((curve**2).sum()) / max(left / free, np.finfo(float).tiny)
    return float(np.abs(curve).max()), float(f.sf(ratio, 1, free))


def _slope(counts: Array, angles: Array, weights: Array) -> float:
    centre, mean = np.average(counts, weights=weights), np.average(angles, weights=weights)
    return float((weights * (counts - centre)) @ (angles - mean) / (weights @ (counts - centre) ** 2))
