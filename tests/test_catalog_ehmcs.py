"""The E-HMCS against the printed equations and against the anatomy of a left arm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from anatomy import (
    DORSAL,
    ELBOW,
    FINGERS,
    FORWARD,
    HAND,
    MEDIAL,
    RADIAL,
    UP,
    WRIST,
    axis_of_hand,
    frames,
    movement,
    origin,
)
from numpy import cos, pi, sin

from armik_sym.arm.catalog import ehmcs
from armik_sym.arm.dh import DHConvention, JointType
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.arm.rigid_transform import check_rigid
from armik_sym.errors import ArmModelError, OptionError

# Table 2, column "Model", in degrees, by movement.
RANGE_DEG = {
    "shoulder_abduction": (-50, 175),
    "shoulder_flexion": (-180, 180),
    "shoulder_internal_rotation": (-45, 70),
    "elbow_flexion": (0, 145),
    "forearm_pronation": (-110, 75),
    "wrist_extension": (-73, 73),
    "wrist_ulnar_deviation": (-20, 40),
}


def printed_position_mm(q1, q2, q3, q4):
    """Eq. (3), as printed, in millimetres."""
    xE = (
        (2869 * cos(q1) * sin(q2 - pi / 2)) / 10
        - 336 * sin(q4) * (sin(q1) * sin(q3) - cos(q1) * cos(q3) * cos(q2 - pi / 2))
        + 336 * cos(q1) * cos(q4) * sin(q2 - pi / 2)
    )
    yE = (
        (2869 * sin(q1) * sin(q2 - pi / 2)) / 10
        + 336 * sin(q4) * (cos(q1) * sin(q3) + cos(q3) * cos(q2 - pi / 2) * sin(q1))
        + 336 * cos(q4) * sin(q1) * sin(q2 - pi / 2)
    )
    zE = (
        (2869 * cos(q2 - pi / 2)) / 10
        + 336 * cos(q4) * cos(q2 - pi / 2)
        - 336 * cos(q3) * sin(q4) * sin(q2 - pi / 2)
        + 143
    )
    return np.stack([xE, yE, zE], axis=-1)


def random_postures(n=10_000):
    return np.random.default_rng(2021).uniform(-pi, pi, (n, 7))


def miss(chain, arm, q):
    """Distance from eq. (3), in [m]."""
    position, _ = hand_pose(chain, q, arm.lengths)
    return np.linalg.norm(position - printed_position_mm(*q.T[:4]) / 1000, axis=1)


@pytest.mark.parametrize("dof", [7, 5, 4])
def test_the_position_is_that_of_equation_3(dof):
    arm = ehmcs(dof)
    q = random_postures()[:, :dof]
    position, _ = hand_pose(arm.chain, q, arm.lengths)
    np.testing.assert_allclose(position, printed_position_mm(*q.T[:4]) / 1000, rtol=0, atol=1e-12)


def test_the_printed_shift_of_7_mm_misses_equation_3_by_7_mm_everywhere():
    arm = ehmcs()
    rows = list(arm.chain.links)
    rows[1] = replace(rows[1], d=0.007)
    np.testing.assert_allclose(miss(replace(arm.chain, links=tuple(rows)), arm, random_postures()), 0.007)


def test_the_modified_convention_misses_equation_3_by_decimetres():
    arm = ehmcs()
    error = miss(replace(arm.chain, convention=DHConvention.MODIFIED), arm, random_postures())
    assert error.max() > 0.9
    assert np.median(error) > 0.5


TABLE_4 = [  # θ offset [°], sign of q, d [mm], a [mm], α [°]; d2 = 0 as in eq. (3)
    (0, 1, 143, 0, 90),
    (90, -1, 0, 0, -90),
    (0, 1, 286.9, 0, -90),
    (0, 1, 0, 0, 90),
    (90, 1, 336, 0, 90),
    (90, 1, 0, 0, -90),
    (0, 1, 0, 0, 0),
]


def test_the_rows_are_those_of_table_4():
    arm = ehmcs()
    for link, (theta, sign, d, a, alpha) in zip(arm.chain.links, TABLE_4, strict=True):
        shift = arm.lengths[link.d] if isinstance(link.d, str) else link.d
        row = (np.rad2deg(link.theta), link.sign, 1000 * shift, 1000 * link.a, np.rad2deg(link.alpha))
        assert row == pytest.approx((theta, sign, d, a, alpha))


def equation_1(theta, d, a, alpha, *, as_printed):
    """Eq. (1) as printed, or with its third row as in Craig's modified convention."""
    last = [sin(theta) * sin(alpha), cos(theta) * sin(alpha), cos(alpha), d * cos(alpha)]
    if as_printed:
        last = [sin(theta) * sin(alpha), sin(theta) * sin(alpha), -cos(alpha), -d * cos(alpha)]
    return np.array(
        [
            [cos(theta), -sin(theta), 0, a],
            [sin(theta) * cos(alpha), cos(theta) * cos(alpha), -sin(alpha), -d * sin(alpha)],
            last,
            [0, 0, 0, 1],
        ]
    )


