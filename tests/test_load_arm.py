"""Loading by name or by path: what is found, and what is said when nothing is."""

from __future__ import annotations

import os

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from armik_sym.arm import catalog, load_arm
from armik_sym.errors import ArmFileError, ArmikError, UnknownNameError

ARM = """\
convention = "standard"
angle_unit = "deg"
length_unit = "m"
[[joint]]
name = "elbow"
a = 0.3
range = [0, 145]
"""


@pytest.mark.parametrize("name", ["alfaiz", "ehmcs", "human"])
def test_the_catalogue_is_found_by_name(name):
    assert name in catalog.names()
    assert load_arm(name).name == catalog.by_name(name).name == name


@pytest.mark.parametrize("name", ["EHMCS", "huamn", "", "ehmcs.tml", "no/such/place"])
def test_an_unknown_name_is_answered_with_those_that_exist(name):
    for look_up in (load_arm, catalog.by_name):
        if look_up is load_arm and name == "":
            continue  # the empty path is the working directory
        with pytest.raises(UnknownNameError) as caught:
            look_up(name)
        assert str(caught.value) == f"unknown arm {name!r}: valid are alfaiz, ehmcs, human"
        assert caught.value.valid == ["alfaiz", "ehmcs", "human"]


@pytest.mark.parametrize("kind", [str, os.fspath, lambda path: path])
def test_a_path_may_be_text_or_a_path(tmp_path, kind):
    file = tmp_path / "my_arm.toml"
    file.write_text(ARM)
    assert load_arm(kind(file)).name == "my_arm"


@pytest.mark.parametrize("name", ["my_arm.TOML", "my_arm.txt", "my_arm"])
def test_an_existing_file_is_read_whatever_its_ending(tmp_path, name):
    file = tmp_path / name
    file.write_text(ARM)
    assert load_arm(file).joint_names == ("elbow",)


def test_a_folder_or_file_of_that_name_does_not_hide_the_catalogue(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ehmcs").mkdir()
    (tmp_path / "human").write_text("what a human is")
    assert load_arm("ehmcs").dof == 7
    assert load_arm("human").name == "human"


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ArmFileError, match=r"nowhere\.toml: no such file"):
        load_arm(tmp_path / "nowhere.toml")


@pytest.mark.parametrize("name", ["folder", "folder.toml"])
def test_a_folder_is_no_arm(tmp_path, name):
    (tmp_path / name).mkdir()
    with pytest.raises(ArmFileError, match=rf"{name}: cannot be read"):
        load_arm(tmp_path / name)


def test_a_file_that_is_neither_an_arm_nor_a_patient_says_what_is_missing(tmp_path):
    file = tmp_path / "empty.toml"
    file.write_text("")
    with pytest.raises(ArmFileError, match=r"empty\.toml: neither an arm .* nor a patient"):
        load_arm(file)


def test_an_arm_file_is_found_next_to_the_patient_s_from_anywhere(tmp_path, monkeypatch):
    (tmp_path / "arms").mkdir()
    (tmp_path / "patients").mkdir()
    (tmp_path / "arms" / "my_arm.toml").write_text(ARM)
    patient = tmp_path / "patients" / "p.toml"
    patient.write_text(
        'arm = "../arms/my_arm.toml"\nangle_unit = "deg"\n[range_of_motion]\nelbow = [10, 90]\n'
    )
    monkeypatch.chdir(tmp_path / "arms")
    arm = load_arm(patient)
    assert arm.name == "my_arm"
    np.testing.assert_allclose(np.rad2deg(arm.rom.upper), [90])


def test_a_patient_whose_arm_file_is_missing_names_that_file(tmp_path):
    (tmp_path / "p.toml").write_text('arm = "nowhere.toml"\n')
    with pytest.raises(ArmFileError, match=r"nowhere\.toml: no such file"):
        load_arm(tmp_path / "p.toml")


@pytest.mark.parametrize(
    "links",
    [{"a": "a"}, {"a": "b", "b": "a"}, {"a": "./a"}, {"a": "b", "b": "c", "c": "../{folder}/b"}],
)
def test_files_that_refer_to_themselves_are_refused(tmp_path, links):
    for name, target in links.items():
        arm = target.format(folder=tmp_path.name)
        (tmp_path / f"{name}.toml").write_text(f'arm = "{arm}.toml"\n')
    with pytest.raises(ArmFileError, match="refers to itself through its 'arm' key"):
        load_arm(tmp_path / "a.toml")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=60) | st.text(max_size=60).map(lambda text: text.encode("utf-8", "replace")))
def test_no_content_at_all_makes_anything_but_our_own_error(tmp_path, content):
    file = tmp_path / "noise.toml"
    file.write_bytes(content)
    with pytest.raises(ArmikError):
        load_arm(file)


def test_every_error_can_also_be_caught_as_a_value_error(tmp_path):
    (tmp_path / "bad.toml").write_text("joint = [")
    for source in (tmp_path / "bad.toml", tmp_path / "nowhere.toml", "huamn"):
        with pytest.raises(ValueError):
            load_arm(source)
