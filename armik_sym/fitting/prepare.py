"""From a recording to points in the axes of the arm: trimmed, filled and filtered as asked, nothing else."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import RecordingError
from armik_sym.fitting.given_hand import given_directions
from armik_sym.fitting.landmarks import Landmarks
from armik_sym.fitting.marker_map import MarkerMap
from armik_sym.fitting.recording_checks import FEWEST, check_hand_told, check_near, complete
from armik_sym.motion.marker_recording import MarkerRecording

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Prepared:
    """Points ready to be fitted.

    Attributes:
        time: Times of the n samples with all points, shape (n,), in [s].
        sample: Their indices in the recording, shape (n,).
        marks: The points of these samples, in the axes of the base.
        all_marks: The points of all samples from start to end, NaN where missing.
        raw: The same before filling and filtering.
        recording: The markers used, from start to end, before filling and filtering.
        to_base: From the axes of the recording to those of the base, shape (3, 3).
        side: "left" or "right".
        todo: What was asked for.
        said: What was done, in words.
        source: Name of the recording.
    """

    time: Array
    sample: NDArray[np.int64]
    marks: Landmarks
    all_marks: Landmarks
    raw: Landmarks
    recording: MarkerRecording
    to_base: Array
    side: str
    todo: Processing
    said: str
    source: str


@dataclass(frozen=True)
class Processing:
    """What is done to the markers before they are used.

    Attributes:
        start: First time to use, in [s]; None for all.
        end: Last time to use, in [s]; None for all.
        fill_gaps: Longest gap to fill, in [s]; None leaves all open.
        fill_method: "cubic" or "linear".
        cutoff_hz: Cut-off of the low-pass filter, in [Hz]; None does not filter.
    """

    start: float | None = None
    end: float | None = None
    fill_gaps: float | None = None
    fill_method: str = "cubic"
    cutoff_hz: float | None = None


def prepare(
    recording: MarkerRecording,
    markers: MarkerMap,
    side: str,
    to_base: Array,
    todo: Processing,
    hand_rotation: ArrayLike | None,
    hand_axes: str,
) -> Prepared:
    """Points ready to be fitted, from a recording.

    Args:
        recording: The recording.
        markers: Which markers are which points.
        side: "left" or "right".
        to_base: From the axes of the recording to those of the base, shape (3, 3).
        todo: What is to be done to the markers.
        hand_rotation: Orientation of the hand as in `given_directions`, or None.
        hand_axes: Its axes.

    Returns:
        The points.

    Raises:
        RecordingError: If markers are missing, or fewer than five samples have all points.
        OptionError: If the points do not tell how the hand is turned, or an option makes no sense.
        ShapeError: As `given_directions`.
        HandPathError: As `given_directions`.

    Source:
        None (this package).
    """
    markers.check_names(recording)
    check_hand_told(markers, hand_rotation is not None)
    turned = None
    if hand_rotation is not None:
        turned = given_directions(hand_rotation, recording.n, hand_axes, side)
    # A marker may be named twice, with and without its prefix.
    used_names = dict.fromkeys(recording.names[recording.index(name)] for name in markers.markers)
    cut, kept = trimmed(recording.selected(tuple(used_names)), todo)
    check_near(cut)
    turned = None if turned is None else turned[kept]
    raw = landmarks(cut, markers, to_base, turned)
    better, said = processed(cut, todo)
    every = landmarks(better, markers, to_base, turned)
    source = recording.source or "a recording"
    used = complete(every, source)
    return Prepared(
        cut.time[used], kept[used], every.rows(used), every, raw, cut, to_base, side, todo, said, source
    )


def trimmed(recording: MarkerRecording, todo: Processing) -> tuple[MarkerRecording, NDArray[np.int64]]:
    """The samples between start and end.

    Args:
        recording: The recording.
        todo: What is asked for.

    Returns:
        The recording of these, and their indices.

    Raises:
        RecordingError: If fewer than five samples are left.

    Source:
        None (bookkeeping).
    """
    t = recording.time
    low = -np.inf if todo.start is None else todo.start
    high = np.inf if todo.end is None else todo.end
    kept = np.flatnonzero((t >= low) & (t <= high))
    if len(kept) < FEWEST:
        chosen = "" if len(kept) == len(t) else f" from {low:g} to {high:g} s"
        raise RecordingError(
            f"{_name(recording)}: {len(kept)} samples{chosen}, a fit needs {FEWEST}; the recording has "
            f"{recording.n} from {t[0]:g} to {t[-1]:g} s"
        )
    return replace(recording, time=t[kept], position=recording.position[kept]), kept


def processed(recording: MarkerRecording, todo: Processing) -> tuple[MarkerRecording, str]:
    """Gaps filled and noise filtered, as far as asked for.

    Args:
        recording: The recording.
        todo: What is asked for.

    Returns:
        The recording, and what was done, in words; empty if nothing.

    Raises:
        OptionError: If an option makes no sense.
        RecordingError: If it is to be filtered and the times are not even.

    Source:
        None (bookkeeping).
    """
    plain = replace(recording, note="")
    if todo.fill_gaps is not None:
        plain = plain.filled(todo.fill_method, todo.fill_gaps)
    if todo.cutoff_hz is not None:
        plain = plain.filtered(todo.cutoff_hz)
    return plain, plain.note


def landmarks(
    recording: MarkerRecording, markers: MarkerMap, to_base: Array, turned: Array | None
) -> Landmarks:
    """The points in the axes of the base, each the mean of its markers.

    Args:
        recording: The recording.
        markers: Which markers are which points.
        to_base: From the axes of the recording, shape (3, 3).
        turned: Fingers, ulnar and dorsal direction in the axes of the recording, shape (n, 3, 3), or None.

    Returns:
        The points; NaN where a marker of a point is missing.

    Raises:
        RecordingError: If a point is never seen.

    Source:
        None (definition).
    """
    never = [
        name for name in markers.markers if np.isnan(recording.position[:, recording.index(name), 0]).all()
    ]
    if never:
        raise RecordingError(
            f"{_name(recording)}: marker {', '.join(map(repr, never))} is missing in all {recording.n} "
            "samples: choose another marker for this point"
        )
    points = {
        point: np.mean([recording.of(name) for name in markers.of(point)], axis=0) @ to_base.T
        for point in markers.points
    }
    return Landmarks(points, None if turned is None else to_base @ turned)


def _name(recording: MarkerRecording) -> str:
    return recording.source or "the recording"
