"""Patient files: what they narrow, and every mistake answered with file, joint, value and what is allowed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from armik_sym.arm import catalog, load_arm
from armik_sym.arm.patient_file import patient_from_table
from armik_sym.arm.toml_reader import load_toml
from armik_sym.errors import ArmFileError, ArmikError, UnitError, UnknownNameError

PATIENTS = Path(__file__).resolve().parents[1] / "data" / "patients"
FILE = Path("patient.toml")

GOOD = """\
patient = "P07"
note = "elbow stiff"
arm = "human"
angle_unit = "deg"
length_unit = "mm"

[lengths]
forearm = 241

[range_of_motion]
elbow_flexion = [30, 100]
wrist_extension = [-10, 25.5]
"""


def write(tmp_path, text, name="patient.toml"):
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    return file


def edited(old, new):
    assert GOOD.count(old) == 1, old
    return GOOD.replace(old, new)


def test_named_joints_are_narrowed_and_all_others_stay(tmp_path):
    arm, whole = load_arm(write(tmp_path, GOOD)), catalog.human()
    assert arm.joint_names == whole.joint_names
    for i, name in enumerate(arm.joint_names):
        lower, upper = np.rad2deg([arm.rom.lower[i], arm.rom.upper[i]])
        if name == "elbow_flexion":
            assert (lower, upper) == pytest.approx((30, 100))
        elif name == "wrist_extension":
            assert (lower, upper) == pytest.approx((-10, 25.5))
        else:
            assert (arm.rom.lower[i], arm.rom.upper[i]) == (whole.rom.lower[i], whole.rom.upper[i])


def test_named_lengths_change_and_all_others_stay(tmp_path):
    arm = load_arm(write(tmp_path, GOOD))
    assert dict(arm.lengths) == pytest.approx({"upper_arm": 0.28, "forearm": 0.241, "hand": 0.19})


def test_units_are_only_asked_for_if_something_has_one(tmp_path):
    load_arm(
        write(tmp_path, 'arm = "ehmcs"\nangle_unit = "rad"\n[range_of_motion]\nelbow_flexion = [0.5, 1]\n')
    )
    load_arm(write(tmp_path, 'arm = "ehmcs"\nlength_unit = "m"\n[lengths]\nforearm = 0.3\n'))


@pytest.mark.parametrize("file", sorted(PATIENTS.glob("*.toml")), ids=lambda file: file.stem)
def test_the_example_patients_narrow_their_arm_and_say_why(file):
    table, arm = load_toml(file), load_arm(file)
    whole = catalog.by_name(arm.name)
    assert table["note"].strip()
    assert table["patient"].startswith("example")
    assert np.all(arm.rom.lower >= whole.rom.lower)
    assert np.all(arm.rom.upper <= whole.rom.upper)
    assert np.any(arm.rom.width < whole.rom.width)


def test_there_are_example_patients_for_an_exoskeleton_and_for_an_arm_with_lengths():
    assert load_arm(PATIENTS / "stroke_elbow.toml").name == "ehmcs"
    operated = load_arm(PATIENTS / "shoulder_arthroplasty.toml")
    assert operated.name == "human"
    assert dict(operated.lengths) != dict(catalog.human().lengths)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(catalog.names()), st.data())
def test_any_narrower_range_is_taken_over_as_it_is(name, data):
    arm = catalog.by_name(name)
    i = data.draw(st.integers(0, arm.dof - 1))
    own = st.floats(float(arm.rom.lower[i]), float(arm.rom.upper[i]))
    pair = sorted([data.draw(own), data.draw(own)])
    table = {"arm": name, "angle_unit": "rad", "range_of_motion": {arm.joint_names[i]: pair}}
    narrowed = patient_from_table(FILE, table, arm)
    assert [narrowed.rom.lower[i], narrowed.rom.upper[i]] == pair
    others = np.arange(arm.dof) != i
    np.testing.assert_array_equal(narrowed.rom.lower[others], arm.rom.lower[others])
    np.testing.assert_array_equal(narrowed.rom.upper[others], arm.rom.upper[others])


@given(st.sampled_from(catalog.names()), st.data(), st.floats(1e-3, 3), st.booleans())
def test_any_wider_range_is_refused_with_joint_limit_and_the_arm_s_own(name, data, excess, above):
    arm = catalog.by_name(name)
    i = data.draw(st.integers(0, arm.dof - 1))
    lower, upper = np.rad2deg([arm.rom.lower[i], arm.rom.upper[i]])
    pair = [lower, upper + excess] if above else [lower - excess, upper]
    table = {"arm": name, "angle_unit": "deg", "range_of_motion": {arm.joint_names[i]: pair}}
    with pytest.raises(ArmFileError) as caught:
        patient_from_table(FILE, table, arm)
    message = str(caught.value)
    assert f"range_of_motion.{arm.joint_names[i]} is [{pair[0]:g}, {pair[1]:g}] deg" in message
    assert f"outside the arm's own [{lower:g}, {upper:g}] deg" in message


def test_the_arm_s_own_limits_in_degrees_are_not_missed_by_rounding():
    arm = catalog.human()
    arm = arm.with_rom(-np.linspace(1, 2, arm.dof), np.linspace(1, 2, arm.dof))
    outward = np.ceil(np.rad2deg(arm.rom.upper) * 1e9) / 1e9
    assert np.all(np.deg2rad(outward) > arm.rom.upper)
    ranges = {name: [-limit, limit] for name, limit in zip(arm.joint_names, outward.tolist(), strict=True)}
    narrowed = patient_from_table(FILE, {"angle_unit": "deg", "range_of_motion": ranges}, arm)
    np.testing.assert_array_equal(narrowed.rom.lower, arm.rom.lower)
    np.testing.assert_array_equal(narrowed.rom.upper, arm.rom.upper)


def refused(tmp_path, text, *fragments, kind=ArmFileError):
    file = write(tmp_path, text)
    with pytest.raises(kind) as caught:
        load_arm(file)
    message = str(caught.value)
    assert str(file) in message
    for fragment in fragments:
        assert fragment in message


@pytest.mark.parametrize(
    ("old", "new", "fragments"),
    [
        ("elbow_flexion", "elbow_flection", ["joint 'elbow_flection'", "arm 'human' has", "elbow_flexion"]),
        ("elbow_flexion", '"elbow-flexion"', ["unknown joint 'elbow-flexion'", "elbow_flexion"]),
        ("elbow_flexion", '""', ["unknown joint ''", "elbow_flexion"]),
        ("[30, 100]", "[100, 30]", ["range_of_motion.elbow_flexion", "lower limit 100 above upper limit 30"]),
        ("[30, 100]", "[30, 150]", ["elbow_flexion is [30, 150] deg", "own [0, 145] deg", "only narrow"]),
        ("[30, 100]", "[-5, 100]", ["elbow_flexion is [-5, 100] deg", "own [0, 145] deg", "only narrow"]),
        ("[30, 100]", "[-9, -5]", ["elbow_flexion is [-9, -5] deg", "own [0, 145] deg"]),
        ("[30, 100]", "[30]", ["range_of_motion.elbow_flexion is [30]", "expected [lower, upper]"]),
        ("[30, 100]", "100", ["range_of_motion.elbow_flexion is 100", "expected [lower, upper]"]),
        ("[30, 100]", "[nan, 100]", ["range_of_motion.elbow_flexion is nan", "finite number"]),
        ("[30, 100]", "[30, inf]", ["range_of_motion.elbow_flexion is inf", "finite number"]),
        ("[30, 100]", "[false, true]", ["range_of_motion.elbow_flexion is False", "finite number"]),
        ("[30, 100]", '["30", "100"]', ["range_of_motion.elbow_flexion is '30'", "finite number"]),
        ("forearm = 241", "hand_length = 241", ["'hand_length'", "valid are forearm, hand, upper_arm"]),
        ("forearm = 241", "forearm = true", ["lengths.forearm is True", "finite number"]),
        ("forearm = 241", "forearm = nan", ["lengths.forearm is nan", "finite number"]),
        ("forearm = 241", "forearm = -241", ["'forearm' is -0.241", "0 to 5 m"]),
        ('length_unit = "mm"', 'length_unit = "m"', ["'forearm' is 241", "0.241 m if this is in mil"]),
        ("note =", "remark =", ["unknown key 'remark'", "note"]),
        ('arm = "human"', 'arm = "human"\nconvention = "standard"', ["unknown key 'convention'"]),
        ('arm = "human"\n', "", ["neither an arm", 'arm = "NAME"']),
        ('arm = "human"', "arm = 7", ["neither an arm", 'arm = "NAME"']),
        ('arm = "human"', "arm = true", ["neither an arm", 'arm = "NAME"']),
    ],
)  # fmt: skip
def test_a_mistake_is_named_with_its_value_and_what_is_allowed(tmp_path, old, new, fragments):
    refused(tmp_path, edited(old, new), *fragments)


@pytest.mark.parametrize("key", ["range_of_motion", "lengths"])
@pytest.mark.parametrize("value", ["0", "false", '""', "[]", "[[30, 100]]", '"elbow_flexion"'])
def test_what_should_be_a_table_and_is_not_is_refused_even_if_empty(tmp_path, key, value):
    refused(tmp_path, f'arm = "human"\n{key} = {value}\n', f"{key} is ", f"expected a table [{key}]")


@pytest.mark.parametrize(
    ("key", "allowed"), [("angle_unit", "(allowed: rad, deg)"), ("length_unit", "(allowed: m, cm, mm)")]
)
def test_units_must_be_declared(tmp_path, key, allowed):
    line = next(line for line in GOOD.splitlines() if line.startswith(key))
    refused(tmp_path, edited(f"{line}\n", ""), f"{key} is missing", allowed, kind=UnitError)
    refused(tmp_path, edited(line, f'{key} = "grad"'), f"{key} is 'grad'", allowed, kind=UnitError)


def test_degrees_declared_as_radians_are_noticed(tmp_path):
    text = edited('angle_unit = "deg"', 'angle_unit = "rad"')
    refused(tmp_path, text, "elbow_flexion is [30, 100] rad", 'angle_unit = "deg"', kind=UnitError)


def test_an_unknown_arm_is_answered_with_the_file_and_the_catalogue(tmp_path):
    text = edited('"human"', '"huamn"')
    refused(tmp_path, text, "'huamn'", "valid are alfaiz, ehmcs, human", kind=UnknownNameError)


def test_a_half_written_file_is_refused(tmp_path):
    refused(tmp_path, GOOD[: GOOD.index("100]")], "not valid TOML")


def test_a_file_cut_off_anywhere_is_read_or_refused_cleanly(tmp_path):
    file = tmp_path / "half.toml"
    whole = catalog.human()
    for end in range(len(GOOD)):
        file.write_text(GOOD[:end])
        try:
            arm = load_arm(file)
        except ArmikError as error:
            assert str(file) in str(error)  # noqa: PT017
        else:
            assert np.all(arm.rom.width <= whole.rom.width)


SLIDER = """\
convention = "standard"
angle_unit = "deg"
length_unit = "cm"
[[joint]]
name = "turn"
range = [-90, 90]
[[joint]]
name = "slide"
type = "prismatic"
range = [0, 20]
"""


def test_a_sliding_joint_is_narrowed_in_the_length_unit(tmp_path):
    write(tmp_path, SLIDER, "slider.toml")
    head = 'arm = "slider.toml"\nlength_unit = "mm"\n[range_of_motion]\n'
    arm = load_arm(write(tmp_path, head + "slide = [50, 150]\n"))
    np.testing.assert_allclose([arm.rom.lower, arm.rom.upper], [[-math.pi / 2, 0.05], [math.pi / 2, 0.15]])
    refused(tmp_path, head + "slide = [50, 250]\n", "slide is [50, 250] mm", "own [0, 200] mm")
    refused(
        tmp_path,
        'arm = "slider.toml"\nangle_unit = "deg"\n[range_of_motion]\nslide = [1, 2]\n',
        "length_unit is missing",
        kind=UnitError,
    )


def test_a_patient_may_refer_to_another_patient_and_only_narrow_further(tmp_path):
    write(tmp_path, GOOD, "week_1.toml")
    head = 'arm = "week_1.toml"\nangle_unit = "deg"\n[range_of_motion]\n'
    arm = load_arm(write(tmp_path, head + "elbow_flexion = [40, 90]\n", "week_2.toml"))
    i = arm.joint_index("elbow_flexion")
    assert np.rad2deg([arm.rom.lower[i], arm.rom.upper[i]]) == pytest.approx([40, 90])
    assert np.rad2deg(arm.rom.upper[arm.joint_index("wrist_extension")]) == pytest.approx(25.5)
    assert arm.lengths["forearm"] == pytest.approx(0.241)
    refused(tmp_path, head + "elbow_flexion = [20, 90]\n", "[20, 90] deg", "own [30, 100] deg")


def test_a_patient_file_that_changes_nothing_is_refused(tmp_path):
    file = tmp_path / "p.toml"
    file.write_text('arm = "ehmcs"\nangle_unit = "deg"\n', encoding="utf-8")
    with pytest.raises(ArmFileError, match=r"p\.toml: neither \[range_of_motion\] nor \[lengths\].*ehmcs"):
        load_arm(file)


def test_the_patient_can_be_traced_from_the_arm(tmp_path):
    file = tmp_path / "p.toml"
    text = 'patient = "P07"\narm = "ehmcs"\nangle_unit = "deg"\n[range_of_motion]\nelbow_flexion = [10, 90]\n'
    file.write_text(text, encoding="utf-8")
    assert load_arm(file).description.endswith("narrowed by patient P07, p.toml")
