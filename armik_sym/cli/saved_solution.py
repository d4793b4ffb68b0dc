"""A solution that `armik solve` saved, or angles that take its place."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from armik_sym.cli.servo_input import motion_of
from armik_sym.errors import MotionFileError, OptionError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.solution import Solution

_FROM_FILE = "angles from a file"
_SAME = 1e-9


def saved_solution(file: Path, arm: Arm) -> tuple[Solution, bool] | None:
    """The solution that a file holds.

    Args:
        file: `.npz` of a solution; `.csv`, `.mot` or `.sto` of joint angles, whose hand path follows from
            them; or a hand path.
        arm: The arm.

    Returns:
        The solution, and whether the hand path asked for is known; None if the file is a hand path.

    Raises:
        OptionError: If the angles belong to another arm, or the file holds markers.
        MotionFileError: If the file cannot be read.

    Source:
        None (command line).
    """
    if file.suffix.lower() == ".npz":
        return _from_npz(file, arm), True
    motion = motion_of(file, arm)
    return None if motion is None else (_of_angles(file, arm, motion), False)


def _from_npz(file: Path, arm: Arm) -> Solution:
    import numpy as np

    from armik_sym.motion.hand_path import HandPath
    from armik_sym.solution import Solution
    from armik_sym.symbolic import Orientation

    keys = ("time", "q", "joint_names", "lower", "upper", "path_position", "path_rotation", "record")
    try:
        with np.load(file) as saved:
            found = {key: saved[key] for key in keys}
            reached = saved["reached"] if "reached" in saved.files else None
        record: dict[str, Any] = json.loads(str(found["record"]))
        _same_arm(file, arm, record, found)
        turned = found["path_rotation"] if len(found["path_rotation"]) else None
        return Solution(
            arm=arm,
            path=HandPath(found["time"], found["path_position"], turned, record["note"]),
            q=found["q"],
            method=record["method"],
            orientation=Orientation(record["orientation"]),
            requirements=_requirements(record["requirements"]),
            start=None if record["start"] is None else np.array(record["start"]),
            seed=record["seed"],
            status=record["status"],
            settings=record["settings"],
            reached=None if reached is None else np.asarray(reached, dtype=np.bool_),
            cost=record["cost"],
        )
    except (OSError, KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:
        if isinstance(error, OptionError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise MotionFileError(f"{file}: is no solution saved by this armik solve: {reason}") from None


def _same_arm(file: Path, arm: Arm, record: dict[str, Any], found: dict[str, Any]) -> None:
    import numpy as np

    names = [str(name) for name in found["joint_names"]]
    hint = "choose the arm it was solved for with --arm"
    if names != list(arm.joint_names):
        raise OptionError(
            f"{file} has the joints {', '.join(names)}; arm {arm.name!r} has "
            f"{', '.join(arm.joint_names)}: {hint}"
        )
    for name, value in record["lengths_m"].items():
        if abs(arm.lengths.get(name, np.inf) - value) > _SAME:
            raise OptionError(
                f"{file} was solved with {name} = {value:g} m; arm {arm.name!r} has "
                f"{arm.lengths.get(name, float('nan')):g} m: {hint}"
            )
    for key, limits in (("lower", arm.rom.lower), ("upper", arm.rom.upper)):
        apart = np.abs(found[key] - limits)
        if apart.max() > _SAME:
            joint = names[int(apart.argmax())]
            raise OptionError(f"{file} was solved with another {key} limit of {joint}: {hint}")


def _requirements(saved: dict[str, Any]) -> Any:
    import numpy as np

    from armik_sym.solution import Requirements

    def free(value: float | None) -> float:
        return np.inf if value is None else value

    return Requirements(
        free(saved["position_tolerance"]),
        free(saved["rotation_tolerance"]),
        np.array([free(value) for value in saved["max_speed"]]),
        np.array([free(value) for value in saved["max_acceleration"]]),
        free(saved["start_tolerance"]),
    )


def _of_angles(file: Path, arm: Arm, motion: Any) -> Solution:
    """Angles as a solution of the hand path that follows from them."""
    import numpy as np

    from armik_sym.arm.product_of_transforms import hand_pose
    from armik_sym.motion.hand_path import HandPath
    from armik_sym.solution import Requirements, Solution
    from armik_sym.symbolic import Orientation

    q = np.asarray(motion.q)
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    free = np.full(arm.dof, np.inf)
    return Solution(
        arm=arm,
        path=HandPath(motion.time, position, rotation, f"joint angles of {file.name}"),
        q=q,
        method=_FROM_FILE,
        orientation=Orientation.FULL,
        requirements=Requirements(np.inf, np.inf, free, free),
        status="read from a file",
    )
