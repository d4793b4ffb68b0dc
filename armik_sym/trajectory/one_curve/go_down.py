"""Newton steps to the optimum of a corridor, with coordinates that fit where the steps have led."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.compiled.build import Library
from armik_sym.trajectory.one_curve.charts import Charts, choose_charts
from armik_sym.trajectory.one_curve.descent import descend
from armik_sym.trajectory.one_curve.objective import CurveObjective
from armik_sym.trajectory.one_curve.smoothness import Smoothness

Array = NDArray[np.float64]

_ROUNDS = 12
_STEPS = 8
_LAST_STEPS = 50


@dataclass(frozen=True, eq=False)
class Down:
    """The end of the way down.

    Attributes:
        charts: Coordinates.
        objective: The objective over them.
        x: Coordinates of the optimum, shape (n,), in [rad].
        value: The objective there, scaled.
        iterations: Newton steps.
    """

    charts: Charts
    objective: CurveObjective
    x: Array
    value: float
    iterations: int


def go_down(
    library: Library | None,
    rows: Array,
    smooth: Smoothness,
    psi: Array,
    lower: Array,
    upper: Array,
    wanted: Array,
    rom: RangeOfMotion,
    *,
    enough: float = 1e-9,
) -> Down:
    """Go down to the optimum between bounds on the swivel angles.

    Where the path runs beside poles of shoulder or wrist, coordinates are chosen anew every few steps.

    Args:
        library: The compiled loops; None for NumPy.
        rows: Parameters of all samples, shape (n, SIZE).
        smooth: The objective.
        psi: Where to begin, shape (n,), in [rad].
        lower: Least swivel angles, shape (n,), in [rad].
        upper: Largest swivel angles, shape (n,), in [rad].
        wanted: Joint angles to begin near to where ψ is too coarse to tell, shape (n, 7), in [rad].
        rom: Range of motion.
        enough: Relative improvement below which a step is the last.

    Returns:
        The end.

    Source:
        None (this package).
    """
    psi = np.clip(psi, lower, upper)
    plain = CurveObjective(library, rows, smooth)
    iterations = 0
    for number in range(_ROUNDS):
        at = plain.derivatives(psi)
        charts = choose_charts(rows, psi, lower, upper, at.q, at.slope, wanted, rom)
        special = bool(charts.chart.any())
        last = number == _ROUNDS - 1 or not special
        objective = CurveObjective(library, charts.rows, smooth, charts.chart) if special else plain
        steps = _LAST_STEPS if last else _STEPS
        down = descend(objective, charts.x, charts.lower, charts.upper, iterations=steps, enough=enough)
        iterations += down.iterations
        psi = np.clip(charts.swivel_angles(down.psi), lower, upper)
        wanted = objective.value(down.psi)[1]
        if last or (down.iterations < steps and not charts.stopped(down.psi)):
            break
    return Down(charts, objective, down.psi, down.value, iterations)
