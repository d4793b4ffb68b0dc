"""HandPath and JointMotion: what they accept, and what each refusal says."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armik_sym.errors import ArmikError, HandPathError, ShapeError, UnitError
from armik_sym.motion import HandPath, JointMotion

TIME = np.array([0.0, 0.1, 0.2])
POSITION = np.array([[0.1, 0.2, 0.3], [0.1, 0.2, 0.4], [0.1, 0.2, 0.5]])
IDENTITY = np.broadcast_to(np.eye(3), (3, 3, 3))


def random_turns(seed):
    return Rotation.from_quat(np.random.default_rng(seed).normal(size=(3, 4)))


def changed(values, index, value):
    copy = np.array(values, dtype=float)
    copy[index] = value
    return copy


def test_keeps_read_only_float64_copies():
    time, position = [0, 1], [[0, 0, 0], [1, 0, 0]]
    path = HandPath(time, position, np.broadcast_to(np.eye(3), (2, 3, 3)))
    position[0][0] = 5
    assert path.position[0, 0] == 0.0
    for values in (path.time, path.position, path.rotation):
        assert values.dtype == np.float64
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1.0


def test_size_duration_and_words():
    path = HandPath(TIME + 3.0, POSITION)
    assert (path.n, len(path), path.rotation) == (3, 3, None)
    assert path.duration == pytest.approx(0.2)
    assert repr(path) == "HandPath(3 samples, 0.2 s, position only)"
    assert "with rotation" in repr(HandPath(TIME, POSITION, IDENTITY))


def test_survives_pickling():
    path = pickle.loads(pickle.dumps(HandPath(TIME, POSITION, IDENTITY)))  # noqa: S301
    assert np.array_equal(path.position, POSITION)


@pytest.mark.parametrize(
    ("time", "position", "rotation", "words"),
    [
        (0.5, POSITION, None, ["time", "()", "(n,)"]),
        (TIME[:, None], POSITION, None, ["time", "(3, 1)", "(n,)"]),
        ([0.0], POSITION[:1], None, ["time", "(1,)", "at least two samples"]),
        ([], np.zeros((0, 3)), None, ["(0,)", "at least two samples"]),
        (TIME, POSITION.T[:2], None, ["position", "(2, 3)", "(3, 3)", "3 times"]),
        (TIME, POSITION[:, :2], None, ["position", "(3, 2)", "(3, 3)"]),
        (TIME, POSITION, np.eye(3), ["rotation", "(3, 3)", "(3, 3, 3)", "one matrix"]),
    ],
)
def test_wrong_shapes(time, position, rotation, words):
    with pytest.raises(ShapeError) as caught:
        HandPath(time, position, rotation)
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_not_finite_says_which_sample_which_quantity_and_how_many_more(bad):
    with pytest.raises(HandPathError, match=r"time of sample 1 is .*fill the gap"):
        HandPath(changed(TIME, 1, bad), POSITION)
    with pytest.raises(HandPathError, match=r"position of sample 1 \(and of 1 further samples\) is \["):
        HandPath(TIME, changed(changed(POSITION, (1, 2), bad), (2, 0), bad))
    with pytest.raises(HandPathError, match="rotation of sample 2 is"):
        HandPath(TIME, POSITION, changed(IDENTITY, (2, 0, 0), bad))


def test_masked_samples_are_gaps_not_numbers():
    with pytest.raises(HandPathError, match="position of sample 1"):
        HandPath(TIME, np.ma.masked_equal(POSITION, 0.4))
    with pytest.raises(HandPathError, match="position of sample 0"):
        HandPath(TIME[:2], [[None, 0, 0], [0, 0, 0]])


@pytest.mark.parametrize("junk", [["a", "b"], [1j, 2j], [{}, {}], [[0.0], [0.0, 1.0]]])
def test_no_numbers(junk):
    with pytest.raises(HandPathError, match="time is not an array of numbers"):
        HandPath(junk, POSITION[:2])


def test_long_junk_is_shortened():
    with pytest.raises(HandPathError) as caught:
        HandPath(["x" * 1000], POSITION)
    assert len(str(caught.value)) < 250


def test_time_must_increase():
    with pytest.raises(HandPathError, match=r"time of sample 2 is 0\.1 s, equal to the one before"):
        HandPath([0.0, 0.1, 0.1], POSITION)
    with pytest.raises(HandPathError, match=r"runs backwards at sample 1: 0\.1 s after 0\.3 s"):
        HandPath([0.3, 0.1, 0.2], POSITION)
    HandPath([0.0, np.nextafter(0.0, 1.0), 1e-300], POSITION)


def test_millimetres_are_noticed():
    with pytest.raises(UnitError, match=r"sample 1 is \(0\.1, 0\.2, -412\) m.*divide by 1000"):
        HandPath(TIME, changed(POSITION, (1, 2), -412.0))
    HandPath(TIME, changed(POSITION, (1, 2), 10.0))


def test_rotation_must_be_one():
    with pytest.raises(HandPathError, match=r"sample 1 is no rotation.*0\.002.*1e-06.*1 of 3"):
        HandPath(TIME, POSITION, changed(IDENTITY, (1, 0, 0), 1.001))
    with pytest.raises(HandPathError, match=r"sample 2 is a reflection.*mirrored axes"):
        HandPath(TIME, POSITION, changed(IDENTITY, (2, 1, 1), -1.0))
    with pytest.raises(HandPathError, match="no rotation"):
        HandPath(TIME, POSITION, changed(IDENTITY, (0, 0, 0), 1e200))


def test_the_tolerance_of_rotations_has_an_edge():
    HandPath(TIME, POSITION, changed(IDENTITY, (1, 0, 0), 1 + 0.49e-6))
    with pytest.raises(HandPathError):
        HandPath(TIME, POSITION, changed(IDENTITY, (1, 0, 0), 1 + 0.51e-6))


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_rounded_rotations_become_exact_and_then_stay(seed):
    given_rotation = np.round(random_turns(seed).as_matrix(), 7)
    path = HandPath(TIME, POSITION, given_rotation)
    U, _, Vt = np.linalg.svd(given_rotation)
    assert np.abs(np.swapaxes(path.rotation, 1, 2) @ path.rotation - np.eye(3)).max() <= 1.2e-15
    assert np.abs(path.rotation - U @ Vt).max() < 2e-14
    assert np.abs(HandPath(TIME, POSITION, path.rotation).rotation - path.rotation).max() <= 1e-15


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.9991, 1.0009))
def test_quaternions_are_scalar_first_and_normalised(seed, length):
    turn = random_turns(seed)
    path = HandPath.from_quaternions(TIME, POSITION, length * turn.as_quat()[:, [3, 0, 1, 2]])
    assert np.abs(path.rotation - turn.as_matrix()).max() < 1e-14


def test_quaternions_refused():
    unit = np.tile([1.0, 0, 0, 0], (3, 1))
    with pytest.raises(HandPathError, match=r"quaternion of sample 1 is .*length 1\.0011, expected a unit"):
        HandPath.from_quaternions(TIME, POSITION, changed(unit, (1, 0), 1.0011))
    with pytest.raises(HandPathError, match="length 0"):
        HandPath.from_quaternions(TIME, POSITION, changed(unit, (0, 0), 0.0))
    with pytest.raises(HandPathError, match="quaternion of sample 2"):
        HandPath.from_quaternions(TIME, POSITION, changed(unit, (2, 0), np.nan))
    with pytest.raises(HandPathError, match="length inf"):
        HandPath.from_quaternions(TIME, POSITION, changed(unit, (2, 0), 1e200))
    with pytest.raises(ShapeError, match=r"quaternion has shape \(3, 3\), expected \(3, 4\)"):
        HandPath.from_quaternions(TIME, POSITION, unit[:, :3])


def test_joint_motion():
    motion = JointMotion(TIME, np.zeros((3, 2)), ["shoulder", "elbow"])
    assert (motion.n, len(motion), motion.dof, motion.joint_names) == (3, 3, 2, ("shoulder", "elbow"))
    assert motion.duration == pytest.approx(0.2)
    assert repr(motion) == "JointMotion(3 samples, 0.2 s, joints shoulder, elbow)"
    assert not motion.q.flags.writeable
    assert len(JointMotion([0.0], [[1.0]], ("elbow",))) == 1


@pytest.mark.parametrize(
    ("time", "q", "names", "error", "words"),
    [
        (TIME, np.zeros((2, 2)), ("a", "b"), ShapeError, r"q has shape \(2, 2\), expected \(3, dof\)"),
        (TIME, np.zeros(3), ("a",), ShapeError, r"expected \(3, dof\)"),
        ([], np.zeros((0, 1)), ("a",), ShapeError, "needs a sample"),
        (TIME, np.zeros((3, 2)), ("a",), ShapeError, "2 columns but there are 1 joint names"),
        (TIME, np.zeros((3, 0)), (), ShapeError, "0 columns"),
        (TIME, np.zeros((3, 1)), "a", HandPathError, "expected a tuple"),
        (TIME, np.zeros((3, 2)), ("a", "a"), HandPathError, "'a' occurs twice"),
        (TIME, np.zeros((3, 1)), ("no good",), HandPathError, "'no good' is not a plain identifier"),
        (TIME, np.full((3, 1), np.nan), ("a",), HandPathError, r"q of sample 0 \(and of 2 further"),
        ([0, 2, 1], np.zeros((3, 1)), ("a",), HandPathError, "runs backwards at sample 2"),
    ],
)
def test_joint_motion_refused(time, q, names, error, words):
    with pytest.raises(error, match=words) as caught:
        JointMotion(time, q, names)
    assert isinstance(caught.value, ArmikError)
    assert isinstance(caught.value, ValueError)
