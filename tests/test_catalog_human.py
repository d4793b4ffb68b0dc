"""The human-arm model against the printed equations, the anatomy of a left arm, and the E-HMCS."""

from __future__ import annotations

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
from scipy.spatial.transform import Rotation

from armik_sym.arm.catalog import ehmcs, human
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.errors import ArmModelError

# Table 2, column "Model", in degrees, by movement, in the order of eq. (7): flexion first.
RANGE_DEG = {
    "shoulder_flexion": (-180, 180),
    "shoulder_abduction": (-50, 175),
    "shoulder_internal_rotation": (-45, 70),
    "elbow_flexion": (0, 145),
    "forearm_pronation": (-110, 75),
    "wrist_extension": (-73, 73),
    "wrist_ulnar_deviation": (-20, 40),
}


def printed_C3(q1, q2, q3):
    """Eq. (6) and (7), as printed; the angles are q' of the paper."""
    rows = [
        [
            cos(q1) * cos(q2) * cos(q3) - sin(q1) * sin(q3),
            cos(q1) * sin(q2),
            -cos(q3) * sin(q1) - cos(q1) * cos(q2) * sin(q3),
        ],
        [-cos(q3) * sin(q2), cos(q2), sin(q2) * sin(q3)],
        [
            cos(q1) * sin(q3) + cos(q2) * cos(q3) * sin(q1),
            sin(q1) * sin(q2),
            cos(q1) * cos(q3) - cos(q2) * sin(q1) * sin(q3),
        ],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def random_postures(n=1000, spread=pi):
    return np.random.default_rng(7).uniform(-spread, spread, (n, 7))


def printed_angles(q):
    """The angles of eq. (7) from flexion, abduction and internal rotation (see the docstring of `human`)."""
    flexion, abduction, rotation = q.T[:3]
    return pi - flexion, abduction - pi / 2, rotation + pi / 2


def shoulder_rotation(arm, q):
    return joint_frames(arm.chain, q, arm.lengths)[:, 3, :3, :3]


def test_the_upper_arm_is_turned_as_in_equation_7():
    q = random_postures()
    expected = printed_C3(*printed_angles(q)) @ np.diag([-1.0, 1.0, -1.0])
    np.testing.assert_allclose(shoulder_rotation(human(), q), expected, rtol=0, atol=1e-13)


def test_equation_7_factors_into_turns_about_y_z_and_y():
    angles = np.stack(printed_angles(random_postures()), axis=1)
    expected = Rotation.from_euler("YZY", -angles).as_matrix()
    np.testing.assert_allclose(printed_C3(*angles.T), expected, rtol=0, atol=1e-13)


def test_the_arm_hangs_at_zero_with_the_thumb_forward_and_the_palm_to_the_body():
    T = frames(human())
    np.testing.assert_allclose(T[ELBOW][:3, 3], -0.28 * UP, atol=1e-15)
    np.testing.assert_allclose(T[WRIST][:3, 3], -(0.28 + 0.26) * UP, atol=1e-15)
    np.testing.assert_allclose(T[HAND][:3, 3], -(0.28 + 0.26 + 0.19) * UP, atol=1e-15)
    np.testing.assert_allclose(T[HAND][:3, :3] @ FINGERS, -UP, atol=1e-15)
    np.testing.assert_allclose(T[HAND][:3, :3] @ RADIAL, FORWARD, atol=1e-15)
    np.testing.assert_allclose(T[HAND][:3, :3] @ DORSAL, -MEDIAL, atol=1e-15)


BENT = {"elbow_flexion": 90}  # forearm forward: thumb up, palm to the body


@pytest.mark.parametrize(
    ("joint", "posture", "of", "direction"),
    [
        ("shoulder_flexion", {}, origin(ELBOW), FORWARD),
        ("shoulder_flexion", {"shoulder_flexion": 90}, origin(ELBOW), UP),
        ("shoulder_abduction", {}, origin(ELBOW), -MEDIAL),
        ("shoulder_abduction", {"shoulder_abduction": 90}, origin(ELBOW), UP),
        ("shoulder_internal_rotation", BENT, origin(WRIST), MEDIAL),
        ("elbow_flexion", {}, origin(WRIST), FORWARD),
        ("elbow_flexion", BENT, origin(WRIST), UP),
        ("forearm_pronation", BENT, axis_of_hand(RADIAL), MEDIAL),
        ("forearm_pronation", BENT, axis_of_hand(DORSAL), UP),
        ("wrist_extension", BENT, origin(HAND), -MEDIAL),
        ("wrist_ulnar_deviation", BENT, origin(HAND), -UP),
    ],
)
def test_every_joint_increases_in_the_movement_it_is_named_after(joint, posture, of, direction):
    np.testing.assert_allclose(movement(human(), joint, of, posture), direction, atol=1e-4)


def test_names_and_limits_are_those_of_table_2():
    arm = human()
    assert arm.joint_names == tuple(RANGE_DEG)
    limits = np.rad2deg(np.stack([arm.rom.lower, arm.rom.upper], axis=1))
    np.testing.assert_allclose(limits, list(RANGE_DEG.values()))


def test_the_default_lengths_are_those_of_the_model_in_table_1():
    assert dict(human().lengths) == {"upper_arm": 0.28, "forearm": 0.26, "hand": 0.19}
    assert sum(human().lengths.values()) == pytest.approx(0.73)  # the printed total, 0.74, is misadded


def test_the_points_of_the_arm_are_its_segment_lengths_apart():
    arm = human(upper_arm=0.31, forearm=0.25, hand=0.17)
    T = joint_frames(arm.chain, random_postures(), arm.lengths)[..., :3, 3]
    np.testing.assert_allclose(np.linalg.norm(T[:, ELBOW], axis=1), 0.31)
    np.testing.assert_allclose(np.linalg.norm(T[:, WRIST] - T[:, ELBOW], axis=1), 0.25)
    np.testing.assert_allclose(np.linalg.norm(T[:, HAND] - T[:, WRIST], axis=1), 0.17)


@pytest.mark.parametrize("name", ["upper_arm", "forearm", "hand"])
@pytest.mark.parametrize("value", [-0.1, 280.0, np.nan, np.inf])
def test_impossible_lengths_are_refused_by_name_and_value(name, value):
    with pytest.raises(ArmModelError, match=rf"segment length '{name}' is {value:g}, expected 0 to 5 m"):
        human(**{name: value})


E_HMCS_LIKE = {"upper_arm": 0.2869, "forearm": 0.336, "hand": 0.0}
BASE_TO_SHOULDER = np.array([0, 0, 0.143])


def human_shoulder(R_base_upper_arm):
    """Flexion, abduction and internal rotation that turn the upper arm so; eq. (7) solved by SciPy."""
    C3 = R_base_upper_arm @ np.diag([-1.0, 1.0, -1.0])
    q1, q2, q3 = -Rotation.from_matrix(C3).as_euler("YZY").T
    return np.stack([pi - q1, q2 + pi / 2, q3 - pi / 2], axis=1)


def test_from_the_elbow_on_the_angles_of_both_arms_coincide():
    q_device = random_postures(spread=1.2)
    device, arm = ehmcs(), human(**E_HMCS_LIKE)
    q_human = q_device.copy()
    q_human[:, :3] = human_shoulder(shoulder_rotation(device, q_device))
    np.testing.assert_allclose(
        shoulder_rotation(arm, q_human), shoulder_rotation(device, q_device), rtol=0, atol=1e-12
    )
    position, rotation = hand_pose(arm.chain, q_human, arm.lengths)
    expected_position, expected_rotation = hand_pose(device.chain, q_device, device.lengths)
    np.testing.assert_allclose(position + BASE_TO_SHOULDER, expected_position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rotation, expected_rotation, rtol=0, atol=1e-12)


@pytest.mark.parametrize("joint", ["shoulder_abduction", "shoulder_flexion", "shoulder_internal_rotation"])
@pytest.mark.parametrize("angle", [-40, 20, 65])
def test_a_single_shoulder_movement_is_the_same_angle_in_both_arms(joint, angle):
    posture = {joint: angle, "elbow_flexion": 70, "forearm_pronation": -30, "wrist_extension": 20}
    on_device, on_arm = frames(ehmcs(), **posture), frames(human(**E_HMCS_LIKE), **posture)
    for frame in (ELBOW, WRIST, HAND):
        np.testing.assert_allclose(
            on_arm[frame][:3, 3] + BASE_TO_SHOULDER, on_device[frame][:3, 3], atol=1e-14
        )
        np.testing.assert_allclose(on_arm[frame][:3, :3], on_device[frame][:3, :3], atol=1e-14)


def test_combined_shoulder_movements_differ_because_their_order_does():
    posture = {"shoulder_abduction": 40, "shoulder_flexion": 50}
    on_device, on_arm = frames(ehmcs(), **posture), frames(human(**E_HMCS_LIKE), **posture)
    assert np.linalg.norm(on_arm[ELBOW][:3, 3] + BASE_TO_SHOULDER - on_device[ELBOW][:3, 3]) > 0.05
