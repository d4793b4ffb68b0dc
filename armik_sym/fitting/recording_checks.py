"""Refusing recordings that cannot be fitted, with the reason."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import OptionError, RecordingError, UnitError
from armik_sym.fitting.landmarks import Landmarks, tells_hand_turned
from armik_sym.fitting.marker_map import MarkerMap
from armik_sym.motion.marker_recording import MarkerRecording

# Fewer complete samples than this tell neither spread nor noise.
FEWEST = 5
_ROUNDING = 1e-6
# Farther from the origin than this is no laboratory, in [m].
_FARTHEST = 1e9
# Segments of people, in [m]: from a small child to more than the tallest adult.
_PLAUSIBLE = {"upper_arm": (0.06, 0.6), "forearm": (0.06, 0.6), "hand": (0.015, 0.35)}
_UNITS = ((1e-3, "millimetres"), (1e-2, "centimetres"), (0.0254, "inches"), (1e3, "kilometres"))


def complete(marks: Landmarks, source: str) -> NDArray[np.bool_]:
    """Samples in which all points were seen and tell how the hand is turned.

    Args:
        marks: The points.
        source: Name of the recording, for the message.

    Returns:
        A mask, shape (n,).

    Raises:
        RecordingError: If there are fewer than five.

    Source:
        None (bookkeeping).
    """
    seen = {name: np.asarray(np.isfinite(values[:, 0])) for name, values in marks.points.items()}
    if marks.turned is not None:
        seen["hand_rotation"] = np.asarray(np.isfinite(marks.turned).all(axis=(1, 2)))
    else:
        # Points of the hand in one line do not tell how it is turned.
        size = np.linalg.norm(marks.hand_directions(), axis=1)
        if (size[:, 0] > 0.0).any():
            seen["hand points not in line"] = np.asarray((np.abs(size - 1.0) < _ROUNDING).all(axis=1))
    apart = np.linalg.norm(marks.elbow - marks.shoulder, axis=1)
    if (apart > _ROUNDING).any():
        seen["elbow away from the shoulder"] = np.asarray(apart > _ROUNDING)
    every = np.asarray(np.stack(list(seen.values())).all(axis=0))
    if every.sum() < FEWEST:
        counts = ", ".join(f"{name} in {int(mask.sum())}" for name, mask in seen.items())
        raise RecordingError(
            f"{source}: {int(every.sum())} of {len(every)} samples have all points, a fit needs {FEWEST} "
            f"({counts}): fill short gaps with fill_gaps=, or choose other markers"
        )
    return every


def check_near(recording: MarkerRecording) -> None:
    """Refuse positions no laboratory has.

    Args:
        recording: The recording.

    Raises:
        RecordingError: If a coordinate exceeds 10⁹ m; names sample and marker.

    Source:
        None (this package).
    """
    far = np.argwhere(np.abs(recording.position) > _FARTHEST)
    if far.size:
        i, j, k = far[0]
        raise RecordingError(
            f"{recording.source or 'the recording'}: marker {recording.names[j]!r} is "
            f"{recording.position[i, j, k]:g} m from the origin in sample {i}: the file is damaged there"
        )


def check_plausible(lengths: dict[str, float], source: str) -> None:
    """Refuse segment lengths no person has.

    Args:
        lengths: Mean lengths by segment, in [m].
        source: Name of the recording, for the message.

    Raises:
        UnitError: If one is too short or too long.

    Source:
        None (this package); compare Winter (2009), Fig. 4.1.
    """
    for segment, length in lengths.items():
        low, high = _PLAUSIBLE[segment]
        if low <= length <= high:
            continue
        guesses = [
            f"{name} ({factor * length:.3g} m)" for factor, name in _UNITS if low <= factor * length <= high
        ]
        hint = f"the positions may be {' or '.join(guesses)}; or" if guesses else "positions are in metres;"
        raise UnitError(
            f"{source}: the {segment.replace('_', ' ')} is {length:.4g} m long on average, expected {low:g} "
            f"to {high:g} m: {hint} a marker stands for the wrong point"
        )


def check_hand_told(markers: MarkerMap, given: bool) -> None:
    """Refuse points that leave open how the hand is turned.

    Args:
        markers: Which markers are which points.
        given: Whether the orientation of the hand is given.

    Raises:
        OptionError: If it is neither given nor told by the points.

    Source:
        None (definition).
    """
    if given or tells_hand_turned(markers.points):
        return
    raise OptionError(
        f"the points {', '.join(markers.points)} do not tell how the hand is turned: give hand_radial and "
        "hand_ulnar, or hand and one of them, or hand with wrist_radial and wrist_ulnar, or hand_rotation="
    )
