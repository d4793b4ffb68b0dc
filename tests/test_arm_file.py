"""Arm files: the catalogue as files, and every mistake answered with place, value and what is allowed."""

from __future__ import annotations

import copy
import datetime
import math
import re
from pathlib import Path

import numpy as np
import pytest

from armik_sym.arm import Arm, catalog, load_arm
from armik_sym.arm.arm_file import arm_from_table
from armik_sym.arm.dh import DHConvention, JointType
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.arm.toml_reader import load_toml
from armik_sym.errors import ArmFileError, ArmikError, UnitError

ARMS = Path(__file__).resolve().parents[1] / "data" / "arms"

SMALL = """\
name = "small"
convention = "modified"
angle_unit = "deg"
length_unit = "cm"
description = "for the tests"
pointing_axis = [0, 0, 1]
up = [0, 1, 0]
outward = [0, 0, -1]
base = [[1, 0, 0, 10], [0, 0, -1, 20], [0, 1, 0, 30], [0, 0, 0, 1]]
tool = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]]

[lengths]
upper_arm = 30

[[joint]]
name = "shoulder"
theta = 90
alpha = -45
d = 7
a = "upper_arm"
sign = -1
range = [-60, 120]

[[joint]]
name = "slide"
type = "prismatic"
d = 2
range = [-1, 4]

[[joint]]
name = "spacer"
type = "fixed"
a = 3
"""


def write(tmp_path, text):
    file = tmp_path / "arm.toml"
    file.write_text(text, encoding="utf-8")
    return file


def edited(old, new):
    assert SMALL.count(old) == 1, old
    return SMALL.replace(old, new)


@pytest.mark.parametrize("name", catalog.names())
def test_the_arm_files_are_the_arms_of_the_catalogue(name):
    built, loaded = catalog.by_name(name), load_arm(ARMS / f"{name}.toml")
    assert loaded.name == built.name
    assert loaded.description == built.description
    assert loaded.joint_names == built.joint_names
    assert loaded.chain.length_names == built.chain.length_names
    assert loaded.chain.convention is built.chain.convention
    assert dict(loaded.lengths) == pytest.approx(dict(built.lengths), abs=1e-15)
    for key in ("pointing_axis", "up", "outward"):
        np.testing.assert_array_equal(getattr(loaded, key), getattr(built, key))
    np.testing.assert_allclose(loaded.rom.lower, built.rom.lower, rtol=0, atol=1e-15)
    np.testing.assert_allclose(loaded.rom.upper, built.rom.upper, rtol=0, atol=1e-15)
    q = np.random.default_rng(9).uniform(-np.pi, np.pi, (1000, built.dof))
    for lengths in (built.lengths, dict.fromkeys(built.lengths, 0.4)):
        for ours, theirs in zip(
            hand_pose(loaded.chain, q, lengths), hand_pose(built.chain, q, lengths), strict=True
        ):
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12)


def test_every_arm_file_of_the_repository_is_one_of_the_catalogue():
    assert tuple(sorted(file.stem for file in ARMS.glob("*.toml"))) == catalog.names()


def test_everything_in_a_file_arrives_in_si_units(tmp_path):
    arm = load_arm(write(tmp_path, SMALL))
    assert (arm.name, arm.description, arm.joint_names) == ("small", "for the tests", ("shoulder", "slide"))
    assert arm.chain.convention is DHConvention.MODIFIED
    assert arm.lengths["upper_arm"] == pytest.approx(0.30)
    shoulder, slide, spacer = arm.chain.links
    assert (shoulder.theta, shoulder.alpha) == pytest.approx((math.pi / 2, -math.pi / 4))
    assert (shoulder.d, shoulder.a, shoulder.sign) == (pytest.approx(0.07), "upper_arm", -1)
    assert (slide.joint, slide.d) == (JointType.PRISMATIC, pytest.approx(0.02))
    assert (spacer.joint, spacer.a) == (JointType.FIXED, pytest.approx(0.03))
    np.testing.assert_allclose(arm.rom.lower, [-math.pi / 3, -0.01])
    np.testing.assert_allclose(arm.rom.upper, [2 * math.pi / 3, 0.04])
    np.testing.assert_allclose(arm.chain.base[:3, 3], [0.1, 0.2, 0.3])
    np.testing.assert_allclose(arm.chain.tool[:3, 3], [0, 0, 0.05])
    np.testing.assert_array_equal(arm.pointing_axis, [0, 0, 1])
    np.testing.assert_array_equal(arm.up, [0, 1, 0])
    np.testing.assert_array_equal(arm.outward, [0, 0, -1])


