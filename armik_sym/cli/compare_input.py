"""From a recording to what `armik compare` needs: an arm, the path of its hand, and the measured angles."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.motion.hand_path import HandPath
    from armik_sym.motion.joint_motion import JointMotion
    from armik_sym.motion.marker_recording import MarkerRecording

_ENOUGH_FOR_POSES = 6


class Recorded(NamedTuple):
    """What a person did, as motion of an arm.

    Attributes:
        name: Name of the recording.
        arm: The arm.
        path: What the hand did.
        measured: What the joints did, as it is: limits do not bend it.
        report: How good the fit is, in lines of text; empty if nothing was fitted.
        notes: What was done to the data, one sentence each.
    """

    name: str
    arm: Arm
    path: HandPath
    measured: JointMotion
    report: str
    notes: tuple[str, ...]


def from_markers(
    file: Path,
    points: Path | None,
    unit: str | None,
    rom: str,
    **options: Any,
) -> Recorded:
    """Fit an arm to recorded markers.

    Args:
        file: The recording.
        points: TOML file that says which markers are which points; None: markers named like the points.
        unit: Unit of lengths for files that have none, or None.
        rom: "model" or "widened".
        **options: Of `fit_arm`.

    Returns:
        Arm, path and measured angles.

    Raises:
        OptionError: If an option has another value, or no markers have the names of the points.

    Source:
        None (command line).
    """
    import armik_sym as ak
    from armik_sym.comparison.predicting import first_inside

    if rom not in ("model", "widened"):
        raise OptionError(f"--rom is {rom!r}: valid are model, widened")
    recording = ak.read_markers(file, unit)
    markers = _own_names(recording) if points is None else points
    fitted = ak.fit_arm(recording, markers, rom=None if rom == "model" else "widened", **options)
    moved = first_inside(fitted.arm, fitted.unlimited.q[0])[1]
    return Recorded(
        file.name, fitted.arm, fitted.path, fitted.unlimited, str(fitted), (moved,) if moved else ()
    )


def from_angles(file: Path, arm: str) -> Recorded:
    """Take recorded joint angles of a known arm, as of an exoskeleton; the hand path follows from them.

    Args:
        file: The recording.
        arm: Name of the arm, or its file.

    Returns:
        Arm, path and measured angles; of arms with fewer than six joints the position of the hand alone.

    Raises:
        OptionError: If joints of the arm were not recorded.

    Source:
        Nguyen 2021, §4 (measured angles and end points of an exoskeleton).
    """
    import numpy as np

    import armik_sym as ak
    from armik_sym.arm.product_of_transforms import hand_pose
    from armik_sym.comparison.predicting import first_inside
    from armik_sym.motion.joint_motion import JointMotion

    model, motion = ak.load_arm(arm), ak.read_motion(file)
    missing = [name for name in model.joint_names if name not in motion.joint_names]
    if missing:
        raise OptionError(
            f"{file} has no joint {', '.join(missing)}: to know what the hand of arm {model.name!r} did, all "
            f"its joints are needed: {', '.join(model.joint_names)}"
        )
    q = motion.q[:, [motion.joint_names.index(name) for name in model.joint_names]]
    position, rotation = hand_pose(model.chain, q, model.lengths)
    turned = rotation if model.dof >= _ENOUGH_FOR_POSES else None
    path = ak.HandPath(motion.time, position, turned, f"hand of arm {model.name} in {file.name}")
    moved = first_inside(model, q[0])[1]
    measured = JointMotion(motion.time, np.asarray(q), model.joint_names)
    return Recorded(file.name, model, path, measured, "", (moved,) if moved else ())


def _own_names(recording: MarkerRecording) -> dict[str, str]:
    """Markers that are called like the points they are."""
    from armik_sym.fitting.marker_map import POINTS

    own = {name: name for name in POINTS if name in recording.names}
    if not {"shoulder", "elbow"} <= own.keys():
        raise OptionError(
            "--points is missing: a TOML file that says which markers are shoulder, elbow, wrist, hand, as "
            f'in [points] shoulder = "NAME" (markers: {", ".join(recording.names)}); a recording of joint '
            "angles needs --arm"
        )
    return own
