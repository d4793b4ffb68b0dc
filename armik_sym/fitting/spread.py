"""Robust mean and spread of a length over a recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Samples farther from the median than this many robust standard deviations, and than this share of it, do not
# enter the mean. The share: skin moves by some per cent during a movement between long rests, which is no
# outlier; markers taken for one another are farther off.
_OUTLYING = 3.0
_MAD_TO_SD = 1.4826
_SHARE = 0.1


@dataclass(frozen=True)
class Spread:
    """A length that should be constant.

    Attributes:
        mean: Mean without outlying samples: those more than 3 robust standard deviations and more than 10 %
            away from the median, in [m].
        sd: Standard deviation of all samples, in [m].
        smallest: Smallest sample, in [m].
        largest: Largest sample, in [m].
        samples: Number of samples in which both ends were seen.
        outlying: Number of them left out of the mean.

    Source:
        Huber and Ronchetti (2009), Robust Statistics, §1.1 (rejection by median and MAD).
    """

    mean: float
    sd: float
    smallest: float
    largest: float
    samples: int
    outlying: int

    @property
    def range(self) -> float:
        """Largest minus smallest, in [m]."""
        return self.largest - self.smallest


def spread(values: Array) -> Spread:
    """Robust mean and spread; missing values are ignored.

    Args:
        values: Lengths, shape (n,), in [m]; at least one is not NaN.

    Returns:
        Mean and spread.

    Source:
        As for `Spread`.
    """
    seen = values[np.isfinite(values)]
    middle = float(np.median(seen))
    away = np.abs(seen - middle)
    near = away <= max(_OUTLYING * _MAD_TO_SD * float(np.median(away)), _SHARE * middle)
    return Spread(
        float(seen[near].mean()),
        float(seen.std()),
        float(seen.min()),
        float(seen.max()),
        len(seen),
        int((~near).sum()),
    )
