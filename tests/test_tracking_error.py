"""Tracking errors against SciPy's rotations, down to the last digits and up to half a turn."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS, postures
from scipy.spatial.transform import Rotation
from smooth_motions import path_of

from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.solution.tracking_error import tracking_errors
from armik_sym.symbolic import Orientation

NAMES = st.sampled_from(sorted(ARMS))
SEEDS = st.integers(0, 10**6)


@given(name=NAMES, seed=SEEDS)
def test_errors_between_two_unrelated_postures(name, seed):
    arm = ARMS[name]
    q, other = postures(arm, 5, seed), postures(arm, 5, seed + 1)
    p, R = hand_pose(arm.chain, q, arm.lengths)
    p_other, R_other = hand_pose(arm.chain, other, arm.lengths)
    distance, turn = tracking_errors(arm, q, p_other, R_other, Orientation.FULL)
    np.testing.assert_allclose(distance, np.sqrt(((p - p_other) ** 2).sum(axis=1)), atol=1e-15)
    expected = (Rotation.from_matrix(R_other).inv() * Rotation.from_matrix(R)).magnitude()
    np.testing.assert_allclose(turn, expected, atol=1e-7)

    _, pointing = tracking_errors(arm, q, p_other, R_other, Orientation.POINTING)
    f, f_other = R @ arm.pointing_axis, R_other @ arm.pointing_axis
    expected = np.arctan2(np.linalg.norm(np.cross(f, f_other), axis=1), (f * f_other).sum(axis=1))
    np.testing.assert_allclose(pointing, expected, atol=1e-7)
    assert np.all(pointing <= turn + 1e-7)


@pytest.mark.parametrize("angle", [0.0, 1e-15, 1e-12, 1e-9, 1e-4, 1.0, 3.0, np.pi - 1e-5, np.pi])
def test_angle_keeps_its_digits(angle):
    arm = ARMS["human"]
    q = postures(arm, 3, 1)
    path = path_of(arm, q)
    normal = np.cross(arm.pointing_axis, [0.36, 0.48, 0.8])
    turn = Rotation.from_rotvec(angle * normal / np.linalg.norm(normal)).as_matrix()
    wanted = path.rotation @ turn
    for orientation in (Orientation.FULL, Orientation.POINTING):
        _, found = tracking_errors(arm, q, path.position, wanted, orientation)
        np.testing.assert_allclose(found, angle, atol=2e-15 if angle < 0.1 else 5e-8, rtol=1e-6)


def test_turning_about_the_fingers_is_no_pointing_error():
    arm = ARMS["human"]
    q = postures(arm, 3, 1)
    path = path_of(arm, q)
    wanted = path.rotation @ Rotation.from_rotvec(0.7 * arm.pointing_axis).as_matrix()
    _, full = tracking_errors(arm, q, path.position, wanted, Orientation.FULL)
    _, pointing = tracking_errors(arm, q, path.position, wanted, Orientation.POINTING)
    np.testing.assert_allclose(full, 0.7, atol=1e-12)
    assert pointing.max() < 1e-14


@pytest.mark.parametrize("orientation", Orientation)
def test_without_rotations_or_wish_the_turn_is_zero(orientation):
    arm = ARMS["human"]
    q, path = postures(arm, 3, 1), path_of(arm, postures(arm, 3, 2))
    _, turn = tracking_errors(arm, q, path.position, None, orientation)
    assert np.array_equal(turn, np.zeros(3))
    if orientation is Orientation.NONE:
        _, turn = tracking_errors(arm, q, path.position, path.rotation, orientation)
        assert np.array_equal(turn, np.zeros(3))
