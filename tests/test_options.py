"""Options: refused where they make no sense, with the name, the value and what is valid."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles

from armik_sym.arm.rate_limit import rate_limit
from armik_sym.errors import LimitError, OptionError
from armik_sym.solution.tracked_orientation import tracked_orientation
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.options import TrajectoryOptions

ARM = ARMS["human"]
WEIGHTS = ("speed_weight", "acceleration_weight", "posture_weight", "clearance_weight", "prefer_weight")
POSITIVE = ("position_sigma", "rotation_sigma", "start_tolerance", "position_tolerance", "rotation_tolerance")
COUNTS = ("max_iterations", "n_best")


@pytest.mark.parametrize("name", WEIGHTS + POSITIVE)
@pytest.mark.parametrize("value", [-1, math.nan, math.inf, "1", True, [1.0], 1j])
def test_numbers_that_make_no_sense(name, value):
    with pytest.raises(OptionError, match=rf"{name} is .*expected a finite number") as caught:
        TrajectoryOptions(**{name: value})
    assert repr(value) in str(caught.value)


@pytest.mark.parametrize("name", POSITIVE)
def test_zero_is_refused_where_it_divides(name):
    with pytest.raises(OptionError, match=f"{name} is 0, expected a finite number > 0"):
        TrajectoryOptions(**{name: 0})


@pytest.mark.parametrize("name", WEIGHTS)
def test_zero_weights_are_fine(name):
    assert getattr(TrajectoryOptions(**{name: 0}), name) == 0


@pytest.mark.parametrize("kind", [np.float32, np.float64, np.int64, int])
def test_numpy_numbers_are_numbers(kind):
    for name in WEIGHTS + POSITIVE + COUNTS:
        assert getattr(TrajectoryOptions(**{name: kind(2)}), name) == 2


@pytest.mark.parametrize("name", COUNTS)
@pytest.mark.parametrize(
    "value", [2.5, 0.5, np.float64(1.25), 0, -3, math.nan, math.inf, "2", True, [1], None]
)
def test_counts_are_whole_and_at_least_one(name, value):
    with pytest.raises(OptionError, match=rf"{name} is .*, expected a whole number ≥ 1") as caught:
        TrajectoryOptions(**{name: value})
    assert repr(value) in str(caught.value)


@pytest.mark.parametrize("value", [2, 2.0, np.float32(2), np.int64(2)])
def test_counts_end_as_int(value):
    for name in COUNTS:
        assert type(getattr(TrajectoryOptions(**{name: value}), name)) is int


@pytest.mark.parametrize("name", ["certify", "ipopt_output"])
def test_yes_or_no_and_nothing_else(name):
    for value in (True, False, np.bool_(True)):
        TrajectoryOptions(**{name: value})
    for value in ("no", 1, None):
        with pytest.raises(OptionError, match=f"{name} is {value!r}, expected True or False"):
            TrajectoryOptions(**{name: value})


@pytest.mark.parametrize("value", ["Auto", "map", "", None, True, "full_space"])
def test_search_lists_the_valid_words(value):
    with pytest.raises(OptionError, match="valid are auto, swivel, full-space"):
        TrajectoryOptions(search=value)


@pytest.mark.parametrize("value", ["Exact", "", None, True])
def test_tracking_lists_the_valid_words(value):
    with pytest.raises(OptionError, match="valid are exact, soft"):
        TrajectoryOptions(tracking=value)


def test_orientation_follows_the_path_unless_said():
    turned = path_of(ARM, smooth_angles(ARM, 3, 0))
    straight = path_of(ARM, smooth_angles(ARM, 3, 0), turned=False)
    assert tracked_orientation(None, turned) is Orientation.FULL
    assert tracked_orientation(None, straight) is Orientation.NONE
    for mode in Orientation:
        assert tracked_orientation(mode.value, turned) is mode
    assert tracked_orientation("none", straight) is Orientation.NONE
    for word in ("full", "pointing"):
        with pytest.raises(OptionError, match=rf"{word}.*no rotations.*orientation=\"none\""):
            tracked_orientation(word, straight)
    with pytest.raises(OptionError, match=r"'both': valid are full, pointing, none"):
        tracked_orientation("both", turned)


def test_tolerances_follow_the_tracking_unless_given():
    exact, soft = TrajectoryOptions(), TrajectoryOptions(tracking="soft")
    assert exact.position_tolerance_or_default < 1e-8 < 1e-3 < soft.position_tolerance_or_default
    assert exact.rotation_tolerance_or_default < 1e-8 < 1e-2 < soft.rotation_tolerance_or_default
    given_ones = TrajectoryOptions(tracking="soft", position_tolerance=0.5, rotation_tolerance=0.25)
    assert given_ones.position_tolerance_or_default == 0.5
    assert given_ones.rotation_tolerance_or_default == 0.25


@given(value=st.floats(1e-6, 1e6))
def test_one_limit_counts_for_every_joint(value):
    assert np.array_equal(rate_limit("max_speed", value, ARM), np.full(7, value))


def test_limits_per_joint_and_none():
    limits = [1, 2, 3, 4, 5, 6, np.inf]
    assert np.array_equal(rate_limit("max_speed", limits, ARM), limits)
    assert np.array_equal(rate_limit("max_speed", None, ARM), np.full(7, np.inf))


@pytest.mark.parametrize("value", [0, -1.0, math.nan, [1, 1, 1, 0, 1, 1, 1]])
def test_limits_that_leave_no_motion_name_the_joint(value):
    joint = "shoulder_flexion" if np.ndim(value) == 0 else "elbow_flexion"
    with pytest.raises(LimitError, match=f"max_acceleration of joint '{joint}' is .*give a positive number"):
        rate_limit("max_acceleration", value, ARM)


@pytest.mark.parametrize("value", [[1.0] * 6, [[1.0] * 7], []])
def test_wrong_number_of_limits(value):
    with pytest.raises(LimitError, match=r"max_speed has shape .*expected one number or 7, one per joint"):
        rate_limit("max_speed", value, ARM)


@pytest.mark.parametrize("value", ["fast", [1.0, "x"], {}, [[1.0], [1.0, 2.0]]])
def test_limits_that_are_no_numbers(value):
    with pytest.raises(LimitError, match=r"max_speed is .*expected one number or 7"):
        rate_limit("max_speed", value, ARM)


@pytest.mark.parametrize("value", [0, 0.1, 1, np.float32(0.2), [0.1] * 7, (0, 0.2), np.array([0.1, 0.0])])
def test_clearances_that_make_sense(value):
    assert TrajectoryOptions(clearance=value).clearance is value


@pytest.mark.parametrize("value", ["10", None, True, [], [[0.1]], [0.1, "x"], [[1.0], [1.0, 2.0]], 1j, {}])
def test_clearances_that_are_no_numbers(value):
    with pytest.raises(
        OptionError, match=r"clearance is .*expected one number ≥ 0 in \[rad\], or one per joint"
    ):
        TrajectoryOptions(clearance=value)


@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf, [0.1, -0.1], [0.1, math.nan]])
def test_clearances_that_make_no_sense_name_the_joint(value):
    where = "joint 2: " if np.ndim(value) else ""
    with pytest.raises(OptionError, match=rf"clearance: {where}(-0\.1|nan|inf) makes no sense, expected one"):
        TrajectoryOptions(clearance=value)


@pytest.mark.parametrize(
    "value", ["elbow_low", "elbow_high", "elbow_out", "elbow_in", None, [0, 0, 1], (1.0, 2.0)]
)
def test_preferences_that_make_sense(value):
    assert TrajectoryOptions(prefer=value).prefer is value


@pytest.mark.parametrize(
    "value", ["low", "", 3, True, [True] * 3, [], [[0, 0, 1]], ["x"], [[1], [1, 2]], {}, 1j]
)
def test_preferences_that_make_no_sense_list_what_does(value):
    with pytest.raises(
        OptionError, match=r"prefer is .*: valid are elbow_low, .*, a posture \(dof,\) in \[rad\]"
    ):
        TrajectoryOptions(prefer=value)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_preferences_are_finite(value):
    with pytest.raises(OptionError, match=rf"prefer: number 2 is {value}, expected finite"):
        TrajectoryOptions(prefer=[0.0, value, 1.0])
