"""From a swivel angle near the optimum to the optimum: Newton steps first, IPOPT has the last word."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.ipopt import Bounds, IpoptResult, IterationCallback, run_ipopt
from armik_sym.trajectory.one_curve.go_down import Down
from armik_sym.trajectory.one_curve.limits import Limits, Mask
from armik_sym.trajectory.one_curve.problem import OneCurveProblem
from armik_sym.trajectory.one_curve.smoothness import Smoothness

Array = NDArray[np.float64]

# Started beside the optimum, with bounds that are nearly reached: small barrier, small push off the bounds.
_WARM = {
    "mu_strategy": "monotone",
    "mu_init": 1e-9,
    "bound_mult_init_method": "mu-based",
    "bound_push": 1e-10,
    # A share of narrow intervals, as IPOPT does by itself: 1e-10 of them is nothing beside rounding, and
    # IPOPT 3.14 crashes where it begins exactly on a bound.
    "bound_frac": 1e-2,
    # The gradient carries the rounding of second differences: below this it is converged.
    "acceptable_tol": 1e-6,
    "acceptable_iter": 1,
}
_LIMITED = {"mu_strategy": "adaptive", "bound_push": 1e-8, "bound_frac": 1e-2, "acceptable_tol": 1e-5}

# Bounds nearer to each other than this leave no freedom, in [rad].
_NO_ROOM = 1e-9
_ROUNDS = 6


@dataclass(frozen=True, eq=False)
class Polished:
    """A trajectory at the optimum of its corridor.

    Attributes:
        psi: Swivel angles, shape (n,), in [rad].
        q: Joint angles, shape (n, dof), in [rad].
        value: The objective, not scaled.
        result: What IPOPT returned last.
        iterations: Newton steps and IPOPT iterations in all.
        broken: Kinds of limits that are still exceeded.
    """

    psi: Array
    q: Array
    value: float
    result: IpoptResult
    iterations: int
    broken: tuple[str, ...]


def polish(
    down: Down,
    smooth: Smoothness,
    time: Array,
    limits: Limits,
    *,
    max_iterations: int,
    output: bool = False,
    report: IterationCallback | None = None,
) -> Polished:
    """Bring swivel angles from the end of the way down to the optimum, limits only where they matter.

    Args:
        down: The end of the way down.
        smooth: The objective.
        time: Time stamps, shape (n,), in [s].
        limits: What else is to be kept.
        max_iterations: IPOPT iterations per run.
        output: Let IPOPT print.
        report: Told about every IPOPT iteration.

    Returns:
        The trajectory.

    Raises:
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        Wächter & Biegler (2006), doi:10.1007/s10107-004-0559-y.
    """
    charts, objective, x = down.charts, down.objective, down.x
    # What has no room to speak of is held: IPOPT would have to find its way between two bounds that rounding
    # does not tell apart.
    free = charts.upper - charts.lower > _NO_ROOM
    lower, upper = np.where(free, charts.lower, x), np.where(free, charts.upper, x)
    # Without any freedom every sample has one posture only, and there is nothing to be solved.
    result = IpoptResult(x, down.value, "Only_One_Trajectory", 0, True)
    iterations, watched = down.iterations, dict[str, Mask]()
    value, q = objective.value(x)
    broken = limits.broken(time, q)
    for _ in range(_ROUNDS if free.any() else 0):
        matrix, least, most = limits.rows(time, watched)
        problem = OneCurveProblem(objective, matrix)
        result = run_ipopt(
            problem,
            Bounds(lower, upper, least, most),
            x,
            max_iterations=max_iterations,
            output=output,
            report=report,
            settings=_LIMITED if watched else _WARM,
        )
        problem.raise_error()
        iterations += result.iterations
        x = np.clip(result.x, lower, upper)
        value, q = objective.value(x)
        broken = limits.broken(time, q)
        if not result.converged or not broken:
            break
        watched = limits.to_watch(time, q, watched)
    return Polished(charts.swivel_angles(x), q, value / smooth.scale, result, iterations, broken)
