"""Targets as the tracking equations read them."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS
from smooth_motions import smooth_path

from armik_sym.symbolic import Orientation
from armik_sym.trajectory.targets import normals, stage_targets

ARM = ARMS["human"]


@given(seed=st.integers(0, 10**6))
def test_normals_complete_a_right_handed_frame(seed):
    rng = np.random.default_rng(seed)
    d = np.vstack([rng.normal(size=(10, 3)), np.eye(3), -np.eye(3), [[1, 1, 1]], [[1, 1e-9, 0]]])
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    frames = np.stack([*normals(d), d], axis=1)
    np.testing.assert_allclose(
        frames @ frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), frames.shape), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-14)


def test_full_is_position_then_rotation_row_by_row():
    path, _ = smooth_path(ARM, 5, 0)
    targets = stage_targets(ARM, path, Orientation.FULL)
    assert targets.shape == (5, 12)
    assert np.array_equal(
        targets[3], [*path.position[3], *path.rotation[3][0], *path.rotation[3][1], *path.rotation[3][2]]
    )


def test_pointing_is_position_then_where_the_fingers_shall_point():
    path, _ = smooth_path(ARM, 5, 0)
    targets = stage_targets(ARM, path, Orientation.POINTING)
    assert targets.shape == (5, 12)
    assert np.array_equal(targets[:, :3], path.position)
    for k in range(5):
        np.testing.assert_allclose(targets[k, 3:6], path.rotation[k] @ ARM.pointing_axis)
        np.testing.assert_allclose(np.cross(targets[k, 6:9], targets[k, 9:12]), targets[k, 3:6], atol=1e-14)


def test_without_orientation_it_is_the_position():
    path, _ = smooth_path(ARM, 5, 0)
    assert np.array_equal(stage_targets(ARM, path, Orientation.NONE), path.position)