@pytest.mark.parametrize("row", TABLE_4)
def test_equation_1_as_printed_is_no_rigid_transform(row):
    offset, sign, d, a, alpha = row
    theta = np.deg2rad(offset) + sign * 0.4
    check_rigid(equation_1(theta, d, a, np.deg2rad(alpha), as_printed=False), "corrected")
    with pytest.raises(ArmModelError, match="not rigid"):
        check_rigid(equation_1(theta, d, a, np.deg2rad(alpha), as_printed=True), "printed")


def test_the_arm_hangs_at_zero_with_the_thumb_forward_and_the_palm_to_the_body():
    T = frames(ehmcs())
    shoulder = np.array([0, 0, 0.143])
    np.testing.assert_allclose(T[ELBOW][:3, 3], shoulder - 0.2869 * UP, atol=1e-15)
    np.testing.assert_allclose(T[WRIST][:3, 3], shoulder - (0.2869 + 0.336) * UP, atol=1e-15)
    np.testing.assert_allclose(T[HAND][:3, :3] @ FINGERS, -UP, atol=1e-15)
    np.testing.assert_allclose(T[HAND][:3, :3] @ RADIAL, FORWARD, atol=1e-15)
    np.testing.assert_allclose(T[HAND][:3, :3] @ DORSAL, -MEDIAL, atol=1e-15)


BENT = {"elbow_flexion": 90}  # forearm forward: thumb up, palm to the body


@pytest.mark.parametrize(
    ("joint", "posture", "of", "direction"),
    [
        ("shoulder_abduction", {}, origin(ELBOW), -MEDIAL),
        ("shoulder_flexion", {}, origin(ELBOW), FORWARD),
        ("shoulder_flexion", {"shoulder_flexion": 90}, origin(ELBOW), UP),
        ("shoulder_abduction", {"shoulder_abduction": 90}, origin(ELBOW), UP),
        ("shoulder_internal_rotation", BENT, origin(WRIST), MEDIAL),
        ("elbow_flexion", {}, origin(WRIST), FORWARD),
        ("elbow_flexion", BENT, origin(WRIST), UP),
        ("forearm_pronation", BENT, axis_of_hand(RADIAL), MEDIAL),
        ("forearm_pronation", BENT, axis_of_hand(DORSAL), UP),
        ("wrist_extension", BENT, axis_of_hand(FINGERS), -MEDIAL),
        ("wrist_ulnar_deviation", BENT, axis_of_hand(FINGERS), -UP),
    ],
)
def test_every_joint_increases_in_the_movement_it_is_named_after(joint, posture, of, direction):
    np.testing.assert_allclose(movement(ehmcs(), joint, of, posture), direction, atol=1e-4)


@pytest.mark.parametrize("dof", [7, 5, 4])
def test_names_and_limits_are_those_of_table_2(dof):
    arm = ehmcs(dof)
    assert arm.joint_names == tuple(RANGE_DEG)[:dof]
    limits = np.rad2deg(np.stack([arm.rom.lower, arm.rom.upper], axis=1))
    np.testing.assert_allclose(limits, list(RANGE_DEG.values())[:dof])


@pytest.mark.parametrize("dof", [5, 4])
def test_a_shorter_arm_ends_at_frame_5_of_the_whole_one(dof):
    q = random_postures(50)
    q[:, dof:5] = 0.0
    whole, short = ehmcs(), ehmcs(dof)
    frame_5 = joint_frames(whole.chain, q, whole.lengths)[:, 5]
    position, rotation = hand_pose(short.chain, q[:, :dof], short.lengths)
    np.testing.assert_allclose(position, frame_5[:, :3, 3], atol=1e-14)
    np.testing.assert_allclose(rotation, frame_5[:, :3, :3], atol=1e-14)


@pytest.mark.parametrize("dof", [7, 5, 4])
def test_the_pointing_axis_lies_along_the_forearm_while_the_wrist_is_straight(dof):
    arm = ehmcs(dof)
    q = random_postures(50)[:, :dof]
    q[:, 5:] = 0.0
    T = joint_frames(arm.chain, q, arm.lengths)
    forearm = T[:, WRIST, :3, 3] - T[:, ELBOW, :3, 3]
    pointing = T[:, HAND, :3, :3] @ arm.pointing_axis
    np.testing.assert_allclose(pointing, forearm / 0.336, atol=1e-13)


def test_the_four_joint_arm_keeps_the_forearm_row_fixed():
    assert ehmcs(4).chain.links[4].joint is JointType.FIXED


@pytest.mark.parametrize("dof", [0, 3, 6, 8, "7", None])
def test_another_number_of_joints_is_refused_with_the_three_that_exist(dof):
    with pytest.raises(OptionError) as caught:
        ehmcs(dof)
    message = str(caught.value)
    assert f"dof is {dof!r}" in message
    assert "7 (all), 5 (measured) or 4 (wrist position)" in message
