"""Reading TOML values: every refusal names the file, the key, the value and what is allowed."""

from __future__ import annotations

import datetime
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm.toml_reader import (
    ANGLE_UNITS,
    LENGTH_UNITS,
    check_keys,
    limit_pair,
    load_toml,
    number,
    sub_table,
    unit_factor,
)
from armik_sym.errors import ArmFileError, UnitError

FILE = Path("some") / "arm.toml"
NO_NUMBERS = [
    True,
    False,
    math.nan,
    math.inf,
    -math.inf,
    10**400,
    1e101,
    "1",
    None,
    [1],
    datetime.date(2021, 7, 8),
]


def test_a_file_is_parsed(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text('name = "é"\n[x]\ny = [1, 2.5]\n', encoding="utf-8")
    assert load_toml(file) == {"name": "é", "x": {"y": [1, 2.5]}}


def test_windows_line_ends_and_byte_order_mark_do_not_matter(tmp_path):
    file = tmp_path / "a.toml"
    file.write_bytes(b'\xef\xbb\xbfname = "arm"\r\n[x]\r\ny = 1\r\n')
    assert load_toml(file) == {"name": "arm", "x": {"y": 1}}


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ArmFileError) as caught:
        load_toml(tmp_path / "nowhere.toml")
    assert str(caught.value) == f"{tmp_path / 'nowhere.toml'}: no such file"


def test_a_folder_cannot_be_read(tmp_path):
    with pytest.raises(ArmFileError, match="cannot be read"):
        load_toml(tmp_path)


@pytest.mark.parametrize("content", [b"\x89PNG\r\n\x1a\n\x00\xff", b"name = '\xe9'", b"\xff\xfen\x00a\x00"])
def test_a_binary_file_cannot_be_read(tmp_path, content):
    file = tmp_path / "picture.toml"
    file.write_bytes(content)
    with pytest.raises(ArmFileError, match=r"picture\.toml: cannot be read"):
        load_toml(file)


@pytest.mark.parametrize(
    "content", ["name = ", "[joint", "{}", "a = 1\na = 2", "a\0b = 1", "x = [1,", "name: arm"]
)
def test_what_is_not_toml_is_refused(tmp_path, content):
    file = tmp_path / "half.toml"
    file.write_text(content)
    with pytest.raises(ArmFileError, match=r"half\.toml: not valid TOML: "):
        load_toml(file)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("x = " + 50_000 * "[", "brackets are nested too deeply"),
        (20_000 * "a = {", "brackets are nested too deeply|not valid TOML"),
        ("x = " + 50_000 * "9", "not valid TOML: "),
        ("# fine\n" + 20_000 * "x." + "y = 1", "line 2 has more than 500 dots"),
        ("#" + 200_000 * "a", "more than 100000 bytes"),
    ],
)
def test_garbage_is_refused_at_once(tmp_path, content, words):
    file = tmp_path / "huge.toml"
    file.write_text(content)
    with pytest.raises(ArmFileError, match=rf"huge\.toml: .*({words})"):
        load_toml(file)


def test_a_path_with_a_nul_byte_is_no_path():
    with pytest.raises(ArmFileError, match="cannot be read"):
        load_toml(Path("a\0b.toml"))


def test_keys_nothing_reads_are_refused():
    check_keys(FILE, "the file", {"name": 1}, ("name", "note"))
    with pytest.raises(ArmFileError) as caught:
        check_keys(FILE, "joint 3", {"name": 1, "thetha": 2}, ("name", "theta"))
    assert str(caught.value) == f"{FILE}: joint 3 has unknown key 'thetha': allowed are name, theta"


def test_a_table_that_is_absent_is_empty():
    assert sub_table(FILE, {}, "lengths") == {}
    assert sub_table(FILE, {"lengths": {"hand": 1}}, "lengths") == {"hand": 1}


@pytest.mark.parametrize("value", [0, False, "", [], 3, "x", [{"hand": 1}]])
def test_what_should_be_a_table_and_is_not_is_refused_even_if_empty(value):
    with pytest.raises(ArmFileError) as caught:
        sub_table(FILE, {"lengths": value}, "lengths")
    assert str(caught.value) == f"{FILE}: lengths is {value!r}, expected a table [lengths]"


