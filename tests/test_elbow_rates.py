"""Rate limits that the elbow alone shows to be impossible."""

from __future__ import annotations

import numpy as np
import pytest
from random_trajectories import trajectories

import armik_sym as ak
from armik_sym.errors import LimitError
from armik_sym.solution.motion_rates import joint_acceleration, joint_speed
from armik_sym.trajectory.elbow_rates import check_elbow_rates

FAMILIES = ["ordinary", "near_straight_arm", "through_straight_arm", "tight_limits"]


def rates(each) -> tuple[np.ndarray, np.ndarray]:
    """Largest speed and acceleration of every joint in the motion that made the path."""
    speed, acceleration = joint_speed(each.path.time, each.q), joint_acceleration(each.path.time, each.q)
    return np.abs(speed).max(axis=0), np.abs(acceleration).max(axis=0)


@pytest.mark.parametrize("family", FAMILIES)
def test_limits_that_a_motion_keeps_are_never_refused(family):
    for each in trajectories([family], 8):
        intervals = ak.swivel_map(each.arm, each.path).intervals
        speed, acceleration = rates(each)
        check_elbow_rates(each.arm, each.path, intervals, speed * (1 + 1e-6), acceleration * (1 + 1e-6))


@pytest.mark.parametrize("name", ["max_speed", "max_acceleration"])
def test_an_elbow_with_one_side_is_refused_just_below_what_it_needs(name):
    arm, path = ak.catalog.ehmcs(), ak.load_task("playing_ball").path
    needed = getattr(ak.solve(arm, path), name)[3]
    ak.solve(arm, path, **{name: 1.5 * needed})
    with pytest.raises(LimitError) as caught:
        ak.solve(arm, path, **{name: 0.999 * needed})
    text = str(caught.value)
    assert "elbow_flexion" in text
    assert name in text
    assert "after sample" in text
    assert "whatever the other joints do" in text


def test_the_side_that_moves_less_counts():
    """Bending on to the same side of a straight arm takes more acceleration than passing through it."""
    told_apart = 0
    for each in trajectories(["through_straight_arm"], 12):
        map_ = ak.swivel_map(each.arm, each.path)
        one_side = np.abs(joint_acceleration(each.path.time, map_.intervals.curves[0].elbow[:, None])).max()
        needed = rates(each)[1][3]
        if one_side > 2 * needed:
            told_apart += 1
            limits = np.full(7, np.inf), np.full(7, (1 + 1e-6) * needed)
            check_elbow_rates(each.arm, each.path, map_.intervals, *limits)
    assert told_apart >= 3
