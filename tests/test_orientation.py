"""Representations of rotations, against scipy."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armik_sym.symbolic.orientation import quaternion, roll_pitch_yaw, vee_of_difference

_R = ca.SX.sym("R", 3, 3)
_rpy = ca.Function("rpy", [_R], [roll_pitch_yaw(_R)])
_quaternion = ca.Function("quaternion", [_R], [quaternion(_R)])
_vee = ca.Function("vee", [_R], [vee_of_difference(_R)])

_angle = st.floats(-np.pi, np.pi)


@st.composite
def turns(draw, largest=np.pi):
    axis = np.array([draw(st.floats(-1, 1)) for _ in range(3)])
    norm = np.linalg.norm(axis)
    axis = axis / norm if norm > 1e-3 else np.array([0.0, 0.0, 1.0])
    return axis, draw(st.floats(0, largest))


@given(_angle, st.floats(-1.57, 1.57), _angle)
def test_roll_pitch_yaw_equals_scipy(roll, pitch, yaw):
    R = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()
    found = np.array(_rpy(R)).ravel()
    again = Rotation.from_euler("ZYX", found[::-1]).as_matrix()
    np.testing.assert_allclose(again, R, atol=1e-12)
    assert abs(found[1] - pitch) < 1e-11


@given(turns(largest=3.1))
def test_quaternion_equals_scipy(turn):
    axis, angle = turn
    R = Rotation.from_rotvec(axis * angle)
    x, y, z, w = R.as_quat(canonical=True)
    np.testing.assert_allclose(np.array(_quaternion(R.as_matrix())).ravel(), [w, x, y, z], atol=1e-12)


@given(turns())
def test_vee_is_twice_sine_times_axis(turn):
    axis, angle = turn
    R = Rotation.from_rotvec(axis * angle).as_matrix()
    np.testing.assert_allclose(np.array(_vee(R)).ravel(), 2 * np.sin(angle) * axis, atol=1e-14)


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2])
def test_roll_pitch_yaw_stays_finite_at_its_singularity(pitch):
    R = Rotation.from_euler("ZYX", [0.3, pitch, 0.2]).as_matrix()
    assert np.isfinite(np.array(_rpy(R))).all()
