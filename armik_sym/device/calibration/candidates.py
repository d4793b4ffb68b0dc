"""The lines that can be meant by counts of a potentiometer that may have been turned over its gap."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.calibration.data import JointData
from armik_sym.device.calibration.joint import FULL_TURN
from armik_sym.device.calibration.line import Line, fit_line
from armik_sym.device.channels import SensorKind
from armik_sym.errors import CalibrationError

Array = NDArray[np.float64]


def choose_line(data: JointData, angle_error: float, largest_residual: float) -> tuple[Line, Array]:
    """The one line that is plausible and passes the postures, full turns allowed for.

    Between two postures the wiper of an endless potentiometer may have crossed the gap of its track: all
    postures with higher counts then are a full turn further. Every such split is tried.

    Args:
        data: The joint, moved far enough.
        angle_error: Standard error of a known angle, in [rad].
        largest_residual: How far a posture may be from the line, in [rad].

    Returns:
        The line, and the full turns added to each known angle, shape (n,).

    Raises:
        CalibrationError: If two lines are equally good, or none is plausible.

    Source:
        None (this package).
    """
    tried = [
        (fit_line(data.counts, data.angles + FULL_TURN * k, data.errors, angle_error), k)
        for k in _turns(data)
    ]
    plausible = [(line, k) for line, k in tried if _is_plausible(data, line)]
    passing = [(line, k) for line, k in plausible if _largest(line) <= largest_residual]
    if len(passing) > 1:
        passing.sort(key=lambda pair: _largest(pair[0]))
        best, second = (_largest(pair[0]) for pair in passing[:2])
        # Two postures are passed by any line; with more, the right one is far better.
        if len(data.angles) < 3 or best > second / 4:
            raise CalibrationError(
                f"joint {data.setup.joint!r}: moved by {math.degrees(data.moved):.0f}°, it may have turned "
                "either way round, over the dead zone of its potentiometer or not: add a posture in between, "
                "less than 120° from its neighbours"
            )
    if passing:
        return passing[0]
    if plausible:
        # The straightforward one, if it is among them; what is wrong with it is told by the diagnosis.
        return plausible[0]
    if _largest(tried[0][0]) > largest_residual:
        # No line at all rather than an implausible one: one of the postures may be to blame.
        return tried[0]
    raise _implausible(data, tried[0][0])


def _turns(data: JointData) -> Iterator[Array]:
    """Full turns that may have to be added: none first; then one either way above each gap in the counts."""
    yield np.zeros(len(data.counts))
    if data.channel.kind is SensorKind.ENCODER:
        return
    levels = np.unique(data.counts)
    for low, high in itertools.pairwise(levels):
        above = (data.counts > (low + high) / 2).astype(np.float64)
        yield above
        yield -above


def _largest(line: Line) -> float:
    return float(np.abs(line.residuals).max())


def _is_plausible(data: JointData, line: Line) -> bool:
    lowest, highest = data.setup.plausible(data.channel.kind)
    direction = data.setup.direction
    sign_fits = direction is None or line.slope * direction > 0
    return sign_fits and lowest <= abs(line.slope) * data.channel.span <= highest


def _implausible(data: JointData, line: Line) -> CalibrationError:
    lowest, highest = (math.degrees(value) for value in data.setup.plausible(data.channel.kind))
    whole = math.degrees(abs(line.slope) * data.channel.span)
    direction = data.setup.direction
    if direction is not None and line.slope * direction < 0 and lowest <= whole <= highest:
        said = "grow" if direction > 0 else "fall"
        return CalibrationError(
            f"joint {data.setup.joint!r}: its counts were said to {said} with its angle, but do the "
            "opposite: check the signs of the angles and the direction given"
        )
    what = "all counts" if data.channel.kind is SensorKind.POTENTIOMETER else "one turn of the encoder"
    return CalibrationError(
        f"joint {data.setup.joint!r}: from posture {data.names[int(data.angles.argmin())]!r} to "
        f"{data.names[int(data.angles.argmax())]!r} it is said to have moved by "
        f"{math.degrees(data.moved):.1f}°, while channel {data.setup.channel} moved by "
        f"{np.ptp(data.counts):.0f} counts: {what} would be {whole:.0f}°, expected {lowest:.0f}° to "
        f"{highest:.0f}°: an angle is wrong, another joint moved, or there are gears in between (then say "
        "which full scale to expect)"
    )
