"""An arm as URDF, the robot description that Pinocchio, MuJoCo and ROS read."""

from __future__ import annotations

import math
import os
import xml.etree.ElementTree as ET
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import DHConvention, JointType
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.arm.write_arm_file import write_arm_file

Array = NDArray[np.float64]

# The format demands both for joints that move; an arm here states neither, so they must not bind.
_NO_LIMIT = "1000"
_NOISE = 1e-15
_THICKNESS = 0.02
_TYPES = {JointType.REVOLUTE: "revolute", JointType.PRISMATIC: "prismatic"}


def save_urdf(arm: Arm, path: str | os.PathLike[str]) -> Path:
    """Write an arm as a URDF file; see `urdf_text`.

    Args:
        arm: The arm.
        path: The file; its folder must exist.

    Returns:
        The path written.

    Raises:
        ArmFileError: If the file cannot be written.

    Source:
        ROS documentation, "URDF XML specification".
    """
    return write_arm_file(path, urdf_text(arm))


def urdf_text(arm: Arm) -> str:
    """An arm as URDF: joints of the same names, order, direction and limits, from "base_link" to "hand".

    With F_i the frame at q = 0 whose z axis joint i moves about or along, joint i has the origin
    F_{i-1}⁻¹ F_i and the axis ±z, and the hand is fixed at F_m⁻¹ T_base_hand(0). Base, tool, fixed rows
    and segment lengths are part of these origins. Masses are not known and left out; effort and velocity
    limits, which the format demands, are large numbers without meaning.

    Args:
        arm: The arm.

    Returns:
        The text of the file.

    Source:
        ROS documentation, "URDF XML specification"; Lynch & Park (2017), Modern robotics, section 4.1
        (product of exponentials).
    """
    robot = ET.Element("robot", name=arm.name)
    # Read by MuJoCo only: bodies without masses are allowed, and the hand stays a body of its own.
    ET.SubElement(
        ET.SubElement(robot, "mujoco"), "compiler", boundmass="1e-6", boundinertia="1e-9", fusestatic="false"
    )
    frames = [
        np.eye(4),
        *_joint_frames(arm),
        joint_frames(arm.chain, np.zeros((1, arm.dof)), arm.lengths)[0, -1],
    ]
    origins = [np.linalg.inv(before) @ after for before, after in pairwise(frames)]
    names = _link_names(arm)
    for i, name in enumerate(names):
        _add_link(robot, name, origins[i][:3, 3] if i < len(origins) else np.zeros(3))
    for i, link in enumerate(arm.chain.moving_links):
        joint = _add_joint(robot, link.name, _TYPES[link.joint], names[i : i + 2], origins[i])
        ET.SubElement(joint, "axis", xyz=f"0 0 {link.sign}")
        lower, upper = (repr(float(limits[i])) for limits in (arm.rom.lower, arm.rom.upper))
        ET.SubElement(joint, "limit", lower=lower, upper=upper, effort=_NO_LIMIT, velocity=_NO_LIMIT)
    _add_joint(robot, _free("hand_fixed", set(arm.joint_names)), "fixed", names[-2:], origins[-1])
    ET.indent(robot)
    return f'<?xml version="1.0"?>\n{ET.tostring(robot, encoding="unicode")}\n'


def _joint_frames(arm: Arm) -> list[Array]:
    """At q = 0, the frame of every moving row whose z axis is the joint's."""
    frames = joint_frames(arm.chain, np.zeros((1, arm.dof)), arm.lengths)[0]
    # Standard rows move about z of the frame before them, modified ones about z of their own.
    shift = 0 if arm.chain.convention is DHConvention.STANDARD else 1
    return [frames[i + shift] for i, link in enumerate(arm.chain.links) if link.moves]


def _link_names(arm: Arm) -> list[str]:
    names: list[str] = []
    for wanted in ("base_link", *(f"{joint}_link" for joint in arm.joint_names), "hand"):
        names.append(_free(wanted, {*names, *arm.joint_names}))
    return names


def _free(name: str, taken: set[str]) -> str:
    while name in taken:
        name += "_"
    return name


def _add_joint(robot: ET.Element, name: str, kind: str, links: list[str], origin: Array) -> ET.Element:
    joint = ET.SubElement(robot, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=links[0])
    ET.SubElement(joint, "child", link=links[1])
    ET.SubElement(joint, "origin", xyz=_numbers(origin[:3, 3]), rpy=_numbers(_roll_pitch_yaw(origin[:3, :3])))
    return joint


def _add_link(robot: ET.Element, name: str, to: Array) -> None:
    """A link, seen as a rod to the next joint."""
    link = ET.SubElement(robot, "link", name=name)
    length = float(np.linalg.norm(to))
    if length < _THICKNESS / 2:
        return
    visual = ET.SubElement(link, "visual")
    # Pitch and yaw turn z onto the direction of the rod.
    direction = np.array([0.0, math.atan2(math.hypot(to[0], to[1]), to[2]), math.atan2(to[1], to[0])])
    ET.SubElement(visual, "origin", xyz=_numbers(to / 2), rpy=_numbers(direction))
    geometry = ET.SubElement(visual, "geometry")
    ET.SubElement(geometry, "cylinder", radius=repr(_THICKNESS), length=repr(length))


def _roll_pitch_yaw(R: Array) -> Array:
    """Angles with R = Rz(yaw) Ry(pitch) Rx(roll), to rounding even where pitch is ±90°.

    There only the sum of yaw and roll counts: whatever yaw rounding gives, roll is taken to fit it.
    """
    yaw = math.atan2(R[1, 0], R[0, 0])
    c, s = math.cos(yaw), math.sin(yaw)
    pitch = math.atan2(-R[2, 0], c * R[0, 0] + s * R[1, 0])
    roll = math.atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return np.array([roll, pitch, yaw])


def _numbers(values: Array) -> str:
    return " ".join(repr(0.0 if abs(value) < _NOISE else float(value)) for value in values)
