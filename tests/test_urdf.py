"""URDF of an arm: the same kinematics in Pinocchio, the same names and limits."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from spherical_arms import ARMS, rigid

from armik_sym.arm import Arm, DHChain, DHConvention, DHLink, JointType, RangeOfMotion
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.arm.urdf import save_urdf, urdf_text
from armik_sym.errors import ArmFileError


def sliding(convention: DHConvention) -> Arm:
    rows = (
        DHLink("hand", theta=0.3, d=0.1, a=0.05, alpha=-np.pi / 2, sign=-1),
        DHLink("rail", theta=0.7, d=0.2, a="boom", alpha=0.4, joint=JointType.PRISMATIC, sign=-1),
        DHLink("plate", theta=1.0, d=0.05, alpha=1.0, joint=JointType.FIXED),
        DHLink("base", d="boom", alpha=np.pi / 2),
    )
    chain = DHChain(
        rows, convention, rigid([0.3, -0.2, 0.1], [1, 2, 3]), rigid([0, np.pi / 2, 0], [0, 0, 0.1])
    )
    return Arm("sliding", chain, RangeOfMotion([-1.0, -0.2, -3.0], [2.0, 0.3, 3.0]), {"boom": 0.4})


EVERY = {**ARMS, **{f"sliding_{kind.value}": sliding(kind) for kind in DHConvention}}


@pytest.mark.parametrize("name", EVERY)
def test_pinocchio_agrees(name: str) -> None:
    pin = pytest.importorskip("pinocchio", reason="pin is not installed")
    arm = EVERY[name]
    model = pin.buildModelFromXML(urdf_text(arm))
    assert tuple(model.names)[1:] == arm.joint_names
    np.testing.assert_array_equal(model.lowerPositionLimit, arm.rom.lower)
    np.testing.assert_array_equal(model.upperPositionLimit, arm.rom.upper)
    data, frame = model.createData(), len(model.frames) - 1
    assert model.frames[frame].name.startswith("hand")
    q = np.random.default_rng(5).uniform(-3, 3, (40, arm.dof))
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    for i in range(len(q)):
        pin.framesForwardKinematics(model, data, q[i])
        np.testing.assert_allclose(data.oMf[frame].translation, position[i], atol=1e-9)
        np.testing.assert_allclose(data.oMf[frame].rotation, rotation[i], atol=1e-9)


def numbers(text: str | None) -> np.ndarray:
    return np.array([float(cell) for cell in (text or "").split()])


def rotation_z(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


@pytest.mark.parametrize("name", EVERY)
def test_the_joints_multiplied_by_hand_agree(name: str) -> None:
    """Without Pinocchio: origin times motion about or along the axis, joint by joint."""
    arm = EVERY[name]
    robot = ET.fromstring(urdf_text(arm))  # noqa: S314
    q = list(np.random.default_rng(6).uniform(-2, 2, arm.dof))
    expected_position, expected_rotation = hand_pose(arm.chain, np.array([q]), arm.lengths)
    T, parent = np.eye(4), "base_link"
    for joint in robot.findall("joint"):
        assert joint.find("parent").attrib["link"] == parent
        parent = joint.find("child").attrib["link"]
        origin = joint.find("origin").attrib
        roll, pitch, yaw = numbers(origin["rpy"])
        around_y = np.array(
            [[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]]
        )
        around_x = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = rotation_z(yaw) @ around_y @ around_x, numbers(origin["xyz"])
        T = T @ step
        if joint.attrib["type"] != "fixed":
            sign, value, move = numbers(joint.find("axis").attrib["xyz"])[2], q.pop(0), np.eye(4)
            if joint.attrib["type"] == "revolute":
                move[:3, :3] = rotation_z(sign * value)
            else:
                move[2, 3] = sign * value
            T = T @ move
    np.testing.assert_allclose(T[:3, 3], expected_position[0], atol=1e-12)
    np.testing.assert_allclose(T[:3, :3], expected_rotation[0], atol=1e-12)


def test_names_are_unique_among_links_and_joints() -> None:
    robot = ET.fromstring(urdf_text(EVERY["sliding_standard"]))  # noqa: S314
    names = [part.attrib["name"] for part in robot if part.tag in ("link", "joint")]
    assert len(set(names)) == len(names)


def test_mujoco_loads_it(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="mujoco is not installed")
    arm = EVERY["ehmcs"]
    model = mujoco.MjModel.from_xml_path(str(save_urdf(arm, tmp_path / "arm.urdf")))
    assert model.njnt == arm.dof
    np.testing.assert_allclose(model.jnt_range, np.column_stack([arm.rom.lower, arm.rom.upper]))


def test_saving_writes_the_text_or_says_why_not(tmp_path: Path) -> None:
    arm = EVERY["human"]
    assert save_urdf(arm, tmp_path / "arm.urdf").read_text(encoding="utf-8") == urdf_text(arm)
    with pytest.raises(ArmFileError, match="there is no folder"):
        save_urdf(arm, tmp_path / "none" / "arm.urdf")
