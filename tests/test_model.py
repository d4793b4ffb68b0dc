"""The arm: parts that fit together, and copies with another range of motion or other lengths."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm import catalog
from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHLink, JointType
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.errors import ArmModelError, UnitError, UnknownNameError

CHAIN = DHChain((DHLink("shoulder", d="upper_arm"), DHLink("elbow", a="forearm")))
ROM = RangeOfMotion([-1.0, 0.0], [1.0, 2.0])
LENGTHS = {"forearm": 0.25, "upper_arm": 0.3}


def arm(**changes):
    return Arm(**{"name": "test_arm", "chain": CHAIN, "rom": ROM, "lengths": LENGTHS, **changes})


def test_the_arm_knows_its_joints_and_lengths_in_the_order_of_the_chain():
    a = arm()
    assert a.dof == 2
    assert a.joint_names == ("shoulder", "elbow")
    assert [a.joint_index(name) for name in a.joint_names] == [0, 1]
    assert list(a.lengths) == ["upper_arm", "forearm"]
    np.testing.assert_array_equal(a.length_values, [0.3, 0.25])


def test_an_unknown_joint_is_answered_with_those_that_exist():
    with pytest.raises(UnknownNameError, match="joint of arm 'test_arm' 'wrist': valid are elbow, shoulder"):
        arm().joint_index("wrist")


def test_with_rom_changes_the_limits_and_nothing_else():
    a = arm()
    narrow = a.with_rom([-0.5, 0.5], [0.5, 1.0])
    np.testing.assert_array_equal(narrow.rom.lower, [-0.5, 0.5])
    np.testing.assert_array_equal(narrow.rom.upper, [0.5, 1.0])
    np.testing.assert_array_equal(a.rom.upper, [1.0, 2.0])
    assert narrow.chain is a.chain
    assert narrow.lengths == a.lengths


def test_with_lengths_changes_those_named_and_keeps_the_others():
    a = arm()
    longer = a.with_lengths(forearm=0.4)
    assert dict(longer.lengths) == {"upper_arm": 0.3, "forearm": 0.4}
    assert dict(a.lengths) == LENGTHS
    assert longer.chain is a.chain
    assert longer.rom is a.rom


@pytest.mark.parametrize(
    ("lower", "upper", "message"),
    [
        ([0.0], [1.0], "2 joints but the range of motion 1"),
        ([0.0, 0.0], [1.0], "2 lower limits but 1 upper"),
        ([0.0, 1.5], [1.0, 1.0], "joint 2 has lower limit 1.5 above upper limit 1 rad"),
        ([0.0, math.nan], [1.0, 1.0], "lower limit of joint 2 is nan"),
    ],
)
def test_limits_that_do_not_fit_are_refused(lower, upper, message):
    with pytest.raises(ArmModelError, match=message):
        arm().with_rom(lower, upper)


def test_an_unknown_length_is_answered_with_those_that_exist():
    with pytest.raises(
        UnknownNameError, match="length of arm 'test_arm' 'hand': valid are forearm, upper_arm"
    ):
        arm().with_lengths(hand=0.19)


def test_a_missing_length_is_named():
    with pytest.raises(ArmModelError, match="'test_arm': segment length 'forearm' is missing"):
        arm(lengths={"upper_arm": 0.3})


@pytest.mark.parametrize("value", [-0.001, 5.001, math.nan, math.inf, -math.inf])
def test_an_impossible_length_is_refused_with_value_and_what_is_allowed(value):
    with pytest.raises(ArmModelError) as caught:
        arm().with_lengths(forearm=value)
    assert f"'test_arm': segment length 'forearm' is {value:g}, expected 0 to 5 m" in str(caught.value)


@pytest.mark.parametrize(
    ("value", "hint"), [(286.9, True), (300, True), (0.3, None), (-1, False), (math.inf, False)]
)
def test_millimetres_get_a_hint_and_nothing_else_does(value, hint):
    if hint is None:
        assert arm().with_lengths(forearm=value).lengths["forearm"] == value
        return
    with pytest.raises(ArmModelError) as caught:
        arm().with_lengths(forearm=value)
    assert (f"; {value / 1000:g} m if this is in millimetres" in str(caught.value)) is hint
    assert ("millimetres" in str(caught.value)) is hint


@pytest.mark.parametrize("value", [True, "0.3", [0.3], 1j])
def test_a_length_that_is_no_number_is_refused(value):
    with pytest.raises(ArmModelError) as caught:
        arm().with_lengths(forearm=value)
    assert f"segment length 'forearm' is {value!r}, expected a number of metres" in str(caught.value)


@pytest.mark.parametrize("value", [0, 5, np.float32(0.5), np.int64(1)])
def test_lengths_from_0_to_5_metres_become_plain_floats(value):
    length = arm().with_lengths(forearm=value).lengths["forearm"]
    assert type(length) is float
    assert length == value


def test_lengths_cannot_be_changed_in_place():
    given_lengths = dict(LENGTHS)
    a = arm(lengths=given_lengths)
    given_lengths["forearm"] = 9.0
    assert a.lengths["forearm"] == 0.25
    with pytest.raises(TypeError):
        a.lengths["forearm"] = 0.1


@pytest.mark.parametrize("axis", [[1, 1, 0], [0, 0, 0], [1, 0], [math.nan, 0, 1], "x", [[1], [0, 0]], None])
def test_the_pointing_axis_must_be_a_unit_vector(axis):
    with pytest.raises(ArmModelError, match=r"'test_arm': pointing_axis is .*expected a unit vector \(3,\)"):
        arm(pointing_axis=axis)
    for key in ("up", "outward"):
        if axis is None:
            assert getattr(arm(**{key: axis}), key) is None
            continue
        with pytest.raises(ArmModelError, match=rf"'test_arm': {key} is .*expected a unit vector \(3,\)"):
            arm(**{key: axis})


def test_the_pointing_axis_is_a_read_only_copy():
    axis = np.array([0.0, 1.0, 0.0])
    a = arm(pointing_axis=axis)
    axis[0] = 5.0
    np.testing.assert_array_equal(a.pointing_axis, [0, 1, 0])
    with pytest.raises(ValueError, match="read-only"):
        a.pointing_axis[0] = 1.0


@pytest.mark.parametrize("name", ["left arm", "", "int", "5", None])
def test_the_name_must_be_a_plain_identifier(name):
    with pytest.raises(ArmModelError, match=f"arm name {name!r} is not a plain identifier"):
        arm(name=name)


@pytest.mark.parametrize("name", catalog.names())
def test_the_hand_never_leaves_the_reach(name):
    a = catalog.by_name(name)
    q = np.random.default_rng(5).uniform(a.rom.lower, a.rom.upper, (2000, a.dof))
    distance = np.linalg.norm(hand_pose(a.chain, q, a.lengths)[0], axis=1)
    assert distance.max() <= a.reach + 1e-12
    assert a.reach <= 0.143 + sum(a.lengths.values()) + 1e-12


@given(st.floats(0.1, 0.5), st.floats(-2, 0), st.floats(0, 2))
def test_a_sliding_joint_counts_its_farther_limit_into_the_reach(length, lower, upper):
    rows = (DHLink("shoulder", a="upper_arm"), DHLink("slide", d=-0.2, joint=JointType.PRISMATIC))
    a = Arm("slider", DHChain(rows), RangeOfMotion([-9, lower], [9, upper]), {"upper_arm": length})
    assert a.reach == pytest.approx(length + 0.2 + max(-lower, upper))


def test_base_and_tool_shifts_count_into_the_reach():
    shift = np.eye(4)
    shift[:3, 3] = [3.0, 0.0, 4.0]
    assert arm(chain=DHChain(CHAIN.links, base=shift)).reach == pytest.approx(0.55 + 5)
    assert arm(chain=DHChain(CHAIN.links, base=shift, tool=shift)).reach == pytest.approx(0.55 + 10)


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, lambda a: pickle.loads(pickle.dumps(a))])  # noqa: S301
def test_an_arm_can_be_copied_and_sent_to_another_process(duplicate):
    original = catalog.human().with_lengths(hand=0.2)
    twin = duplicate(original)
    assert twin.name == original.name
    assert twin.description == original.description
    assert twin.lengths == original.lengths
    assert twin.chain.links == original.chain.links
    np.testing.assert_array_equal(twin.chain.base, original.chain.base)
    np.testing.assert_array_equal(twin.rom.lower, original.rom.lower)
    np.testing.assert_array_equal(twin.rom.upper, original.rom.upper)
    for key in ("pointing_axis", "up", "outward"):
        np.testing.assert_array_equal(getattr(twin, key), getattr(original, key))


def test_limits_in_degrees_are_recognised_and_refused() -> None:
    arm = catalog.ehmcs()
    with pytest.raises(UnitError, match=r"shoulder_abduction.*degrees.*from_degrees"):
        arm.with_rom(np.rad2deg(arm.rom.lower), np.rad2deg(arm.rom.upper))
