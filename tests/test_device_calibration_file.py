"""Calibration files: the same to the last bit after a round trip, and errors that name the line."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from calibrations import any_calibration, encoder_joint, pot_joint
from hypothesis import given

from armik_sym.device.calibration import (
    Calibration,
    calibration_text,
    load_calibration,
    parse_calibration,
    save_calibration,
)
from armik_sym.errors import CalibrationError

EXAMPLE = Calibration(
    7, "2026-01-01", (pot_joint("a", 0, largest_step=0.07), encoder_joint("b", 1, index=3.0))
)


@given(any_calibration())
def test_round_trip(calibration: Calibration) -> None:
    assert parse_calibration(calibration_text(calibration)) == calibration


def test_file_round_trip_and_line_ends(tmp_path: Path) -> None:
    file = save_calibration(EXAMPLE, tmp_path / "device.toml")
    assert load_calibration(file) == EXAMPLE
    file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes().replace(b"\n", b"\r\n"))
    assert load_calibration(file) == EXAMPLE
    assert [each.name for each in tmp_path.iterdir()] == ["device.toml"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            'format = "armik calibration 1"',
            'format = "x"',
            "line 2: format is 'x': expected 'armik calibration 1'",
        ),
        ("device_id = 7", "device_id = -7", "line 3: device_id is -7: expected a whole number from 0"),
        ("direction = 1", "direction = 2", "line 15: direction is 2: expected a whole number from -1 to 1"),
        ("direction = 1", "direction = 0", "line 15: joint 'a': direction is 0, expected 1 or -1"),
        ("zero_counts = 0.0", "zero_counts = nan", "line 35: zero_counts is nan: expected a finite number"),
        ("zero_counts = 0.0", "zero_count = 0.0", "line 35: zero_count is 0.0: unknown key"),
        ("zero_counts = 0.0\n", "", "line 27: zero_counts is missing: expected a finite number"),
        ('sensor = "encoder"', 'sensor = "resolver"', "line 30: sensor is 'resolver': expected one of"),
        ("channel = 1", "channel = 0", "channel 0 is calibrated twice"),
        ("valid_counts = [41.0, 4054.0]", "valid_counts = [9, 1]", "line 18: joint 'a': valid is"),
        ("valid_counts = [41.0, 4054.0]", "valid_counts = 9", "line 18: valid_counts is 9: expected [lowest"),
        ("[[joint]]", "[joint]", "line 8: not valid|expected at least one table|not valid TOML"),
        ("notes = []", "notes = [1]", "line 6: notes is [1]: expected a list of texts"),
        ("date = ", "date == ", "not valid TOML: .*line 4"),
        ("notes = []", f"notes = {20_000 * '['}", "brackets are nested too deeply|not valid TOML"),
        ("notes = []", f"{600 * 'a.'}b = 1", "line 6 has more than 500 dots"),
        ("notes = []", f"notes = {50_000 * '9'}", "not valid TOML: |notes is"),
    ],
)
def test_errors_name_file_line_key_and_what_was_expected(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    text = calibration_text(EXAMPLE)
    assert old in text
    file = tmp_path / "device.toml"
    file.write_text(text.replace(old, new, 2 if old == "[[joint]]" else 1), encoding="utf-8")
    with pytest.raises(CalibrationError) as caught:
        load_calibration(file)
    message = str(caught.value)
    assert message.startswith(f"{file}: ")
    if "|" in said or ".*" in said:
        with pytest.raises(CalibrationError, match=said):
            load_calibration(file)
    else:
        assert said in message


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="no such file"):
        load_calibration(tmp_path / "none.toml")
    with pytest.raises(CalibrationError, match="cannot be read"):
        load_calibration(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(CalibrationError, match="is no UTF-8 text"):
        load_calibration(tmp_path / "binary.toml")
    with pytest.raises(CalibrationError, match="there is no folder"):
        save_calibration(EXAMPLE, tmp_path / "none" / "a.toml")
    with pytest.raises(CalibrationError, match="cannot be written"):
        save_calibration(EXAMPLE, tmp_path)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"scale": -1.0}, "scale is -1.0"),
        ({"scale": math.nan}, "scale is nan"),
        ({"direction": 0}, "direction is 0"),
        ({"zero": math.inf}, "zero is inf"),
        ({"valid": (3.0, 3.0)}, "valid is"),
        ({"index": 3.0}, "index is 3.0"),
        ({"largest_step": 0.0}, "largest_step is 0.0"),
        ({"channel": 9}, "channel is 9"),
    ],
)
def test_joints_that_cannot_be(values: dict[str, object], said: str) -> None:
    with pytest.raises(CalibrationError, match=f"joint 'elbow': {said}"):
        pot_joint(**values)  # type: ignore[arg-type]
    with pytest.raises(CalibrationError, match="at least one joint"):
        Calibration(1, "", ())
    with pytest.raises(CalibrationError, match="'a' is calibrated twice"):
        Calibration(1, "", (pot_joint("a", 0), pot_joint("a", 1)))