@pytest.mark.parametrize(("unit", "factor"), [("rad", 1.0), ("deg", math.pi / 180)])
def test_angle_units(unit, factor):
    assert unit_factor(FILE, {"angle_unit": unit}, "angle_unit", ANGLE_UNITS) == factor


@pytest.mark.parametrize(("unit", "factor"), [("m", 1.0), ("cm", 0.01), ("mm", 0.001)])
def test_length_units(unit, factor):
    assert unit_factor(FILE, {"length_unit": unit}, "length_unit", LENGTH_UNITS) == factor


def test_a_unit_that_is_not_declared_is_asked_for():
    with pytest.raises(UnitError) as caught:
        unit_factor(FILE, {}, "angle_unit", ANGLE_UNITS)
    message = str(caught.value)
    assert f"{FILE}: angle_unit is missing" in message
    assert "(allowed: rad, deg)" in message


@pytest.mark.parametrize("unit", ["degrees", "DEG", "", "mm", 1, True, ["deg"]])
def test_an_unknown_unit_is_refused_with_those_that_exist(unit):
    with pytest.raises(UnitError) as caught:
        unit_factor(FILE, {"angle_unit": unit}, "angle_unit", ANGLE_UNITS)
    assert f"{FILE}: angle_unit is {unit!r}" in str(caught.value)
    assert "(allowed: rad, deg)" in str(caught.value)


@given(st.integers(-(10**9), 10**9) | st.floats(-1e100, 1e100))
def test_finite_numbers_pass_as_floats(value):
    result = number(FILE, "theta", value)
    assert type(result) is float
    assert result == value


@pytest.mark.parametrize("value", NO_NUMBERS)
def test_booleans_nan_inf_and_everything_else_are_no_numbers(value):
    with pytest.raises(ArmFileError) as caught:
        number(FILE, "joint 2: theta", value)
    assert str(caught.value) == f"{FILE}: joint 2: theta is {value!r}, expected a finite number up to 1e+100"


@given(st.floats(-360, 360), st.floats(0, 360))
def test_a_pair_of_limits_is_converted(lower, width):
    factor = ANGLE_UNITS["deg"]
    assert limit_pair(FILE, "elbow", [lower, lower + width], factor) == (
        lower * factor,
        (lower + width) * factor,
    )


@pytest.mark.parametrize("value", [None, 1.0, [], [1], [1, 2, 3], "12", {"lower": 0, "upper": 1}])
def test_limits_come_in_pairs(value):
    with pytest.raises(ArmFileError) as caught:
        limit_pair(FILE, "elbow", value, 1.0)
    assert str(caught.value) == f"{FILE}: elbow is {value!r}, expected [lower, upper]"


@pytest.mark.parametrize("value", NO_NUMBERS)
@pytest.mark.parametrize("place", [0, 1])
def test_both_limits_must_be_numbers(value, place):
    pair = [0.0, 0.5]
    pair[place] = value
    with pytest.raises(ArmFileError, match=r"elbow is .*, expected a finite number"):
        limit_pair(FILE, "elbow", pair, 1.0)


def test_crossed_limits_are_refused_with_both_values():
    with pytest.raises(ArmFileError, match="elbow has lower limit 110 above upper limit 35"):
        limit_pair(FILE, "elbow", [110, 35], ANGLE_UNITS["deg"])


@pytest.mark.parametrize("pair", [[0, 110], [-110, 0], [0, 6.3]])
def test_degrees_declared_as_radians_are_refused(pair):
    with pytest.raises(
        UnitError, match='more than a full turn: if these are degrees, say angle_unit = "deg"'
    ):
        limit_pair(FILE, "elbow", pair, ANGLE_UNITS["rad"])
    limit_pair(FILE, "elbow", pair, ANGLE_UNITS["deg"])


def test_a_full_turn_in_radians_and_metres_beyond_it_are_fine():
    assert limit_pair(FILE, "elbow", [-2 * math.pi, 2 * math.pi], 1.0) == (-2 * math.pi, 2 * math.pi)
    assert limit_pair(FILE, "slide", [0, 7], LENGTH_UNITS["m"], angle=False) == (0, 7)
