"""`fit_arm`: an arm, its hand path and its joint angles from recorded points."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.catalog import human
from armik_sym.arm.model import Arm
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.errors import OptionError
from armik_sym.fitting.arm_frame import arm_frame
from armik_sym.fitting.fitted_arm import FittedArm
from armik_sym.fitting.fitted_chain import Limits, checked_limits, fitted_lengths, lengthened, limited
from armik_sym.fitting.marker_map import MarkerMap, Names, as_marker_map
from armik_sym.fitting.predicted_error import FittedChain
from armik_sym.fitting.prepare import Prepared, Processing, prepare
from armik_sym.fitting.quality import fit_quality
from armik_sym.fitting.recorded_angles import recorded_angles
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.swivel.spherical_arm import recognise

Array = NDArray[np.float64]

# Rounding of closed form and limits, in [rad] and [m].
_ROUNDING = 1e-9


def fit_arm(
    recording: MarkerRecording,
    points: MarkerMap | Mapping[str, Names] | str | os.PathLike[str],
    side: str | None = None,
    frame: str | ArrayLike | None = None,
    *,
    base: str = "fixed",
    arm: Arm | None = None,
    hand_rotation: ArrayLike | None = None,
    hand_axes: str = "x fingers, y ulnar",
    rom: str | RangeOfMotion | tuple[ArrayLike, ArrayLike] | None = None,
    cutoff_hz: float | None = None,
    fill_gaps: float | None = None,
    fill_method: str = "cubic",
    start: float | None = None,
    end: float | None = None,
) -> FittedArm:
    """Fit an arm to recorded points, and measure its joint angles.

    Segment lengths are robust means of the distances between points. The hand path is the recorded point of
    the hand (or the wrist, if no point of the hand is given; with `hand_rotation` the point of that length
    along the fingers) from the base of the arm, which is the mean shoulder or follows the recorded one. The
    joint angles are those of the closed form with the recorded elbow as the direction of the swivel. Samples
    without one of the points are left out. Nothing is filled, filtered or cut unless asked for.

    Args:
        recording: Markers over time, in [m].
        points: Which markers are which points: `shoulder`, `elbow`, `wrist` (or `wrist_radial` and
            `wrist_ulnar`, of which it is the middle), `hand`, `hand_radial`, `hand_ulnar`; each the name of a
            marker or a list of names, of which it is the mean. Or a TOML file, see `read_marker_map`.
        side: "left" or "right"; may be left out if the file says it. A right arm is mirrored.
        frame: The axes of the recording, such as "x forward, y up, z right", or R_base_recording, shape
            (3, 3); may be left out if the file says it.
        base: "fixed": the arm stands at the mean shoulder centre; "moving": it follows the recorded one
            without turning.
        arm: The kind of arm, of the left side; `catalog.human()` if left out.
        hand_rotation: Orientation of the hand in the axes of the recording, shape (n, 3, 3), or quaternions
            (w, x, y, z), shape (n, 4), instead of what points of the hand tell; never filtered or filled.
        hand_axes: What the axes of `hand_rotation` are: fingers or proximal, ulnar or radial, dorsal or
            palmar.
        rom: Range of motion: that of `arm` if left out, "widened" where the measured angles need more, or
            lower and upper limits, each of shape (dof,), in [rad].
        cutoff_hz: Cut-off of a zero-phase Butterworth filter of the markers, in [Hz]; no filter if left out.
        fill_gaps: Longest gap to fill, in [s]; no gap is filled if left out.
        fill_method: "cubic" or "linear".
        start: First time to use, in [s].
        end: Last time to use, in [s].

    Returns:
        The arm, its path, the measured angles and how far they can be trusted.

    Raises:
        OptionError: If side, frame, base, points or another option cannot be understood.
        RecordingError: If markers are missing or fewer than five samples have all points.
        UnitError: If a segment has a length no person's has, as with millimetres.
        ArmModelError: If the arm is of a kind that cannot be fitted.
        ShapeError: If `hand_rotation` or the limits have another shape.
        HandPathError: If `hand_rotation` holds what is no rotation.

    Source:
        Shimizu et al. (2008) and Al-Faiz, eq. 4-47, corrected (angles); Wu et al. (2005), ISB recommendation
        (points of the arm); None (this package) for the report.
    """
    if not isinstance(recording, MarkerRecording):
        raise OptionError(
            f"recording is a {type(recording).__name__}, expected a MarkerRecording: use read_markers(FILE)"
        )
    if base not in ("fixed", "moving"):
        raise OptionError(f"base is {base!r}, expected 'fixed' or 'moving'")
    kind = human() if arm is None else arm
    limits = checked_limits(rom, kind)
    markers = as_marker_map(points)
    whose = str(_said(side, markers.side, "side", "'left' or 'right'"))
    axes = _said(frame, markers.frame, "frame", "such as 'x forward, y up, z right'")
    to_base = arm_frame(kind).to_base(axes, whose)
    todo = Processing(start, end, fill_gaps, fill_method, cutoff_hz)
    prepared = prepare(recording, markers, whose, to_base, todo, hand_rotation, hand_axes)
    return _fitted(prepared, kind, base, limits)


def _said(given: str | ArrayLike | None, in_file: str | None, what: str, wanted: str) -> str | ArrayLike:
    said = in_file if given is None else given
    if said is None:
        raise OptionError(f"{what} is missing: give {what}=, {wanted}")
    return said


def _fitted(points: Prepared, kind: Arm, base: str, limits: Limits | None) -> FittedArm:
    anatomy = arm_frame(kind)
    lengths = fitted_lengths(points.all_marks, anatomy, points.source)
    arm, marks = lengthened(kind, lengths), points.marks
    spherical = recognise(arm)
    mean = marks.shoulder.mean(axis=0) if base == "fixed" else None
    chain = FittedChain(spherical, anatomy.hand, arm.lengths.get("hand", 0.0), mean)
    position, rotation, elbow = chain.target(marks)
    angles = recorded_angles(spherical, position, rotation, elbow)
    arm = limited(arm, limits, angles.q)
    note = f"{points.side} arm of {points.source}, {base} base"
    path = HandPath(points.time, position, rotation, note)
    # An orthogonal matrix: its transpose leads back to the axes of the recording.
    shoulder = marks.shoulder @ points.to_base
    to_shoulder = spherical.shoulder.centre - (marks.shoulder if mean is None else mean)
    return FittedArm(
        arm=arm,
        path=path,
        measured=JointMotion(path.time, arm.rom.clip(angles.q), arm.joint_names),
        unlimited=JointMotion(path.time, angles.q, arm.joint_names),
        lengths=lengths,
        side=points.side,
        base=base,
        shoulder=shoulder.mean(axis=0),
        shoulder_sd=shoulder.std(axis=0),
        to_base=points.to_base,
        elbow=marks.elbow + to_shoulder,
        wrist=marks.wrist + to_shoulder,
        sample=points.sample,
        outside=arm.rom.margin(angles.q).min(axis=1) < -_ROUNDING,
        out_of_reach=angles.shortfall > _ROUNDING,
        straight=angles.straight,
        quality=fit_quality(points, chain, angles.branch, lengths),
    )