def test_an_arm_without_a_name_is_named_after_its_file(tmp_path):
    assert load_arm(write(tmp_path, edited('name = "small"\n', ""))).name == "arm"


def test_what_is_left_out_is_zero_revolute_and_identity(tmp_path):
    head = 'convention = "standard"\nangle_unit = "rad"\nlength_unit = "m"\n'
    text = head + '[[joint]]\nname = "q1"\nrange = [-1, 2]\n'
    arm = load_arm(write(tmp_path, text))
    (link,) = arm.chain.links
    assert (link.theta, link.d, link.a, link.alpha, link.sign) == (0, 0, 0, 0, 1)
    assert link.joint is JointType.REVOLUTE
    np.testing.assert_array_equal(arm.chain.base, np.eye(4))
    np.testing.assert_array_equal(arm.pointing_axis, [1, 0, 0])
    assert arm.up is arm.outward is None
    assert (arm.rom.lower[0], arm.rom.upper[0]) == (-1, 2)


def refused(tmp_path, text, *fragments, kind=ArmFileError):
    file = write(tmp_path, text)
    with pytest.raises(kind) as caught:
        load_arm(file)
    message = str(caught.value)
    assert message.startswith(f"{file}: ")
    for fragment in fragments:
        assert fragment in message


@pytest.mark.parametrize(
    ("old", "new", "fragments"),
    [
        ('convention = "modified"\n', "", ["convention is None", "standard, modified"]),
        ('"modified"', '"craig"', ["convention is 'craig'", "standard, modified"]),
        ('"modified"', "1", ["convention is 1", "standard, modified"]),
        ('"small"', '"left arm"', ["arm name 'left arm'", "plain identifier"]),
        ('"small"', "3", ["arm name 3", "plain identifier"]),
        ("description =", "descripton =", ["unknown key 'descripton'", "description"]),
        ("theta = 90", "thetha = 90", ["joint 1 (shoulder)", "unknown key 'thetha'", "theta"]),
        ('"prismatic"', '"slider"', ["joint 2 (slide)", "'slider'", "revolute, prismatic, fixed"]),
        ('"shoulder"', '"shoulder-1"', ["joint name 'shoulder-1'", "plain identifier"]),
        ('"shoulder"', '"int"', ["joint name 'int'", "no C keyword"]),
        ('"shoulder"', '"x;y"', ["joint name 'x;y'", "plain identifier"]),
        ('"shoulder"', '""', ["joint name ''", "plain identifier"]),
        ('"shoulder"', '"é"', ["joint name 'é'", "plain identifier"]),
        ('"shoulder"', '"_x"', ["joint name '_x'", "plain identifier"]),
        ('"shoulder"', f'"{"a" * 64}"', [f"joint name '{'a' * 64}'", "1 to 63"]),
        ('name = "shoulder"\n', "", ["joint name ''", "plain identifier"]),
        ('"slide"', '"shoulder"', ["joint name 'shoulder' occurs twice"]),
        ("theta = 90", "theta = true", ["joint 1 (shoulder): theta is True", "finite number"]),
        ("theta = 90", "theta = nan", ["joint 1 (shoulder): theta is nan", "finite number"]),
        ("theta = 90", "theta = -inf", ["joint 1 (shoulder): theta is -inf", "finite number"]),
        ("theta = 90", "theta = 1e999", ["joint 1 (shoulder): theta is inf", "finite number"]),
        ("theta = 90", 'theta = "90"', ["joint 1 (shoulder): theta is '90'", "finite number"]),
        ("alpha = -45", 'alpha = "upper_arm"', ["joint 1 (shoulder): alpha is 'upper_arm'", "finite number"]),
        ("d = 7", "d = false", ["joint 1 (shoulder): d is False", "finite number"]),
        ("d = 7", "d = [7]", ["joint 1 (shoulder): d is [7]", "finite number"]),
        ("d = 7", 'd = "upper arm"', ["segment length name 'upper arm'", "plain identifier"]),
        ("d = 7", 'd = "forearm"', ["segment length 'forearm' is missing"]),
        ("d = 2", 'd = "upper_arm"', ["'slide'", "d must be a number, not 'upper_arm'"]),
        ("sign = -1", "sign = 0", ["joint 'shoulder': sign is 0", "1 or -1"]),
        ("sign = -1", "sign = true", ["joint 'shoulder': sign is True", "1 or -1"]),
        ("sign = -1", 'sign = "-"', ["joint 'shoulder': sign is '-'", "1 or -1"]),
        ("range = [-60, 120]\n", "", ["joint 'shoulder': range is missing", "[lower, upper]"]),
        ("[-60, 120]", "[120, -60]", ["joint 'shoulder': range", "lower limit 120 above upper limit -60"]),
        ("[-60, 120]", "[-60]", ["joint 'shoulder': range is [-60]", "expected [lower, upper]"]),
        ("[-60, 120]", "120", ["joint 'shoulder': range is 120", "expected [lower, upper]"]),
        ("[-60, 120]", "[nan, 120]", ["joint 'shoulder': range is nan", "finite number"]),
        ("[-60, 120]", "[-60, inf]", ["joint 'shoulder': range is inf", "finite number"]),
        ("[-60, 120]", "[false, true]", ["joint 'shoulder': range is False", "finite number"]),
        ("upper_arm = 30", "", ["segment length 'upper_arm' is missing"]),
        ("upper_arm = 30", "upper_arm = 30\nhand = 18", ["'hand'", "valid are upper_arm"]),
        ("upper_arm = 30", "upper_arm = 3000", ["'upper_arm' is 30", "0 to 5 m", "0.03 m if this is in"]),
        ("upper_arm = 30", "upper_arm = -30", ["'upper_arm' is -0.3", "0 to 5 m"]),
        ("upper_arm = 30", "upper_arm = true", ["lengths.upper_arm is True", "finite number"]),
        ("upper_arm = 30", "upper_arm = nan", ["lengths.upper_arm is nan", "finite number"]),
        ("[0, 0, 1]\nup", "[0, 1, 1]\nup", ["pointing_axis is [0. 1. 1.]", "unit vector"]),
        ("[0, 0, 1]\nup", '"z"\nup', ["pointing_axis is 'z'", "list of numbers"]),
        ("[0, 0, 1]\nup", "[false, false, true]\nup", ["pointing_axis is False", "finite number"]),
        ("[0, 0, 1]\nup", "[0, [0], 1]\nup", ["pointing_axis", "rows of different length"]),
        ("[0, 1, 0]\nout", "[0, 2, 0]\nout", ["up is [0. 2. 0.]", "unit vector"]),
        ("[0, 0, -1]\n", '"left"\n', ["outward is 'left'", "list of numbers"]),
        ("[0, 0, -1]\n", "[0, -1]\n", ["outward is [ 0. -1.]", "unit vector"]),
        ("[1, 0, 0, 10], ", "", ["base transform has shape (3, 4)", "4×4"]),
        ("[1, 0, 0, 10], ", "[1, 0, 0], ", ["base has rows of different length"]),
        ("[1, 0, 0, 10], ", "[2, 0, 0, 10], ", ["base transform is not rigid"]),
        ("[1, 0, 0, 10], ", "[1, 0, 0, true], ", ["base is True", "finite number"]),
        ("[0, 0, 1, 5]", "[0, 0, 1, nan]", ["tool is nan", "finite number"]),
        ("[0, 0, 1, 5]", "[0, 0, -1, 5]", ["tool transform is not rigid"]),
        ("[[joint]]\nname = \"shoulder\"", "[[rows]]\nname = \"shoulder\"", ["unknown key 'rows'"]),
    ],
)  # fmt: skip
def test_a_mistake_is_named_with_its_value_and_what_is_allowed(tmp_path, old, new, fragments):
    refused(tmp_path, edited(old, new), *fragments)


