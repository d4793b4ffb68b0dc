"""What a recording can prove: rigidity, noise, gaps, and how far a fixed arm is from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import RecordingError
from armik_sym.fitting.landmarks import Landmarks
from armik_sym.fitting.noise import left_by_filter, rotation_noise, white_noise
from armik_sym.fitting.predicted_error import FittedChain, PredictedError, predicted_error
from armik_sym.fitting.prepare import Prepared
from armik_sym.fitting.rigid_chain import best_rigid_chain
from armik_sym.fitting.spread import Spread
from armik_sym.motion.low_pass import check_even
from armik_sym.motion.marker_gaps import MarkerGaps, gaps_of

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Misfit:
    """Distance of a point of the best rigid arm from the recorded one.

    Attributes:
        rms: Root mean square over the samples, in [m].
        largest: Largest, in [m].
    """

    rms: float
    largest: float


@dataclass(frozen=True, eq=False)
class FitQuality:
    """How good a recording is, and what a fixed-length arm can make of it.

    Attributes:
        lengths: Segment lengths and their spread; a rigid arm has none.
        noise: Noise of each point per coordinate before any filter, in [m], by fourth differences; NaN if it
            cannot be told. Sliding skin and smoothed noise are not in it.
        turned_noise: The same of a given orientation of the hand, in [rad]; NaN without one.
        noise_left: Share of the noise that the filter left, 1 without a filter.
        gaps: Gaps of each point before any filling.
        samples: Number of samples with all points.
        left_out: Number of samples without one of them.
        longest_hole: Longest time between neighbouring samples used, in [s].
        fixed_base: Best that any arm of fixed lengths on a fixed shoulder can do with free joints: misfit of
            elbow, wrist and hand.
        moving_base: The same with its shoulder moving as recorded.
        angles: Expected error of the measured angles.
        processing: What was done to the points, in words; empty if nothing.
    """

    lengths: Mapping[str, Spread]
    noise: Mapping[str, float]
    turned_noise: float
    noise_left: float
    gaps: tuple[MarkerGaps, ...]
    samples: int
    left_out: int
    longest_hole: float
    fixed_base: Mapping[str, Misfit]
    moving_base: Mapping[str, Misfit]
    angles: PredictedError
    processing: str


def best_misfits(marks: Landmarks) -> tuple[dict[str, Misfit], dict[str, Misfit]]:
    """How near any rigid arm can come to recorded points, on a fixed shoulder and on the recorded one.

    Args:
        marks: The points.

    Returns:
        Misfit of elbow, wrist and (if there is one) hand with a fixed, and with the moving shoulder.

    Source:
        As for `best_rigid_chain`.
    """
    found = {"elbow": marks.elbow, "wrist": marks.wrist}
    if marks.has_hand:
        found["hand"] = marks.hand
    points = np.stack(list(found.values()), axis=1)
    out = []
    for base, free in ((marks.shoulder.mean(axis=0), True), (marks.shoulder, False)):
        off = np.linalg.norm(best_rigid_chain(points, base, free).joints - points, axis=2)
        rms = np.sqrt(np.mean(off**2, axis=0))
        out.append({name: Misfit(float(rms[k]), float(off[:, k].max())) for k, name in enumerate(found)})
    return out[0], out[1]


def fit_quality(
    points: Prepared, chain: FittedChain, branch: Indices, lengths: Mapping[str, Spread]
) -> FitQuality:
    """The quality report of a fit.

    Args:
        points: What was fitted.
        chain: The fitted arm.
        branch: Branch of the closed form of each sample, shape (n,).
        lengths: Segment lengths.

    Returns:
        The report.

    Source:
        None (this package); the parts name theirs.
    """
    noise, turned_noise = _noise(points)
    rate = points.recording.rate
    left = left_by_filter(rate, points.todo.cutoff_hz)
    fixed, moving = best_misfits(points.marks)
    remaining = {name: left * sigma for name, sigma in noise.items()}
    time = points.recording.time
    return FitQuality(
        lengths=lengths,
        noise=noise,
        turned_noise=turned_noise,
        noise_left=left,
        gaps=tuple(gaps_of(name, time, values) for name, values in points.raw.points.items()),
        samples=len(points.sample),
        left_out=len(time) - len(points.sample),
        longest_hole=float(np.diff(points.time).max()),
        fixed_base=fixed,
        moving_base=moving,
        angles=predicted_error(chain, points.marks, branch, remaining, turned_noise),
        processing=points.said,
    )


def _noise(points: Prepared) -> tuple[dict[str, float], float]:
    """Noise of each point before the filter, and of a given orientation; NaN where it cannot be told."""
    try:
        check_even(points.recording.time)
    except RecordingError:  # differences of uneven samples tell nothing about noise
        return dict.fromkeys(points.raw.points, float("nan")), float("nan")
    turned = float("nan") if points.raw.turned is None else rotation_noise(points.raw.turned)
    return {name: white_noise(values) for name, values in points.raw.points.items()}, turned
