"""Which samples are out of reach: exactly those, and by how much."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_arms import ARMS, postures
from smooth_motions import path_of, smooth_path

from armik_sym.compiled.kinematics import compile
from armik_sym.errors import OptionError, UnreachablePathError
from armik_sym.motion.hand_path import HandPath
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.damped_least_squares import PoseSolver
from armik_sym.trajectory.pose_error import SampleError
from armik_sym.trajectory.reachability import find_unreachable, nearest_posture, raise_unreachable

ARM = ARMS["ehmcs"]
SHOULDER = np.array([0.0, 0.0, 0.143])
LONGEST = ARM.lengths["upper_arm"] + ARM.lengths["forearm"]
# Forward, up and to the side: directions in which the arm can be stretched inside its range of motion.
DIRECTION = np.array([0.0, 0.6, 0.8])


def out(distance):
    distance = np.atleast_1d(distance)
    return HandPath(np.arange(len(distance)), SHOULDER + (LONGEST + distance)[:, None] * DIRECTION)


def solver_for(path, orientation=Orientation.NONE):
    return PoseSolver(compile(ARM), SampleError(ARM, path, orientation))


@settings(max_examples=10)
@given(distances=st.lists(st.sampled_from([-0.2, -0.05, -0.01, 0.005, 0.1, 0.3]), min_size=2, max_size=5))
def test_exactly_the_samples_beyond_the_stretched_arm(distances):
    path = out(np.array(distances))
    found = find_unreachable(solver_for(path), ARM, len(path), ARM.rom.middle, seed=0)
    expected = [k for k, d in enumerate(distances) if d > 0]
    assert found.samples.tolist() == expected
    assert found.q.shape == (len(expected), ARM.dof)
    left = np.linalg.norm(compile(ARM).position(found.q) - path.position[found.samples], axis=-1)
    np.testing.assert_allclose(left, [distances[k] for k in expected], atol=1e-3)


def test_many_samples_out_of_reach_are_all_named():
    distances = np.concatenate([np.full(5, -0.1), np.linspace(0.01, 0.2, 45)])
    path = out(distances)
    found = find_unreachable(solver_for(path), ARM, len(path), ARM.rom.middle, seed=0)
    assert found.samples.tolist() == list(range(5, 50))
    with pytest.raises(UnreachablePathError, match=r"45 of 50 samples.* and 37 more") as caught:
        raise_unreachable(ARM, path, Orientation.NONE, found)
    np.testing.assert_allclose(caught.value.shortfall, distances[5:], atol=1e-3)
    assert np.array_equal(caught.value.turn, np.zeros(45))
    assert str(caught.value).count(" mm") == 8
    assert "°" not in str(caught.value)


@pytest.mark.parametrize("orientation", Orientation)
def test_nothing_is_out_of_reach_on_a_path_the_arm_made(orientation):
    path, _ = smooth_path(ARM, 8, seed=1)
    found = find_unreachable(solver_for(path, orientation), ARM, len(path), ARM.rom.lower, seed=0)
    assert found.samples.size == 0
    assert found.q.shape == (0, ARM.dof)


def test_the_nearest_posture_is_the_best_of_all_starts():
    path = out([0.1, 0.1])
    solver = solver_for(path)
    starts = list(postures(ARM, 5, 3))
    alone = [solver.reach(0, start, iterations=100).error for start in starts]
    assert nearest_posture(solver, 0, starts).error == min(alone)
    with pytest.raises(OptionError, match="at least one start"):
        nearest_posture(solver, 0, [])


def test_turn_is_told_in_degrees():
    q = postures(ARM, 2, 1)
    path = path_of(ARM, q[::-1])
    found = find_unreachable(solver_for(path, Orientation.FULL), ARM, 2, q[0], seed=0)
    lost = type(found)(np.array([0, 1]), q)
    with pytest.raises(UnreachablePathError, match=r"sample 0 by .* mm and .*°, 1 by") as caught:
        raise_unreachable(ARM, path, Orientation.FULL, lost)
    assert np.all(caught.value.turn > 0)
    assert f"reach {ARM.reach:.3g} m" in str(caught.value)