@pytest.mark.parametrize(("key", "units"), [("angle_unit", "rad, deg"), ("length_unit", "m, cm, mm")])
def test_units_must_be_declared(tmp_path, key, units):
    without = re.sub(rf"{key} = .*\n", "", SMALL)
    refused(tmp_path, without, f"{key} is missing", f"(allowed: {units})", kind=UnitError)
    unknown = re.sub(rf"{key} = .*\n", f'{key} = "inch"\n', SMALL)
    refused(tmp_path, unknown, f"{key} is 'inch'", f"(allowed: {units})", kind=UnitError)


def test_degrees_declared_as_radians_are_noticed(tmp_path):
    text = edited('angle_unit = "deg"', 'angle_unit = "rad"')
    refused(tmp_path, text, "'shoulder': range is [-60, 120] rad", "full turn", kind=UnitError)


@pytest.mark.parametrize("rows", ["joint = []", "joint = 3", "joint = {}"])
def test_an_arm_needs_rows(tmp_path, rows):
    text = f'convention = "standard"\nangle_unit = "deg"\nlength_unit = "m"\n{rows}\n'
    refused(tmp_path, text, "no [[joint]] rows")


def test_rows_must_be_tables(tmp_path):
    text = 'convention = "standard"\nangle_unit = "deg"\nlength_unit = "m"\njoint = [1, 2]\n'
    refused(tmp_path, text, "joint 1 is 1, expected a table [[joint]]")


