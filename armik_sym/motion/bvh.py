"""Reading and writing `.bvh` files of Biovision."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError, RecordingError, ShapeError
from armik_sym.motion.bvh_motion import CHANNELS, BvhJoint, BvhMotion
from armik_sym.motion.number_rows import read_rows
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.promised_rows import compare_rows, count_of, joined, warn
from armik_sym.motion.table_checks import check_table_names
from armik_sym.motion.text_file import write_lines
from armik_sym.motion.units import Unit, is_number, is_rate

Array = NDArray[np.float64]

_MOST_JOINTS = 5000
_END = "_end"
_APART = 2.0
_CHANNEL = {channel.lower(): channel for channel in CHANNELS}


def read_bvh(path: str | os.PathLike[str]) -> BvhMotion:
    """Read a skeleton and its motion from a `.bvh` file.

    The format states no unit of length; `BvhMotion.positions` asks for it. A header that promises another
    number of frames than there are is answered by a `MotionFileWarning`, which the note repeats.

    Args:
        path: The file.

    Returns:
        The motion, in the units of the file.

    Raises:
        MotionFileError: If the file is missing, unreadable, cut off or not of this form; names the line.

    Source:
        Meredith & Maddock (2001), Motion capture file formats explained.
    """
    file = Path(path)
    with NumberedLines(file) as lines:
        joints = _Hierarchy(lines).read()
        names = [f"{joint.name} {channel}" for joint in joints for channel in joint.channels]
        if not names:
            raise lines.error("starts the motion, but no joint has channels")
        frames = count_of(file, lines.number, "Frames", _field(lines, "Frames:"))
        said = _field(lines, "Frame Time:")
        if not is_rate(said):
            raise lines.error(f"has the frame time {said[:40]!r}, expected a positive number of seconds")
        rows = read_rows(lines, names, [Unit()] * len(names), None, gaps_from=len(names))
        if not len(rows.values):
            raise MotionFileError(
                f"{file}: the header ends on line {lines.number} and is followed by no frames"
            )
    note = joined(compare_rows(file, "Frames", frames, len(rows.values)), _twice_shifted(file, joints))
    note = joined(note, _first_apart(file, rows.values[:, [name.endswith("rotation") for name in names]]))
    try:
        return BvhMotion(tuple(joints), float(said), rows.values, note, file.name)
    except (RecordingError, ShapeError) as error:
        raise MotionFileError(f"{file}: {error}") from None


def write_bvh(path: str | os.PathLike[str], motion: BvhMotion) -> None:
    """Write a skeleton and its motion as a `.bvh` file.

    Read again, everything is the same to the last bit.

    Args:
        path: The file; its folder must exist.
        motion: The motion.

    Raises:
        MotionFileError: If a name cannot be written, or the file cannot.

    Source:
        Meredith & Maddock (2001), Motion capture file formats explained.
    """
    file = Path(path)
    check_table_names(file, motion.names, forbidden=" \t{}", what="joint")
    # Any white space inside a name is read as one blank.
    spaced = [name for name in motion.names if name.split() != [name]]
    if spaced:
        raise MotionFileError(f"{file}: joint {spaced[0]!r} cannot be written in this form: it has blanks")
    lines = ["HIERARCHY"]
    open_joints: list[int] = []
    for index, joint in enumerate(motion.joints):
        while open_joints and open_joints[-1] != joint.parent:
            open_joints.pop()
            lines.append("\t" * len(open_joints) + "}")
        if joint.parent >= 0 and not open_joints:
            raise MotionFileError(f"{file}: joint {joint.name!r} does not follow its parent's other children")
        lines += _joint_lines(file, motion, index, len(open_joints))
        open_joints.append(index)
    lines += ["\t" * depth + "}" for depth in reversed(range(len(open_joints)))]
    lines += ["MOTION", f"Frames: {len(motion)}", f"Frame Time: {motion.frame_time!r}"]
    lines += [" ".join(map(repr, row)) for row in motion.values.tolist()]
    write_lines(file, lines)


def _joint_lines(file: Path, motion: BvhMotion, index: int, depth: int) -> list[str]:
    joint, tab = motion.joints[index], "\t" * depth
    is_end = not joint.channels and joint.parent >= 0
    if is_end and (
        joint.name != motion.joints[joint.parent].name + _END
        or any(other.parent == index for other in motion.joints)
    ):
        raise MotionFileError(
            f"{file}: joint {joint.name!r} has no channels: only the end of a limb, called "
            f"{motion.joints[joint.parent].name + _END!r} after its parent, can be without"
        )
    head = "End Site" if is_end else f"{'JOINT' if joint.parent >= 0 else 'ROOT'} {joint.name}"
    lines = [f"{tab}{head}", f"{tab}{{", f"{tab}\tOFFSET {' '.join(repr(float(x)) for x in joint.offset)}"]
    if not is_end:
        lines.append(f"{tab}\tCHANNELS {len(joint.channels)} {' '.join(joint.channels)}".rstrip())
    return lines


class _Hierarchy:
    """The first part of the file: joints inside the braces of their parents."""

    def __init__(self, lines: NumberedLines) -> None:
        self.lines = lines
        self.joints: list[BvhJoint] = []
        self.names: set[str] = set()

    def read(self) -> list[BvhJoint]:
        if self.words() != ["HIERARCHY"]:
            raise self.lines.error("does not say HIERARCHY: this is no .bvh file")
        open_joints: list[int] = []
        while (words := self.words()) != ["MOTION"]:
            if words == ["}"]:
                if not open_joints:
                    raise self.lines.error("closes a brace that was never opened")
                open_joints.pop()
                continue
            open_joints.append(self.joint(words, open_joints[-1] if open_joints else -1))
        if open_joints or not self.joints:
            left = (
                f"{len(open_joints)} braces are" if open_joints else "no ROOT is there, and the hierarchy is"
            )
            raise self.lines.error(f"starts the motion, but {left} not closed")
        return self.joints

    def words(self) -> list[str]:
        line = self.lines.next_content()
        if line is None:
            if not self.lines.number:
                raise MotionFileError(f"{self.lines.path}: the file is empty")
            raise self.lines.error("is the last one, inside the hierarchy: the file is cut off")
        return line.split()

    def joint(self, words: list[str], parent: int) -> int:
        """Read a joint up to its channels."""
        is_end = words[0] == "End"
        wanted = "JOINT, End Site or '}'" if parent >= 0 else "one ROOT, then MOTION"
        fits = words[0] == ("ROOT" if not self.joints else "JOINT") or (is_end and parent >= 0)
        if not fits or (parent < 0 and self.joints) or (len(words) < 2 and not is_end):
            raise self.lines.error(f"is {' '.join(words)[:40]!r}, expected {wanted}")
        name = self.joints[parent].name + _END if is_end else " ".join(words[1:]).removesuffix("{").strip()
        if name in self.names:
            raise self.lines.error(f"names the joint {name!r} a second time")
        if len(self.joints) >= _MOST_JOINTS:
            raise self.lines.error(f"names more than {_MOST_JOINTS} joints")
        if words[-1] != "{" and self.words() != ["{"]:
            raise self.lines.error(f"does not open the braces of joint {name!r}")
        offset = self.offset()
        channels = () if is_end else self.channels()
        self.names.add(name)
        self.joints.append(BvhJoint(name, parent, offset, channels))
        return len(self.joints) - 1

    def offset(self) -> tuple[float, float, float]:
        words = self.words()
        if words[0] != "OFFSET" or len(words) != 4 or not all(map(is_number, words[1:])):
            raise self.lines.error(f"is {' '.join(words)[:40]!r}, expected OFFSET and three numbers")
        return float(words[1]), float(words[2]), float(words[3])

    def channels(self) -> tuple[str, ...]:
        words = self.words()
        given = [_CHANNEL.get(word.lower(), "") for word in words[2:]]
        counted = len(words) > 1 and words[1] == str(len(given))
        if words[0] != "CHANNELS" or not counted or "" in given or len(set(given)) < len(given):
            raise self.lines.error(
                f"is {' '.join(words)[:60]!r}, expected CHANNELS, their number, and some of "
                f"{', '.join(CHANNELS)}"
            )
        return tuple(given)


def _field(lines: NumberedLines, key: str) -> str:
    line = (lines.next_content() or "").strip()
    if not line.lower().startswith(key.lower()):
        raise lines.error(f"is {line[:40]!r}, expected '{key}' and a number")
    return line[len(key) :].strip()


def _first_apart(file: Path, turns: Array) -> str:
    """Many files start with a rest posture (T-pose) that is no part of the motion."""
    steps = np.abs((np.diff(turns, axis=0) + 180.0) % 360.0 - 180.0).max(axis=1, initial=0.0)
    if len(steps) < 2 or not steps[0] > _APART * steps[1:].max():
        return ""
    return warn(
        file,
        f"the first frame stands apart: rotations jump by {steps[0]:.3g}° after it, later by "
        f"{steps[1:].max():.3g}° at most; often it is a rest posture (T-pose) and no part of the motion",
    )


def _twice_shifted(file: Path, joints: list[BvhJoint]) -> str:
    """Programs disagree on whether position channels add to an offset or replace it: say so."""
    both = [joint.name for joint in joints if any(joint.offset) and "position" in " ".join(joint.channels)]
    if not both:
        return ""
    return warn(
        file,
        f"joint {both[0]!r} has an offset and position channels, which are added here; some programs write "
        "channels that already contain the offset",
    )
