"""Bringing measured joint angles to the time stamps of a solution."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import HandPathError, OptionError
from armik_sym.swivel.equivalent_angles import without_turns

Array = NDArray[np.float64]

# Time stamps nearer than this share of a step are the same: files round them.
_SAME = 1e-3
# A hole in the measured samples of more than this many median steps is not bridged.
_HOLE = 3.5


class Aligned(NamedTuple):
    """Measured joint angles at the time stamps of a solution.

    Attributes:
        rows: Samples of the solution inside the time that was measured, shape (k,).
        q: Measured angles there, NaN where missing, shape (k, joints), in [rad].
        notes: What was done, one sentence each; empty if the time stamps were the same.
    """

    rows: NDArray[np.int64]
    q: Array
    notes: tuple[str, ...]


def align(
    time: Array, measured_time: Array, q: Array, circular: NDArray[np.bool_], longest_hole: float | None
) -> Aligned:
    """Measured joint angles at other time stamps, by linear interpolation and never beyond the overlap.

    Args:
        time: Time stamps wanted, increasing, shape (n,), in [s].
        measured_time: Time stamps measured, increasing, shape (m,), in [s].
        q: Measured angles, NaN where missing, shape (m, joints), in [rad].
        circular: Joints that can turn round: they are interpolated the short way, shape (joints,).
        longest_hole: Measured samples farther apart than this are not interpolated between, in [s]; None:
            3.5 times the median step.

    Returns:
        Samples, angles, and what was done.

    Raises:
        OptionError: If `longest_hole` is not positive.
        HandPathError: If the two times do not overlap.

    Source:
        None (this package).
    """
    if longest_hole is not None and not longest_hole > 0:
        raise OptionError(
            f"longest_hole is {longest_hole!r} s, expected a positive number of seconds or None"
        )
    if _same(time, measured_time):
        return Aligned(np.arange(len(time)), q.copy(), ())
    step = _step(time, measured_time)
    slack = _SAME * step
    rows = np.flatnonzero((time >= measured_time[0] - slack) & (time <= measured_time[-1] + slack))
    if not rows.size:
        raise HandPathError(
            f"solution ({time[0]:g} s to {time[-1]:g} s) and measured motion ({measured_time[0]:g} s to "
            f"{measured_time[-1]:g} s) have no time in common: give both the same time axis"
        )
    if longest_hole is None:
        longest_hole = _HOLE * (
            float(np.median(np.diff(measured_time))) if len(measured_time) > 1 else np.inf
        )
    at, between, open_ = _interpolated(time[rows], measured_time, q, circular, longest_hole, slack)
    done = []
    if between:
        done.append(
            f"measured angles interpolated linearly ({_rate(measured_time)}) to the time stamps of the "
            f"solution ({_rate(time)})"
        )
    if len(rows) < len(time):
        done.append(
            f"compared where both are known, {time[rows[0]]:.4g} s to {time[rows[-1]]:.4g} s: "
            f"{len(time) - len(rows)} of {len(time)} samples of the solution lie outside"
        )
    if open_:
        done.append(
            f"{open_} samples lie in holes of the measurement longer than {longest_hole:.3g} s: not compared"
        )
    return Aligned(rows, at, tuple(done))


def _same(time: Array, measured: Array) -> bool:
    return len(time) == len(measured) and bool(
        np.all(np.abs(time - measured) <= _SAME * _step(time, measured))
    )


def _step(time: Array, measured: Array) -> float:
    """The smallest step of both, in [s]."""
    steps = [np.diff(t).min() for t in (time, measured) if len(t) > 1]
    return float(min(steps, default=1.0))


def _interpolated(
    time: Array, known: Array, q: Array, circular: NDArray[np.bool_], longest_hole: float, slack: float
) -> tuple[Array, int, int]:
    """Angles, how many lie between measured samples, and how many in holes that were left open."""
    before = np.clip(np.searchsorted(known, time, side="right") - 1, 0, len(known) - 1)
    after = np.minimum(before + 1, len(known) - 1)
    gap = known[after] - known[before]
    share = np.clip((time - known[before]) / np.where(gap > 0, gap, 1.0), 0.0, 1.0)
    # On a measured sample nothing of its neighbour is taken, so that a missing neighbour does no harm.
    near = slack / np.where(gap > 0, gap, 1.0)
    share = np.where(share <= near, 0.0, np.where(share >= 1 - near, 1.0, share))[:, None]
    change = q[after] - q[before]
    change = np.where(circular, without_turns(change), change)
    between = q[before] + share * change
    out = np.where(share == 0, q[before], np.where(share == 1, q[after], between))
    inner = (share[:, 0] > 0) & (share[:, 0] < 1)
    hole = inner & (gap > longest_hole)
    out[hole] = np.nan
    return out, int((inner & ~hole).sum()), int(hole.sum())


def _rate(time: Array) -> str:
    return f"{1 / float(np.median(np.diff(time))):.4g} Hz" if len(time) > 1 else "one sample"
