"""From a swivel angle near the optimum to the optimum: Newton steps first, IPOPT has the last word."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.trajectory.ipopt import Bounds, IpoptResult, IterationCallback, run_ipopt
from armik_sym.trajectory.one_curve.go_down import Down
from armik_sym.trajectory.one_curve.problem import OneCurveProblem
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.rates import acceleration_matrix, speed_matrix

Array = NDArray[np.float64]

# Started beside the optimum, with bounds that are nearly reached: small barrier, small push off the bounds.
_WARM = {
    "mu_strategy": "monotone",
    "mu_init": 1e-9,
    "bound_mult_init_method": "mu-based",
    "bound_push": 1e-10,
    "bound_frac": 1e-10,
    # The gradient of what is left carries the rounding of second differences: twice below this is converged.
    "acceptable_tol": 1e-5,
    "acceptable_iter": 2,
}
_LIMITED = {"mu_strategy": "adaptive", "bound_push": 1e-8, "bound_frac": 1e-8, "acceptable_tol": 1e-5}

# IPOPT satisfies constraints to 1e-10; limits are drawn in by more than that, so that they hold exactly.
_RELATIVE_MARGIN = 1e-8
_MARGIN = 2e-10


@dataclass(frozen=True, eq=False)
class Limits:
    """What the trajectory has to keep besides the intervals.

    Attributes:
        max_speed: Shape (dof,), in [rad/s].
        max_acceleration: Shape (dof,), in [rad/s²].
        rom: Range of motion.
        wide: Joints whose range is a full turn or more: the intervals do not keep them in, shape (dof,).
    """

    max_speed: Array
    max_acceleration: Array
    rom: RangeOfMotion
    wide: NDArray[np.bool_]

    def broken(self, time: Array, q: Array) -> list[str]:
        """Which kinds of limits a trajectory exceeds.

        Args:
            time: Time stamps, shape (n,), in [s].
            q: Joint angles, shape (n, dof), in [rad].

        Returns:
            Of "speed", "acceleration", "range".

        Source:
            None (definition).
        """
        kinds = []
        if (np.abs(speed_matrix(time) @ q) > self.max_speed).any():
            kinds.append("speed")
        if (np.abs(acceleration_matrix(time) @ q) > self.max_acceleration).any():
            kinds.append("acceleration")
        if self.wide.any() and (self.rom.margin(q)[:, self.wide] < 0).any():
            kinds.append("range")
        return kinds

    def rows(self, time: Array, kinds: list[str]) -> tuple[sp.csr_array, Array, Array]:
        """Rows for one joint and their bounds for all joints.

        Args:
            time: Time stamps, shape (n,), in [s].
            kinds: Of "speed", "acceleration", "range".

        Returns:
            Matrix (m, n), lower and upper bounds, shape (m·dof,).

        Source:
            None (direct transcription).
        """
        n = len(time)
        matrices, lower, upper = [sp.csr_array((0, n))], [np.zeros(0)], [np.zeros(0)]
        both = {
            "speed": (speed_matrix(time), self.max_speed),
            "acceleration": (acceleration_matrix(time), self.max_acceleration),
        }
        for kind, (matrix, limit) in both.items():
            if kind in kinds:
                inside = np.maximum(limit * (1 - _RELATIVE_MARGIN) - _MARGIN, 0.5 * limit)
                matrices.append(matrix)
                lower.append(np.tile(-inside, matrix.shape[0]))
                upper.append(np.tile(inside, matrix.shape[0]))
        if "range" in kinds:
            matrices.append(sp.csr_array(sp.eye_array(n)))
            lower.append(np.tile(np.where(self.wide, self.rom.lower + _MARGIN, -np.inf), n))
            upper.append(np.tile(np.where(self.wide, self.rom.upper - _MARGIN, np.inf), n))
        return sp.csr_array(sp.vstack(matrices)), np.concatenate(lower), np.concatenate(upper)


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
    broken: list[str]


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
    """Bring swivel angles from the end of the way down to the optimum, limits on rates only where they matter.

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
    charts, objective, iterations = down.charts, down.objective, down.iterations
    x, kinds = down.x, list[str]()
    while True:
        matrix, least, most = limits.rows(time, kinds)
        result = run_ipopt(
            OneCurveProblem(objective, matrix),
            Bounds(charts.lower, charts.upper, least, most),
            x,
            max_iterations=max_iterations,
            output=output,
            report=report,
            settings=_LIMITED if kinds else _WARM,
        )
        iterations += result.iterations
        x = np.clip(result.x, charts.lower, charts.upper)
        value, q = objective.value(x)
        broken = limits.broken(time, q)
        new = [kind for kind in broken if kind not in kinds]
        if not new or not result.converged:
            psi = charts.swivel_angles(x)
            return Polished(psi, q, value / smooth.scale, result, iterations, broken)
        kinds = kinds + new
