"""The residual of one sample."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS, postures
from scipy.spatial.transform import Rotation

from armik_sym.arm.catalog import ehmcs
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.symbolic import Orientation, express, tracking_residual

_ARM = ehmcs()


def _function(orientation, arm=_ARM):
    symbols = express(arm, "baked")
    tracked = tracking_residual(symbols, orientation)
    return ca.Function("r", [symbols.q, tracked.target], [tracked.residual])


_FULL, _POINTING, _NONE = (_function(o) for o in Orientation)


def _call(f, q, *target):
    return np.array(f(q, np.concatenate([np.ravel(part) for part in target]))).ravel()


def _pose(q, arm=_ARM):
    p, R = hand_pose(arm.chain, q[None], arm.lengths)
    return p[0], R[0]


def _frame_around(direction):
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    b1 = np.cross(direction, helper)
    b1 /= np.linalg.norm(b1)
    return direction, b1, np.cross(direction, b1)


@pytest.mark.parametrize("orientation", Orientation)
@pytest.mark.parametrize("arm", ARMS.values(), ids=list(ARMS))
def test_is_zero_on_target_and_has_the_stated_sizes(arm, orientation):
    f = _function(orientation, arm)
    assert f.numel_in(1) == orientation.target_size
    assert f.numel_out(0) == orientation.equations
    for q in postures(arm, 10):
        p, R = _pose(q, arm)
        rest = {
            Orientation.FULL: (R,),
            Orientation.POINTING: _frame_around(R @ arm.pointing_axis),
            Orientation.NONE: (),
        }[orientation]
        np.testing.assert_allclose(_call(f, q, p, *rest), 0, atol=1e-14)


@given(st.integers(0, 10_000), st.floats(0, np.pi - 1e-4))
def test_full_orientation_is_the_gibbs_vector_up_to_half_a_turn(seed, angle):
    q = postures(_ARM, 1, seed)[0]
    p, R = _pose(q)
    axis = np.random.default_rng(seed).standard_normal(3)
    axis /= np.linalg.norm(axis)
    R_target = R @ Rotation.from_rotvec(axis * angle).as_matrix().T  # E = R*ᵀ R turns by angle about axis
    wanted = 2 * np.tan(angle / 2) * axis
    found = _call(_FULL, q, p, R_target)
    # 1 + tr E loses digits next to 180°, as tan itself does.
    np.testing.assert_allclose(found[3:], wanted, atol=1e-12, rtol=1e-14 / (np.pi - angle) ** 2)
    turn = Rotation.from_matrix(R_target.T @ R).as_rotvec()
    size = np.linalg.norm(turn)
    if size > 1e-6:
        assert found[3:] @ turn > 0
    assert (np.linalg.norm(found[3:]) < 1e-9) == (size < 1e-9) or size < 1e-8


def test_full_orientation_does_not_vanish_at_half_a_turn():
    for seed, q in enumerate(postures(_ARM, 50, seed=2)):
        p, R = _pose(q)
        axis = np.random.default_rng(seed).standard_normal(3)
        axis /= np.linalg.norm(axis)
        R_target = R @ Rotation.from_rotvec(axis * (np.pi - 1e-5)).as_matrix().T
        assert np.linalg.norm(_call(_FULL, q, p, R_target)[3:]) > 1e4


def test_position_part_is_the_offset():
    q = postures(_ARM, 1)[0]
    p, R = _pose(q)
    offset = np.array([0.1, -0.2, 0.3])
    for f, rest in ((_FULL, (R,)), (_POINTING, _frame_around(R[:, 0])), (_NONE, ())):
        np.testing.assert_allclose(_call(f, q, p - offset, *rest)[:3], offset, atol=1e-15)


@given(st.integers(0, 10_000), st.floats(0, np.pi - 1e-3), st.floats(0, 2 * np.pi))
def test_pointing_vanishes_only_where_the_fingers_point_the_wanted_way(seed, angle, around):
    q = postures(_ARM, 1, seed)[0]
    p, R = _pose(q)
    fingers = R @ _ARM.pointing_axis
    _, u, v = _frame_around(fingers)
    direction = np.cos(angle) * fingers + np.sin(angle) * (np.cos(around) * u + np.sin(around) * v)
    e = _call(_POINTING, q, p, *_frame_around(direction))[3:]
    np.testing.assert_allclose(np.linalg.norm(e), 2 * np.tan(angle / 2), rtol=1e-7, atol=1e-12)


def test_pointing_almost_the_opposite_way_is_far_from_zero():
    # At exactly 180° the quotient is 0/0 in floating point; one microradian beside it, it is huge.
    for q in postures(_ARM, 50, seed=4):
        p, R = _pose(q)
        fingers, u, _ = _frame_around(R[:, 0])
        direction = np.cos(np.pi - 1e-6) * fingers + np.sin(np.pi - 1e-6) * u
        assert np.linalg.norm(_call(_POINTING, q, p, *_frame_around(direction))[3:]) > 1e5


def test_pointing_ignores_the_turn_about_the_fingers():
    q = postures(_ARM, 1)[0]
    p, R = _pose(q)
    d, b1, b2 = _frame_around(R[:, 0])
    spin = Rotation.from_rotvec(0.7 * d).as_matrix()
    np.testing.assert_allclose(_call(_POINTING, q, p, d, spin @ b1, spin @ b2), 0, atol=1e-14)
