"""One row of a DH table: what it holds and what it refuses."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from armik_sym.arm.dh import DHConvention, DHLink, JointType
from armik_sym.errors import ArmikError, ArmModelError


def test_a_row_with_only_a_name_is_a_revolute_joint_about_z():
    link = DHLink("q1")
    assert (link.theta, link.d, link.a, link.alpha, link.sign) == (0, 0, 0, 0, 1)
    assert link.joint is JointType.REVOLUTE
    assert link.moves


@pytest.mark.parametrize(
    ("joint", "moves"), [(JointType.REVOLUTE, True), (JointType.PRISMATIC, True), (JointType.FIXED, False)]
)
def test_only_a_fixed_row_does_not_move(joint, moves):
    assert DHLink("q1", joint=joint).moves is moves


def test_length_names_list_what_d_and_a_refer_to():
    assert DHLink("q1", d=0.1, a=0.2).length_names == ()
    assert DHLink("q1", d="upper_arm", a=0.2).length_names == ("upper_arm",)
    assert DHLink("q1", d="upper_arm", a="offset").length_names == ("upper_arm", "offset")


@pytest.mark.parametrize("key", ["theta", "d", "a", "alpha"])
@pytest.mark.parametrize(
    "value", [math.nan, math.inf, -math.inf, 10**400, True, None, [1.0], 1j, np.bool_(1)]
)
def test_a_parameter_that_is_no_finite_number_is_refused(key, value):
    with pytest.raises(ArmModelError) as caught:
        DHLink("elbow", **{key: value})
    message = str(caught.value)
    assert "'elbow'" in message
    assert f"{key} is {value!r}" in message
    assert "finite number" in message


@pytest.mark.parametrize("key", ["theta", "alpha"])
def test_an_angle_cannot_be_a_segment_length(key):
    with pytest.raises(ArmModelError, match=f"'elbow': {key} is 'upper_arm'"):
        DHLink("elbow", **{key: "upper_arm"})


@pytest.mark.parametrize("value", [1, np.int64(1), np.float32(1.0), np.float64(1.0)])
def test_numpy_numbers_become_plain_floats(value):
    link = DHLink("elbow", theta=value, d=value, a=value, alpha=value, sign=value)
    assert [link.theta, link.d, link.a, link.alpha, link.sign] == [1, 1, 1, 1, 1]
    assert {type(x) for x in (link.theta, link.d, link.a, link.alpha)} == {float}
    assert type(link.sign) is int


@pytest.mark.parametrize("sign", [0, 2, -2, 0.5, math.nan, "1", None, True])
def test_a_sign_other_than_plus_or_minus_one_is_refused(sign):
    with pytest.raises(ArmModelError) as caught:
        DHLink("elbow", sign=sign)
    assert f"'elbow': sign is {sign!r}, expected 1 or -1" in str(caught.value)


@pytest.mark.parametrize("joint", ["revolute", None, DHConvention.STANDARD])
def test_a_joint_type_must_be_of_the_enum(joint):
    with pytest.raises(ArmModelError) as caught:
        DHLink("elbow", joint=joint)
    assert f"'elbow': joint is {joint!r}, expected a JointType" in str(caught.value)


def test_a_prismatic_joint_cannot_move_a_named_length():
    with pytest.raises(ArmModelError, match=r"'slide': a prismatic joint moves d.*'upper_arm'"):
        DHLink("slide", d="upper_arm", joint=JointType.PRISMATIC)
    assert DHLink("slide", a="upper_arm", joint=JointType.PRISMATIC).length_names == ("upper_arm",)


@pytest.mark.parametrize("name", ["elbow-flexion", "int", ""])
def test_a_joint_name_must_be_a_plain_identifier(name):
    with pytest.raises(ArmModelError, match=f"joint name '{name}'"):
        DHLink(name)


@pytest.mark.parametrize("key", ["d", "a"])
def test_a_segment_length_name_must_be_a_plain_identifier(key):
    with pytest.raises(ArmModelError, match="segment length name 'upper arm'"):
        DHLink("elbow", **{key: "upper arm"})


def test_errors_can_be_caught_as_value_errors_and_as_the_package_s_own():
    for kind in (ValueError, ArmikError):
        with pytest.raises(kind):
            DHLink("elbow", sign=3)


def test_a_row_cannot_be_changed():
    with pytest.raises(FrozenInstanceError):
        DHLink("elbow").theta = 1.0