def test_an_arm_of_fixed_rows_cannot_move(tmp_path):
    text = re.sub(r'\[\[joint\]\]\nname = "sh.*(?=\[\[joint\]\]\nname = "spacer")', "", SMALL, flags=re.S)
    refused(tmp_path, text.replace("upper_arm = 30\n", ""), "at least one row that moves")


@pytest.mark.parametrize("name", catalog.names())
def test_a_file_cut_off_anywhere_is_an_arm_or_a_clean_error(tmp_path, name):
    content = (ARMS / f"{name}.toml").read_bytes()
    file = tmp_path / "half.toml"
    outcomes = set()
    for end in [*range(0, len(content), 7), len(content)]:
        file.write_bytes(content[:end])
        try:
            outcomes.add(type(load_arm(file)))
        except ArmikError as error:
            assert str(error).startswith(str(file))  # noqa: PT017
            outcomes.add(ArmikError)
    assert outcomes == {Arm, ArmikError}


WRONG = [True, math.nan, math.inf, 10**400, -(10**400), "x", [], {}, [[]], [{}], datetime.date(2021, 7, 8)]


def places(node, path=()):
    """Every key and index of a parsed file."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from places(value, (*path, key))


def replaced(table, place, value):
    table = copy.deepcopy(table)
    node = table
    for key in place[:-1]:
        node = node[key]
    old, node[place[-1]] = node[place[-1]], value
    return table, old


def test_no_value_of_a_wrong_type_anywhere_gets_through_or_crashes(tmp_path):
    file = write(tmp_path, SMALL)
    table = load_toml(file)
    for place in places(table):
        for wrong in WRONG:
            changed, old = replaced(table, place, wrong)
            harmless = place == ("description",) or (
                isinstance(old, str) and wrong == "x" and "unit" not in place
            )
            try:
                arm_from_table(file, changed)
            except ArmikError as error:
                assert str(file) in str(error)  # noqa: PT017
            else:
                assert harmless, (place, wrong)
