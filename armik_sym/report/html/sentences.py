"""What a report says in words: what was asked, and whether it is what came out."""

from __future__ import annotations

import math
import re

import numpy as np

from armik_sym.arm.display_units import joint_unit
from armik_sym.arm.model import Arm
from armik_sym.report.html.chapter import Chapter
from armik_sym.report.words import at_most, joint_title, plain, without_exponents
from armik_sym.solution import Solution
from armik_sym.symbolic import Orientation

_TOUCHES = 0.05


def verdict(chapter: Chapter) -> str:
    """The verdict in one sentence.

    Args:
        chapter: The chapter.

    Returns:
        A sentence without jargon.

    Source:
        None (reporting).
    """
    s = chapter.solution
    if not s.ok:
        first, more = in_words(s.arm, s.reasons[0]), len(s.reasons) - 1
        also = f" (and {more} more {'reason' if more == 1 else 'reasons'}, listed below)" if more else ""
        return f"This motion is not what was asked for: {first}{also}."
    hand = f"the hand stays on its path ({tracking(s)})" if chapter.path_known else "the angles are complete"
    return (
        f"The arm can make this motion: {hand}, every joint stays inside its range of motion ({room(s)}), "
        f"and no joint jumps ({largest_step(s)})."
    )


def servo_verdict(chapter: Chapter) -> str:
    """What the drives make of the motion, in one sentence; empty if nobody asked.

    Args:
        chapter: The chapter.

    Returns:
        A sentence.

    Source:
        None (reporting).
    """
    found = chapter.servo
    if found is None:
        return ""
    peak = without_exponents(f"{1000 * found.tracking.hand_peak:.2g}")
    hand = f"the hand is at most {peak} mm off where it should be"
    if found.ok:
        return f"The drives of the exoskeleton can follow it: {hand}."
    slower = found.slower_by
    help_ = (
        f"They could if the motion took {slower:.2f} times as long."
        if slower is not None
        else f"Slowing it down does not help, not even {found.largest:g} times."
    )
    why = in_words(found.setup.arm, found.reasons[0])
    return f"The drives of the exoskeleton cannot follow it: {why}. {help_}"


def asked(chapter: Chapter) -> list[str]:
    """What was asked for, one sentence each.

    Args:
        chapter: The chapter.

    Returns:
        The sentences.

    Source:
        None (reporting).
    """
    s = chapter.solution
    if not chapter.path_known:
        return [
            f"The file holds the angles of {s.arm.dof} joints at {len(s.q)} instants over "
            f"{s.path.duration:.3g} s. Which hand path was asked for is not known, so errors of the hand are "
            "not shown."
        ]
    turned = {
        Orientation.FULL: "The hand has to be where the path says, and turned as it says.",
        Orientation.POINTING: "The hand has to be where the path says, with the fingers pointing as it says.",
        Orientation.NONE: "The hand has to be where the path says; how it is turned is free.",
    }
    lines = [
        f"A hand path of {len(s.q)} instants over {s.path.duration:.3g} s, for {_arm_words(s.arm)}.",
        turned[s.orientation],
        "Every joint has to stay inside its range of motion, at every instant, with no tolerance.",
    ]
    need = s.requirements
    if np.isfinite(need.position_tolerance):
        rotation = (
            f" and turned wrong by at most {plain(math.degrees(need.rotation_tolerance))}°"
            if s.orientation is not Orientation.NONE and np.isfinite(need.rotation_tolerance)
            else ""
        )
        lines.append(f"The hand may be off by at most {plain(1000 * need.position_tolerance)} mm{rotation}.")
    lines += _rate_words(s)
    lines.append(
        "The posture at the beginning was free."
        if s.start is None
        else "The posture at the beginning was given."
    )
    return lines


def tracking(s: Solution) -> str:
    """How far the hand is off its path, in words.

    Args:
        s: The solution.

    Returns:
        Text such as "off by at most 0.12 mm".

    Source:
        None (reporting).
    """
    return f"off by {at_most(1000 * float(s.position_error.max()), 'mm').replace('below', 'less than')}"


def room(s: Solution) -> str:
    """The joint nearest to a limit, in words.

    Args:
        s: The solution.

    Returns:
        Text such as "nearest to a limit: elbow flexion, with 12° to spare".

    Source:
        None (reporting).
    """
    j = int(np.argmin(s.rom_margin))
    unit, margin = joint_unit(s.arm, j), float(s.rom_margin[j])
    name = joint_title(s.arm.joint_names[j]).lower()
    if margin < 0:
        return f"outside: {name}, by {unit.text(-margin, 2)}"
    if unit.factor * margin < _TOUCHES:
        return f"{name} touches its limit"
    return f"nearest to a limit: {name}, with {unit.factor * margin:.1f}{unit.symbol} to spare"


def largest_step(s: Solution) -> str:
    """The largest change of a joint between two samples, in words.

    Args:
        s: The solution.

    Returns:
        Text such as "largest change between two instants: 1.3°, elbow flexion".

    Source:
        None (reporting).
    """
    j = int(np.argmax(s.max_step))
    name = joint_title(s.arm.joint_names[j]).lower()
    step = without_exponents(joint_unit(s.arm, j).text(float(s.max_step[j]), 2))
    return f"largest change between two instants: {step}, {name}"


def in_words(arm: Arm, text: str) -> str:
    """A sentence with the names of joints as a reader wants them: "elbow_flexion" → "elbow flexion".

    Args:
        arm: The arm.
        text: The sentence.

    Returns:
        The sentence.

    Source:
        None (reporting).
    """
    for name in sorted(arm.joint_names, key=len, reverse=True):
        text = re.sub(rf"\b{re.escape(name)}\b", joint_title(name).lower(), text)
    return without_exponents(text)


def _arm_words(arm: Arm) -> str:
    about = f" ({arm.description})" if arm.description else ""
    return f"the arm {arm.name} with {arm.dof} joints{about}"


def _rate_words(s: Solution) -> list[str]:
    need, lines = s.requirements, []
    for limits, what, per in (
        (need.max_speed, "speed", "/s"),
        (need.max_acceleration, "acceleration", "/s²"),
    ):
        finite = [j for j in range(s.arm.dof) if np.isfinite(limits[j])]
        words = {joint_unit(s.arm, j).text(float(limits[j]), 3, per) for j in finite}
        if len(words) == 1 and len(finite) == s.arm.dof:
            lines.append(f"The {what} of every joint may be at most {words.pop()}.")
        elif finite:
            names = [joint_title(s.arm.joint_names[j]).lower() for j in finite]
            values = [joint_unit(s.arm, j).text(float(limits[j]), 3, per) for j in finite]
            each = (f"{name} {value}" for name, value in zip(names, values, strict=True))
            lines.append(f"Largest {what} allowed: {', '.join(each)}.")
    return lines
