"""A comparison as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from armik_sym.comparison.difference import Difference

if TYPE_CHECKING:
    from armik_sym.comparison.comparison import Comparison

Row = tuple[str, str, float, Difference]


def rows(comparison: Comparison) -> list[Row]:
    """What a comparison summarises, line by line.

    Args:
        comparison: The comparison.

    Returns:
        Name, unit as shown, factor from SI to that unit, and the numbers in SI.

    Source:
        None (reporting).
    """
    lines: list[Row] = [
        (name, unit.name, unit.factor, numbers)
        for name, unit, numbers in zip(
            comparison.joint_names, comparison.units, comparison.joints, strict=True
        )
    ]
    degrees = float(np.rad2deg(1.0))
    if len(lines) > 1:
        lines.append(("all_joints", "deg", degrees, comparison.all_joints))
    if comparison.swivel_summary is not None:
        lines.append(("swivel", "deg", degrees, comparison.swivel_summary))
    if comparison.elbow_summary is not None:
        lines.append(("elbow_position", "mm", 1000.0, comparison.elbow_summary))
    return lines


def summary(comparison: Comparison) -> str:
    """The table of a comparison: mean, RMS, maximum and bias, in degrees and millimetres.

    Args:
        comparison: The comparison.

    Returns:
        Text, one line per joint, then swivel and elbow, then notes.

    Source:
        Compare Nguyen 2021, Table 6.
    """
    solution, time = comparison.solution, comparison.time
    lines = [
        f"method {solution.method} against measured: arm {solution.arm.name}, {len(time)} samples, "
        f"{time[0]:.4g} s to {time[-1]:.4g} s",
        f"  {'':<34}{'mean |d|':>10}{'RMS':>10}{'max |d|':>10}{'at [s]':>9}{'bias':>10}",
    ]
    for name, unit, factor, numbers in rows(comparison):
        bias = "" if name == "elbow_position" else _cell(factor * numbers.bias, 10, sign=True)
        cells = "".join(_cell(factor * value, 10) for value in (numbers.mean, numbers.rms, numbers.max))
        lines.append(f"  {f'{name} [{unit}]':<34}{cells}{_cell(numbers.at, 9)}{bias}".rstrip())
    lines += [f"  note: {note}" for note in comparison.notes]
    lines += [f"  solution: {reason}" for reason in solution.reasons]
    return "\n".join(lines)


def _cell(value: float, width: int, *, sign: bool = False) -> str:
    if not np.isfinite(value):
        return f"{'-':>{width}}"
    return f"{value:{'+' if sign else ''}{width}.2f}"
