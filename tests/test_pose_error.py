"""The twist from the hand to a sample, against SciPy and against finite differences."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS, postures
from scipy.spatial.transform import Rotation
from smooth_motions import path_of

from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.kinematics import compile
from armik_sym.motion.rotation_vector import rotation_vector
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.pose_error import SampleError

ARM = ARMS["human"]
SEEDS = st.integers(0, 10**6)
ANGLES = st.one_of(
    st.floats(0, np.pi),
    st.sampled_from([0.0, 1e-12, 1e-8, 1e-7, 1e-6, 2e-6, 1e-3]),
    st.sampled_from([np.pi - 1e-3, np.pi - 2e-6, np.pi - 1e-6, np.pi - 1e-7, np.pi - 1e-9, np.pi]),
)


def unit(seed):
    v = np.random.default_rng(seed).normal(size=3)
    return v / np.linalg.norm(v)


@given(angle=ANGLES, seed=SEEDS)
def test_rotation_vector_is_scipys(angle, seed):
    axis = unit(seed)
    R = Rotation.from_rotvec(angle * axis).as_matrix()
    w = rotation_vector(R)
    expected = Rotation.from_matrix(R).as_rotvec()
    near_half_turn = angle > np.pi - 1e-5
    if near_half_turn and w @ expected < 0:
        expected = -expected  # at half a turn both directions are the same rotation
    np.testing.assert_allclose(w, expected, atol=3e-6 if near_half_turn else 1e-9)
    assert np.linalg.norm(w) <= np.pi + 1e-12
    np.testing.assert_allclose(Rotation.from_rotvec(w).as_matrix(), R, atol=3e-6 if near_half_turn else 1e-9)


@pytest.mark.parametrize("axis", [*np.eye(3), *-np.eye(3), [0.6, -0.8, 0.0], [0.0, -0.6, 0.8]])
def test_half_turns_about_the_axes(axis):
    R = 2 * np.outer(axis, axis) - np.eye(3)
    w = rotation_vector(R)
    assert np.linalg.norm(w) == pytest.approx(np.pi)
    np.testing.assert_allclose(np.abs(w @ np.asarray(axis)), np.pi)


@pytest.mark.parametrize("orientation", Orientation)
@given(seed=SEEDS)
def test_error_is_zero_on_the_sample_and_points_to_it_elsewhere(orientation, seed):
    q = postures(ARM, 3, seed)
    path = path_of(ARM, q)
    error = SampleError(ARM, path, orientation)
    kinematics = compile(ARM, "vm")
    on, rows = error(1, *kinematics.pose_and_jacobian(q[1]))
    assert np.abs(on).max() < 1e-12
    assert rows.shape == (3 if orientation is Orientation.NONE else 6, ARM.dof)
    e, _ = error(1, *kinematics.pose_and_jacobian(q[0]))
    p, R = hand_pose(ARM.chain, q, ARM.lengths)
    np.testing.assert_allclose(e[:3], p[1] - p[0], atol=1e-12)
    if orientation is Orientation.FULL:
        turned = Rotation.from_rotvec(e[3:] / SampleError.radian_length).as_matrix() @ R[0]
        np.testing.assert_allclose(turned, R[1], atol=1e-7)
    if orientation is Orientation.POINTING:
        w = e[3:] / SampleError.radian_length
        turned = Rotation.from_rotvec(w).as_matrix() @ R[0] @ ARM.pointing_axis
        np.testing.assert_allclose(turned, R[1] @ ARM.pointing_axis, atol=1e-7)
        assert abs(w @ (R[0] @ ARM.pointing_axis)) < 1e-9


@pytest.mark.parametrize("orientation", Orientation)
def test_rows_are_how_the_error_shrinks_near_the_sample(orientation):
    kinematics = compile(ARM, "vm")
    q = postures(ARM, 2, 4)
    error = SampleError(ARM, path_of(ARM, q), orientation)
    _, rows = error(0, *kinematics.pose_and_jacobian(q[0]))
    for step in 1e-6 * np.eye(ARM.dof):
        e, _ = error(0, *kinematics.pose_and_jacobian(q[0] + step))
        np.testing.assert_allclose(-e, rows @ step, atol=1e-11)


@pytest.mark.parametrize("sign", [1, -1])
def test_pointing_backwards_is_half_a_turn_across_the_fingers(sign):
    q = postures(ARM, 2, 4)
    path = path_of(ARM, q)
    across = np.cross(ARM.pointing_axis, [0.36, 0.48, 0.8])
    half = Rotation.from_rotvec(sign * np.pi * across / np.linalg.norm(across)).as_matrix()
    back = type(path)(path.time, path.position, path.rotation @ half)
    kinematics = compile(ARM, "vm")
    e, rows = SampleError(ARM, back, Orientation.POINTING)(0, *kinematics.pose_and_jacobian(q[0]))
    assert np.linalg.norm(e[3:]) == pytest.approx(SampleError.radian_length * np.pi, rel=1e-6)
    assert abs(e[3:] @ path.rotation[0] @ ARM.pointing_axis) < 1e-6
    assert np.all(np.isfinite(rows))


def test_a_path_without_rotations_asks_for_positions_only():
    q = postures(ARM, 2, 4)
    error = SampleError(ARM, path_of(ARM, q, turned=False), Orientation.FULL)
    e, _ = error(0, *compile(ARM, "vm").pose_and_jacobian(q[1]))
    assert e.shape == (3,)
