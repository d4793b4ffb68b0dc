"""Newton steps over the swivel angles that never leave their intervals: the way down before IPOPT.

With the Hessian H (five bands) and the angles at an end of their interval that the gradient pushes outwards
held there, d = -H⁻¹g over the others; the step is shortened until the objective falls enough, angles stopping
at the ends of their intervals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.one_curve.objective import CurveObjective

Array = NDArray[np.float64]

_LONGEST_STEP = 0.5
_ARMIJO = 1e-4
_HALVINGS = 12
_AT_END = 1e-12
_SMALLEST_SHIFT = 1e-6
_LARGEST_SHIFT = 1e6


@dataclass(frozen=True, eq=False)
class Descent:
    """Where the way down ended.

    Attributes:
        psi: Swivel angles, shape (n,), in [rad].
        value: The objective there.
        iterations: Newton steps taken.
    """

    psi: Array
    value: float
    iterations: int


def descend(
    objective: CurveObjective,
    psi: Array,
    lower: Array,
    upper: Array,
    *,
    iterations: int = 50,
    enough: float = 1e-9,
) -> Descent:
    """Go down to a minimum inside the intervals.

    Args:
        objective: The objective.
        psi: Where to begin, shape (n,), in [rad].
        lower: Least swivel angles, shape (n,), in [rad].
        upper: Largest swivel angles, shape (n,), in [rad].
        iterations: Most steps.
        enough: Ends when a step promises a relative improvement below this.

    Returns:
        Where it ended.

    Source:
        Bertsekas (1982), doi:10.1137/0320018 (projected Newton).
    """
    psi = np.clip(psi, lower, upper)
    compiled = objective.compiled_descent(psi, lower, upper, iterations, enough)
    if compiled is not None:
        return Descent(*compiled)
    shift = 0.0
    value = objective.value(psi)[0]
    done = 0
    while done < iterations:
        done += 1
        at = objective.derivatives(psi)
        value, gradient, bands = at.value, at.gradient, at.bands
        held = ((psi <= lower + _AT_END) & (gradient > 0)) | ((psi >= upper - _AT_END) & (gradient < 0))
        step, shift = _newton_step(gradient, bands, held, shift)
        promised = -float(gradient @ step)
        if not promised > enough * abs(value):  # also where something is not a number
            break
        psi_new, value_new = _shorten(objective, psi, value, gradient, step, lower, upper)
        if psi_new is None:
            if shift > _LARGEST_SHIFT:
                break
            shift = max(10 * shift, _SMALLEST_SHIFT)
            continue
        psi, value, shift = psi_new, value_new, 0.1 * shift
    return Descent(psi, value, done)


def _newton_step(gradient: Array, bands: Array, held: NDArray[np.bool_], shift: float) -> tuple[Array, float]:
    """-(H + shift·diag)⁻¹ g over the angles that are free; the shift grows until the matrix is positive."""
    import scipy.linalg  # slow to import, and the compiled loops do without

    H = bands.copy()
    for i in (1, 2):
        H[i, : len(held) - i] *= ~(held[:-i] | held[i:])
    typical = np.abs(bands[0]).max() + 1e-300
    g = np.where(held, 0.0, gradient)
    while shift <= _LARGEST_SHIFT:
        H[0] = np.where(held, typical, bands[0] + shift * typical)
        try:
            factor = scipy.linalg.cholesky_banded(H, lower=True, check_finite=False)
        except np.linalg.LinAlgError:
            shift = max(4 * shift, _SMALLEST_SHIFT)
            continue
        step = -scipy.linalg.cho_solve_banded((factor, True), g, check_finite=False)
        longest = float(np.abs(step).max(initial=0.0))
        return step * min(1.0, _LONGEST_STEP / max(longest, 1e-300)), shift
    return np.zeros(len(g)), shift


def _shorten(
    objective: CurveObjective,
    psi: Array,
    value: float,
    gradient: Array,
    step: Array,
    lower: Array,
    upper: Array,
) -> tuple[Array | None, float]:
    """The longest of the steps 1, ½, ¼ … that lowers the objective enough."""
    t = 1.0
    for _ in range(_HALVINGS):
        tried = np.clip(psi + t * step, lower, upper)
        value_tried, _ = objective.value(tried)
        if value_tried <= value + _ARMIJO * float(gradient @ (tried - psi)):
            return tried, value_tried
        t *= 0.5
    return None, value
