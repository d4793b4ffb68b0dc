"""Tasks that contradict themselves are refused with joint, sample, value and limit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS, custom
from smooth_motions import path_of, smooth_angles

from armik_sym.arm import DHConvention
from armik_sym.arm.start_posture import check_start
from armik_sym.errors import LimitError, OptionError, ShapeError
from armik_sym.motion.hand_path import HandPath
from armik_sym.solution.motion_rates import joint_acceleration, joint_speed
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.input_checks import (
    check_enough_joints,
    check_hand_speed,
    raise_too_fast,
)

ARM = ARMS["ehmcs"]


def test_a_start_inside_passes_the_limits_themselves_included():
    assert check_start(ARM, None) is None
    for start in (ARM.rom.middle, ARM.rom.lower, ARM.rom.upper, ARM.rom.middle.tolist()):
        assert np.array_equal(check_start(ARM, start), start)


@pytest.mark.parametrize(
    "start", [np.zeros(6), np.zeros((1, 7)), 0.0, [], "up", [[0.0], [0.0, 1.0]], [None] * 7]
)
def test_a_start_of_wrong_shape_or_kind(start):
    if isinstance(start, list) and start == [None] * 7:
        with pytest.raises(LimitError, match="nan"):
            check_start(ARM, start)
        return
    with pytest.raises(ShapeError, match=r"start .*expected .*7.*one angle per joint in \[rad\]"):
        check_start(ARM, start)


def test_a_start_outside_names_joint_and_limits_in_degrees():
    start = ARM.rom.middle.copy()
    start[3] = np.deg2rad(-5)
    with pytest.raises(LimitError, match=r"elbow_flexion is -0\.0872665 rad \(-5°\).*\(0° to 145°\)$"):
        check_start(ARM, start)
    start[3] = 90
    with pytest.raises(LimitError, match=r"elbow_flexion is 90 rad.*angles are in radians"):
        check_start(ARM, start)
    start[3] = np.nextafter(ARM.rom.upper[3], 4)
    with pytest.raises(LimitError, match="elbow_flexion"):
        check_start(ARM, start)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_start_that_is_not_finite(bad):
    start = ARM.rom.middle.copy()
    start[1] = bad
    with pytest.raises(LimitError, match=r"shoulder_flexion is -?(nan|inf)"):
        check_start(ARM, start)


@given(seed=st.integers(0, 10**6), name=st.sampled_from(sorted(ARMS)))
def test_no_motion_within_the_limits_is_called_too_fast(seed, name):
    arm = ARMS[name]
    q = smooth_angles(arm, 12, seed)
    path = path_of(arm, q)
    check_hand_speed(arm, path, np.abs(joint_speed(path.time, q)).max(axis=0) + 1e-9)


def test_a_hand_that_jumps_is_named_by_its_samples():
    path = HandPath([0.0, 0.1, 0.2, 0.3], [[0, 0, 0.5], [0, 0, 0.5], [0, 0.2, 0.5], [0, 0.21, 0.5]])
    with pytest.raises(LimitError, match=r"between samples 1 and 2 the hand moves at 2 m/s") as caught:
        check_hand_speed(ARM, path, np.full(7, 0.2))
    assert f"cannot exceed {7 * 0.2 * ARM.reach:.4g} m/s" in str(caught.value)
    check_hand_speed(ARM, path, np.full(7, np.inf))


def test_sliding_joints_count_with_their_own_speed():
    arm = custom(DHConvention.STANDARD)
    speed = np.array([0.5, 1e-12, 1e-12, 0.5, 1e-12])
    near, far = ([[0.2, 0.2, 0.2], [0.2 + step, 0.2, 0.2]] for step in (0.99, 1.01))
    check_hand_speed(arm, HandPath([0.0, 1.0], near), speed)
    with pytest.raises(LimitError, match="cannot exceed 1 m/s"):
        check_hand_speed(arm, HandPath([0.0, 1.0], far), speed)


@pytest.mark.parametrize("what", ["max_speed", "max_acceleration"])
def test_too_fast_names_the_joint_and_sample_that_exceed_most(what):
    q = smooth_angles(ARM, 12, 1)
    path = path_of(ARM, q)
    rates = np.abs((joint_speed if what == "max_speed" else joint_acceleration)(path.time, q))
    limits = {"max_speed": np.full(7, np.inf), "max_acceleration": np.full(7, np.inf)}
    limits[what] = 0.5 * rates.max(axis=0)
    limits[what][5] /= 2
    k = int(np.argmax(rates[:, 5]))
    with pytest.raises(LimitError) as caught:
        raise_too_fast(ARM, path, q, **limits)
    text = str(caught.value)
    assert f"no motion within {what} was found" in text
    assert f"wrist_extension at {np.rad2deg(rates[k, 5]):.4g}°/s" in text
    assert f"after sample {k} (allowed {np.rad2deg(limits[what][5]):.4g}°/s" in text
    assert f"Raise {what}, slow the path down" in text


@pytest.mark.parametrize("orientation", Orientation)
def test_enough_joints(orientation):
    check_enough_joints(ARM, orientation)


def test_too_few_joints_say_what_would_fit():
    with pytest.raises(
        OptionError, match=r"'full' asks 6 equations .*5 joints: use orientation='pointing' or 'none', or"
    ):
        check_enough_joints(ARMS["ehmcs_5dof"], Orientation.FULL)
    with pytest.raises(OptionError, match=r"4 joints: use orientation='none', or tracking=\"soft\""):
        check_enough_joints(ARMS["ehmcs_4dof"], Orientation.POINTING)
    from sample_arms import BARE

    with pytest.raises(OptionError, match=r"'none' asks 3 equations .*2 joints: use tracking=\"soft\""):
        check_enough_joints(BARE, Orientation.NONE)
