"""Gaps of a recording: stretches of samples in which a marker was not seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import OptionError

Array = NDArray[np.float64]

FILL_METHODS = ("linear", "cubic")
_SLACK = 1e-9


@dataclass(frozen=True)
class MarkerGaps:
    """How often and how long one marker was not seen.

    Attributes:
        name: The marker.
        missing: Number of samples without it.
        fraction: The same as a share of all samples, 0 to 1.
        count: Number of separate gaps.
        longest: Length of the longest gap, from the last sample before it to the first after it (at an
            end of the recording: to the last sample without the marker), in [s].

    Source:
        None (definition).
    """

    name: str
    missing: int
    fraction: float
    count: int
    longest: float

    def __str__(self) -> str:
        return (
            f"{self.name}: {self.missing} samples missing ({100 * self.fraction:.1f} %) in {self.count} "
            f"gap{'' if self.count == 1 else 's'}, the longest {self.longest:.3f} s"
        )


@dataclass(frozen=True)
class Filling:
    """What filling did.

    Attributes:
        gaps: Number of gaps filled.
        samples: Number of samples filled.
        longest: Length of the longest gap filled, in [s]; 0 if none was.
        left: Number of gaps left open.

    Source:
        None (definition).
    """

    gaps: int
    samples: int
    longest: float
    left: int

    def __add__(self, other: Filling) -> Filling:
        return Filling(
            self.gaps + other.gaps,
            self.samples + other.samples,
            max(self.longest, other.longest),
            self.left + other.left,
        )


def runs(flags: ArrayLike) -> NDArray[np.int64]:
    """Where a flag is set, as half-open stretches.

    Args:
        flags: One flag for each sample, shape (n,).

    Returns:
        First index and one past the last index of every stretch, shape (k, 2).

    Source:
        None (bookkeeping).
    """
    edges = np.diff(np.concatenate(([0], np.asarray(flags, dtype=np.int8), [0])))
    return np.column_stack([np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)]).astype(np.int64)


def gap_length(time: Array, first: int, end: int) -> float:
    """Time between the neighbours of a gap: t_end - t_(first-1).

    Args:
        time: Times, shape (n,), in [s].
        first: First sample of the gap.
        end: One past its last sample.

    Returns:
        The length, in [s]; a gap at an end of the recording ends with the recording.

    Source:
        None (definition).
    """
    return float(time[min(end, len(time) - 1)] - time[max(first - 1, 0)])


def gaps_of(name: str, time: Array, position: Array) -> MarkerGaps:
    """Count the gaps of one marker.

    Args:
        name: The marker.
        time: Times, shape (n,), in [s].
        position: Its positions, shape (n, 3), in [m]; NaN where it is missing.

    Returns:
        The summary.

    Source:
        None (definition).
    """
    missing = np.isnan(position).any(axis=1)
    gaps = runs(missing)
    longest = max((gap_length(time, int(a), int(b)) for a, b in gaps), default=0.0)
    return MarkerGaps(name, int(missing.sum()), float(missing.mean()), len(gaps), longest)


def check_fill(method: str, longest: float) -> None:
    """Refuse ways to fill that do not exist.

    Args:
        method: "linear" or "cubic".
        longest: Longest gap to fill, in [s].

    Raises:
        OptionError: If the method is another one, or the length is not positive.

    Source:
        None (this package).
    """
    if method not in FILL_METHODS:
        raise OptionError(f"method is {method!r}, expected {' or '.join(map(repr, FILL_METHODS))}")
    if not longest > 0:
        raise OptionError(f"longest is {longest!r} s, expected a positive time: longer gaps stay open")


def fill_gaps(time: Array, position: Array, method: str, longest: float) -> tuple[Array, Filling]:
    """Fill the inner gaps of one marker that are short enough; nothing is extrapolated.

    Linear: a straight line between the neighbours. Cubic: the not-a-knot cubic spline through all
    samples seen; with fewer than four of them, the straight line.

    Args:
        time: Times, shape (n,), in [s].
        position: Positions, shape (n, 3), in [m]; NaN where the marker is missing.
        method: "linear" or "cubic".
        longest: Longest gap to fill, in [s].

    Returns:
        Positions, shape (n, 3), and what was done.

    Source:
        de Boor (1978), A practical guide to splines.
    """
    from scipy.interpolate import CubicSpline  # slow to import, and most recordings are not filled

    missing = np.isnan(position).any(axis=1)
    gaps = runs(missing)
    inner = [(int(a), int(b)) for a, b in gaps if a > 0 and b < len(time)]
    chosen = [gap for gap in inner if gap_length(time, *gap) <= longest * (1 + _SLACK)]
    filled = position.copy()
    if not chosen:
        return filled, Filling(0, 0, 0.0, len(gaps))
    rows = np.concatenate([np.arange(a, b) for a, b in chosen])
    seen = ~missing
    if method == "cubic" and seen.sum() >= 4:
        filled[rows] = CubicSpline(time[seen], position[seen], bc_type="not-a-knot")(time[rows])
    else:
        for axis in range(3):
            filled[rows, axis] = np.interp(time[rows], time[seen], position[seen, axis])
    lengths = [gap_length(time, *gap) for gap in chosen]
    return filled, Filling(len(chosen), len(rows), max(lengths), len(gaps) - len(chosen))
