"""A difference over time in five numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Difference:
    """How far two curves are apart, over the samples at which both are known.

    Attributes:
        mean: Mean of the absolute difference, in the unit of the curves; NaN without samples.
        rms: Root of the mean square.
        max: Largest absolute difference.
        at: Time of the largest, in [s].
        bias: Mean of predicted minus measured, with its sign.
        samples: Number of samples.
    """

    mean: float
    rms: float
    max: float
    at: float
    bias: float
    samples: int


def difference_of(time: ArrayLike, apart: ArrayLike) -> Difference:
    """Mean, RMS and maximum of a difference: Σ|d|/n, √(Σd²/n), max|d|.

    Args:
        time: Time stamps, shape (n,), in [s].
        apart: Predicted minus measured, shape (n,); NaN where one of them is missing.

    Returns:
        The numbers, in the unit of `apart`; all NaN if there is no sample.

    Source:
        Definition.
    """
    stamps, d = np.asarray(time, dtype=np.float64), np.asarray(apart, dtype=np.float64)
    known = np.flatnonzero(np.isfinite(d))
    if not known.size:
        return Difference(np.nan, np.nan, np.nan, np.nan, np.nan, 0)
    d, stamps = d[known], stamps[known]
    k = int(np.argmax(np.abs(d)))
    return Difference(
        mean=float(np.abs(d).mean()),
        rms=float(np.sqrt((d * d).mean())),
        max=float(abs(d[k])),
        at=float(stamps[k]),
        bias=float(d.mean()),
        samples=len(d),
    )
