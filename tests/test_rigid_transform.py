"""Rigid transforms: what passes and what does not."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armik_sym.arm.rigid_transform import check_rigid, rotation_x
from armik_sym.errors import ArmModelError

ANGLE = st.floats(-10, 10)


def transform(rotation_vector=(0.0, 0.0, 0.0), position=(0.0, 0.0, 0.0)):
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(rotation_vector).as_matrix()
    T[:3, 3] = position
    return T


@given(ANGLE)
def test_rotation_x_turns_about_x(angle):
    np.testing.assert_allclose(rotation_x(angle), transform((angle, 0, 0)), atol=1e-14)


def test_rotation_x_turns_y_into_z_exactly():
    np.testing.assert_array_equal(rotation_x(math.pi / 2) @ [0, 1, 0, 0], [0, 0, 1, 0])


@given(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(ANGLE, ANGLE, ANGLE))
def test_every_rigid_transform_passes_unchanged(rotation_vector, position):
    T = transform(rotation_vector, position)
    np.testing.assert_array_equal(check_rigid(T, "base"), T)


def test_the_copy_is_read_only_and_does_not_follow_the_original():
    T = transform()
    copy = check_rigid(T, "base")
    T[0, 3] = 1.0
    assert copy[0, 3] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        copy[0, 3] = 1.0


def with_entry(row, column, value):
    T = transform((0.3, -0.2, 0.9), (0.1, 0.2, 0.3))
    T[row, column] = value
    return T


@pytest.mark.parametrize(
    "matrix",
    [
        pytest.param(np.diag([1.0, 1.0, -1.0, 1.0]), id="mirror"),
        pytest.param(np.diag([2.0, 0.5, 1.0, 1.0]), id="stretched, det 1"),
        pytest.param(np.diag([1.001, 1.001, 1.001, 1.0]), id="scaled"),
        pytest.param(np.eye(4) + 0.01 * np.eye(4, k=1) * [[1], [0], [0], [0]], id="sheared"),
        pytest.param(with_entry(3, 0, 0.1), id="last row"),
        pytest.param(with_entry(3, 3, 2.0), id="last entry"),
        pytest.param(np.zeros((4, 4)), id="zero"),
        pytest.param(transform((0.3, 0.2, 0.1)).round(6), id="rotation with six digits"),
    ],
)
def test_what_is_not_rigid_is_refused_with_the_error_and_the_tolerance(matrix):
    with pytest.raises(ArmModelError, match=r"tool transform is not rigid.*allowed 1e-09.*0 0 0 1"):
        check_rigid(matrix, "tool")


@pytest.mark.parametrize("matrix", [np.eye(3), np.eye(4)[:3], np.zeros(16), 1.0, with_entry(0, 3, math.nan)])
def test_what_is_no_finite_4x4_matrix_is_refused(matrix):
    with pytest.raises(ArmModelError, match=r"base transform has shape.*expected a finite 4×4"):
        check_rigid(matrix, "base")


@pytest.mark.parametrize("matrix", ["identity", [[1, 0], [0]], None, object()])
def test_what_is_not_numeric_is_refused(matrix):
    with pytest.raises(ArmModelError, match=r"base transform .*expected a"):
        check_rigid(matrix, "base")
