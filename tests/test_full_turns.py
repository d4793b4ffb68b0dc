"""Cutting intervals where a joint of one full turn passes its limits: no jumps left, nothing lost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spherical_arms import ARMS, poses

from armik_sym.arm import Arm
from armik_sym.swivel.closed_form import position_curve
from armik_sym.swivel.full_turns import split_at_full_turns
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals, intervals_of_curves
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import recognise

TURN = 2 * np.pi
DENSE = 301


def turning(joints: dict[int, float], name: str = "ehmcs") -> Arm:
    """An arm with joints that turn once around, each from the given angle; the others have room."""
    lower, upper = np.full(7, -2.8), np.full(7, 2.8)
    for joint, start in joints.items():
        lower[joint], upper[joint] = start, start + TURN
    return ARMS[name].with_rom(lower, upper)


def both(arm: Arm, n: int, seed: int, backend: str = "auto") -> tuple[FeasibleIntervals, FeasibleIntervals]:
    q = arm.rom.random_postures(np.random.default_rng(seed), n)
    whole = feasible_intervals(recognise(arm), *poses(arm, q), backend=backend)
    return whole, split_at_full_turns(whole, backend)


def scanned(intervals: FeasibleIntervals) -> np.ndarray:
    """Postures along every interval, shape (k, DENSE, dof)."""
    share = np.linspace(0, 1, DENSE)
    psi = intervals.start[:, None] + share * (intervals.end - intervals.start)[:, None]
    row = np.repeat(np.arange(len(intervals.start)), DENSE)
    q = postures_at(intervals.curves, intervals.sample[row], intervals.branch[row], psi.ravel()).q
    return q.reshape(len(intervals.start), DENSE, -1)


def jumps(intervals: FeasibleIntervals) -> int:
    """Steps of about a whole turn."""
    return int((np.abs(np.diff(scanned(intervals), axis=1)) > 1.6 * np.pi).sum())


def same_angles(whole: FeasibleIntervals, parts: FeasibleIntervals, cuts: int) -> None:
    """The parts of every sample and branch lie in its intervals and cover all but 2e-9 per cut."""
    for sample in range(len(whole.empty)):
        for branch in range(len(whole.branches)):
            old, new = whole.of(sample, branch), parts.of(sample, branch)
            assert np.all(new[:, 1] > new[:, 0])
            length = np.ptp(old, axis=1).sum()
            assert length - 2.1e-9 * cuts <= np.ptp(new, axis=1).sum() <= length
            for start, end in new:
                turned = old + TURN * np.rint((0.5 * (start + end) - old.mean(axis=1)) / TURN)[:, None]
                full = np.ptp(old, axis=1) >= TURN - 1e-12
                assert np.any(full | ((turned[:, 0] <= start) & (end <= turned[:, 1])))
            mine = (parts.sample == sample) & (parts.branch == branch)
            assert np.all(np.diff(parts.start[mine]) > 0)
    assert np.all(np.diff(8 * parts.sample + parts.branch) >= 0)


@pytest.mark.parametrize("backend", ["auto", "vm"])
@pytest.mark.parametrize(
    "joints", [{0: -np.pi}, {1: -1.0}, {2: 0.3}, {4: -2.0}, {6: -np.pi}, {0: -np.pi, 2: 0.0, 4: 1.0, 6: 2.0}]
)
def test_no_joint_jumps_and_nothing_is_lost(joints, backend):
    whole, parts = both(turning(joints), 25, 1, backend)
    assert jumps(whole) > 0
    assert len(parts.start) > len(whole.start)
    assert jumps(parts) == 0
    same_angles(whole, parts, 8)
    assert np.array_equal(parts.empty, whole.empty)


@pytest.mark.parametrize("name", ["ehmcs", "human", "alfaiz"])
def test_arms_of_the_papers(name):
    whole, parts = both(ARMS[name], 40, 2)
    assert jumps(parts) == 0
    same_angles(whole, parts, 8)


def test_whole_circles_where_every_joint_turns():
    arm = turning(dict.fromkeys((0, 1, 2, 4, 5, 6), -np.pi))
    whole, parts = both(arm, 60, 3)
    circles = np.ptp(np.column_stack([whole.start, whole.end]), axis=1) >= TURN - 1e-12
    assert circles.all()
    number = np.zeros((60, 8), dtype=int)
    np.add.at(number, (parts.sample, parts.branch), 1)
    reached = ~whole.empty
    assert {2, 4, 6} <= set(number[reached].tolist())
    assert jumps(parts) == 0
    same_angles(whole, parts, 12)


@pytest.mark.parametrize("joint", [0, 2])
def test_one_joint_on_whole_circles_is_cut_once_or_twice_or_not_at_all(joint):
    """Turning all around with ψ it is at its limit once; swinging it passes it twice or never."""
    lower, upper = np.full(7, -7.0), np.full(7, 7.0)
    lower[joint], upper[joint] = -1.0, -1.0 + TURN
    whole, parts = both(ARMS["ehmcs"].with_rom(lower, upper), 150, 4)
    number = np.zeros((150, 8), dtype=int)
    np.add.at(number, (parts.sample, parts.branch), 1)
    length = np.zeros((150, 8))
    np.add.at(length, (parts.sample, parts.branch), parts.end - parts.start)
    uncut = length >= TURN - 1e-12
    reached = ~whole.empty
    assert np.all(number[reached & ~uncut] <= 2)
    assert (reached & uncut).any()
    assert (number[reached & ~uncut] == 1).any()  # one cut: one part, nearly the whole circle
    assert (number[reached & ~uncut] == 2).any()  # two cuts: two parts
    q = scanned(parts)
    assert np.abs(np.diff(q[:, :, joint], axis=1)).max() < 1.6 * np.pi


def test_limits_of_all_joints_hold_on_the_parts():
    arm = ARMS["alfaiz"]
    _, parts = both(arm, 60, 5)
    q = scanned(parts)
    assert arm.rom.margin(q.reshape(-1, 7)).min() >= -1e-9


@pytest.mark.parametrize("joints", [{0: -np.pi}, {1: -2.0}, {2: 0.5}])
def test_paths_of_positions(joints):
    arm = turning(joints)
    q = arm.rom.random_postures(np.random.default_rng(6), 40)
    position = poses(arm, q)[0]
    spherical = recognise(arm)
    one, other = (position_curve(spherical, position, q[:, 4:], side) for side in (1, -1))
    whole = intervals_of_curves((one, other))
    parts = split_at_full_turns(whole)
    assert len(whole.branches) == 4
    assert jumps(whole) > 0
    assert jumps(parts) == 0
    same_angles(whole, parts, 4)


def test_ranges_of_less_or_more_than_a_turn_are_left_alone():
    for most in (3.0, 3.3):
        arm = ARMS["ehmcs"].with_rom(np.full(7, -most), np.full(7, most))
        whole, parts = both(arm, 20, 7)
        assert parts is whole


def test_nothing_to_cut():
    arm = turning({0: -np.pi})
    far = feasible_intervals(recognise(arm), np.full((3, 3), 5.0), np.tile(np.eye(3), (3, 1, 1)))
    assert not len(far.sample)
    assert split_at_full_turns(far) is far


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    start=st.floats(-TURN, 0),
    joint=st.sampled_from([0, 1, 2, 4, 5, 6]),
    exponent=st.floats(-7, 0),
    name=st.sampled_from(["ehmcs", "human", "odd_standard"]),
)
def test_beside_poles_too(seed, start, joint, exponent, name):
    arm = turning({joint: start}, name)
    spherical = recognise(arm)
    q = arm.rom.random_postures(np.random.default_rng(seed), 3)
    for middle, triple in ((1, spherical.shoulder), (5, spherical.wrist)):
        q[:, middle] = -triple.offset + 10.0**exponent
    whole = feasible_intervals(spherical, *poses(arm, q))
    parts = split_at_full_turns(whole)
    same_angles(whole, parts, 4)
    q = scanned(parts)
    limited = arm.rom.width <= TURN + 1e-9
    assert arm.rom.margin(q.reshape(-1, 7))[:, limited].min() >= -1e-6
    # Beside a pole a joint turns by half a turn from one point of the scan to the next, never by a whole.
    assert np.abs(np.diff(q[:, :, joint], axis=1)).max(initial=0) < 1.6 * np.pi
