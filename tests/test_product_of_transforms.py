"""Forward kinematics against SciPy's rotations and against the printed DH matrices."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import cos, sin
from scipy.spatial.transform import Rotation

from armik_sym.arm import catalog
from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHConvention, DHLink, JointType
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames

LENGTHS = {"upper_arm": 0.31, "forearm": 0.25}
ANGLE = st.floats(-2 * math.pi, 2 * math.pi)
SHIFT = st.floats(-1, 1)


def rigid(rotation_vector, position):
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(rotation_vector).as_matrix()
    T[:3, 3] = position
    return T


@st.composite
def links(draw, index):
    joint = draw(st.sampled_from(JointType))
    shift_or_name = SHIFT | st.sampled_from(sorted(LENGTHS))
    return DHLink(
        f"q{index}",
        theta=draw(ANGLE),
        d=draw(SHIFT if joint is JointType.PRISMATIC else shift_or_name),
        a=draw(shift_or_name),
        alpha=draw(ANGLE | st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi])),
        joint=joint,
        sign=draw(st.sampled_from([1, -1])),
    )


@st.composite
def chains(draw):
    rows = [draw(links(i)) for i in range(draw(st.integers(0, 6)))] + [DHLink("last", alpha=draw(ANGLE))]
    triple = st.tuples(SHIFT, SHIFT, SHIFT)
    base, tool = (rigid(draw(triple), draw(triple)) for _ in range(2))
    return DHChain(tuple(rows), draw(st.sampled_from(DHConvention)), base=base, tool=tool)


def scipy_frames(chain, q):
    """Every frame as (rotation, position), composed turn by turn and shift by shift."""
    turn, origin = Rotation.from_matrix(chain.base[:3, :3].copy()), chain.base[:3, 3].copy()
    yield turn.as_matrix(), origin.copy()
    values = iter(q)
    for link in chain.links:
        theta = link.theta
        d, a = (LENGTHS.get(x, x) for x in (link.d, link.a))
        if link.joint is JointType.REVOLUTE:
            theta += link.sign * next(values)
        elif link.joint is JointType.PRISMATIC:
            d += link.sign * next(values)
        about_z = ("z", theta, [0, 0, d])
        about_x = ("x", link.alpha, [a, 0, 0])
        standard = chain.convention is DHConvention.STANDARD
        for axis, angle, shift in (about_z, about_x) if standard else (about_x, about_z):
            origin = origin + turn.apply(shift)  # along an axis and about it: the order does not matter
            turn = turn * Rotation.from_euler(axis, angle)
        yield turn.as_matrix(), origin.copy()
    yield (
        (turn * Rotation.from_matrix(chain.tool[:3, :3].copy())).as_matrix(),
        origin + turn.apply(chain.tool[:3, 3].copy()),
    )


@settings(max_examples=60, deadline=None)
@given(chains(), st.data())
def test_every_frame_agrees_with_scipy_s_rotations(chain, data):
    q = np.array([data.draw(ANGLE) for _ in range(chain.dof)])
    T = joint_frames(chain, q[None], LENGTHS)[0]
    expected = list(scipy_frames(chain, q))
    assert T.shape == (len(chain.links) + 2, 4, 4)
    for frame, (rotation, position) in zip(T, expected, strict=True):
        np.testing.assert_allclose(frame[:3, :3], rotation, rtol=0, atol=1e-12)
        np.testing.assert_allclose(frame[:3, 3], position, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(frame[3], [0, 0, 0, 1])


@settings(max_examples=30, deadline=None)
@given(chains(), st.integers(0, 5))
def test_the_hand_pose_is_the_last_frame_for_any_number_of_samples(chain, n):
    q = np.linspace(-1, 1, n * chain.dof).reshape(n, chain.dof)
    position, rotation = hand_pose(chain, q, LENGTHS)
    assert position.shape == (n, 3)
    assert rotation.shape == (n, 3, 3)
    for k in range(n):
        alone = joint_frames(chain, q[k : k + 1], LENGTHS)[0, -1]
        np.testing.assert_allclose(position[k], alone[:3, 3], rtol=0, atol=1e-14)
        np.testing.assert_allclose(rotation[k], alone[:3, :3], rtol=0, atol=1e-14)


def standard_matrix(t, d, a, al):
    """Denavit-Hartenberg, distal: the matrix every textbook prints."""
    return [
        [cos(t), -sin(t) * cos(al), sin(t) * sin(al), a * cos(t)],
        [sin(t), cos(t) * cos(al), -cos(t) * sin(al), a * sin(t)],
        [0, sin(al), cos(al), d],
        [0, 0, 0, 1],
    ]


def craig_matrix(t, d, a, al):
    """Craig, Introduction to Robotics, eq. (3.6): proximal."""
    return [
        [cos(t), -sin(t), 0, a],
        [sin(t) * cos(al), cos(t) * cos(al), -sin(al), -sin(al) * d],
        [sin(t) * sin(al), cos(t) * sin(al), cos(al), cos(al) * d],
        [0, 0, 0, 1],
    ]


@pytest.mark.parametrize(
    ("convention", "matrix"),
    [(DHConvention.STANDARD, standard_matrix), (DHConvention.MODIFIED, craig_matrix)],
)
@given(ANGLE, SHIFT, SHIFT, ANGLE, ANGLE, st.sampled_from([1, -1]))
def test_one_row_is_the_printed_matrix(convention, matrix, theta, d, a, alpha, q, sign):
    turning = DHChain((DHLink("q1", theta=theta, d=d, a=a, alpha=alpha, sign=sign),), convention)
    sliding = DHChain(
        (DHLink("q1", theta=theta, d=d, a=a, alpha=alpha, sign=sign, joint=JointType.PRISMATIC),), convention
    )
    for chain, expected in (
        (turning, matrix(theta + sign * q, d, a, alpha)),
        (sliding, matrix(theta, d + sign * q, a, alpha)),
    ):
        T = joint_frames(chain, np.array([[q]]), {})[0]
        np.testing.assert_allclose(T[1], expected, rtol=0, atol=1e-13)


def test_a_fixed_row_uses_no_joint_variable():
    rows = (
        DHLink("q1", a=1.0),
        DHLink("spacer", theta=0.3, a=2.0, joint=JointType.FIXED),
        DHLink("q2", a=4.0),
    )
    position, _ = hand_pose(DHChain(rows), np.array([[math.pi / 2, -0.3]]), {})
    np.testing.assert_allclose(position[0], [-2 * sin(0.3), 1 + 2 * cos(0.3) + 4, 0], atol=1e-14)


def test_named_lengths_are_looked_up_and_not_remembered():
    chain = DHChain((DHLink("q1", d="forearm", a="upper_arm"),))
    for upper_arm, forearm in ((0.3, 0.2), (0.5, 0.7)):
        position, _ = hand_pose(chain, np.zeros((1, 1)), {"upper_arm": upper_arm, "forearm": forearm})
        np.testing.assert_array_equal(position[0], [upper_arm, 0, forearm])


@pytest.mark.parametrize("name", catalog.names())
def test_frames_of_the_catalogue_arms_stay_rigid(name):
    arm = catalog.by_name(name)
    q = np.random.default_rng(4).uniform(arm.rom.lower, arm.rom.upper, (500, arm.dof))
    R = joint_frames(arm.chain, q, arm.lengths)[..., :3, :3]
    np.testing.assert_allclose(np.swapaxes(R, -1, -2) @ R, np.broadcast_to(np.eye(3), R.shape), atol=1e-13)
    np.testing.assert_allclose(np.linalg.det(R), 1.0)
