"""Files of solutions: units in the header, values that read back, a record that is JSON."""

from __future__ import annotations

import csv
import json
import os

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles, uneven_time
from solutions import of_motion

from armik_sym.errors import MotionFileError
from armik_sym.motion.hand_path import HandPath

ARM = ARMS["human"]


@pytest.fixture
def solution():
    path = path_of(ARM, smooth_angles(ARM, 6, 0), uneven_time(6, 1))
    shifted = HandPath(path.time, path.position + np.array([0.001, 0, 0]), path.rotation)
    return of_motion(ARM, smooth_angles(ARM, 6, 0), path=shifted, seed=7, status="Solve_Succeeded")


def record_is_right(record, solution):
    assert record["program"].startswith("armik_sym ")
    assert record["arm"] == "human"
    assert record["lengths_m"] == dict(ARM.lengths)
    assert record["method"] == "by hand"
    assert record["orientation"] == "full"
    assert record["seed"] == 7
    assert record["ok"] is False
    assert record["reasons"] == list(solution.reasons)
    assert record["status"] == "Solve_Succeeded"


@pytest.mark.parametrize("name", ["out.csv", "OUT.CSV"])
def test_csv(solution, tmp_path, name):
    written = solution.save(str(tmp_path / name))
    assert written == tmp_path / name
    first, *rest = written.read_text(encoding="utf-8").splitlines()
    assert first.startswith("# ")
    record_is_right(json.loads(first[2:]), solution)
    header, *rows = list(csv.reader(rest))
    assert header[0] == "time [s]"
    assert header[1:8] == [f"{joint} [deg]" for joint in ARM.joint_names]
    assert header[8:] == ["position_error [mm]", "rotation_error [deg]"]
    values = np.array(rows, dtype=float)
    assert np.array_equal(values[:, 0], solution.time)
    np.testing.assert_allclose(np.deg2rad(values[:, 1:8]), solution.q, rtol=1e-15, atol=1e-16)
    np.testing.assert_allclose(values[:, 8], 1.0, rtol=1e-12)
    np.testing.assert_allclose(values[:, 9], np.rad2deg(solution.rotation_error))


@pytest.mark.parametrize("turned", [True, False])
def test_npz(solution, tmp_path, turned):
    if not turned:
        solution = of_motion(ARM, solution.q, path=HandPath(solution.time, solution.path.position), seed=7)
    with np.load(solution.save(tmp_path / "out.npz"), allow_pickle=False) as file:
        assert np.array_equal(file["q"], solution.q)
        assert np.array_equal(file["time"], solution.time)
        assert file["joint_names"].tolist() == list(ARM.joint_names)
        assert np.array_equal(file["lower"], ARM.rom.lower)
        assert np.array_equal(file["upper"], ARM.rom.upper)
        assert np.array_equal(file["path_position"], solution.path.position)
        expected = solution.path.rotation if turned else np.empty((0, 3, 3))
        assert np.array_equal(file["path_rotation"], expected)
        assert np.array_equal(file["position_error"], solution.position_error)
        assert np.array_equal(file["rotation_error"], solution.rotation_error)
        record = json.loads(str(file["record"]))
        assert record["reasons"] == list(solution.reasons)


@pytest.mark.parametrize("name", ["out.xyz", "out"])
def test_unknown_ending_lists_the_valid_ones_and_writes_nothing(solution, tmp_path, name):
    with pytest.raises(MotionFileError, match=r"valid are .*\.csv.*\.npz"):
        solution.save(tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["out.csv", "out.npz"])
def test_a_place_that_cannot_be_written_is_told(solution, tmp_path, name):
    place = tmp_path / "missing" / name
    with pytest.raises(MotionFileError, match=r"cannot be written: No such file") as caught:
        solution.save(place)
    assert os.fspath(place) in str(caught.value)
    (tmp_path / name).mkdir()
    with pytest.raises(MotionFileError, match="cannot be written"):
        solution.save(tmp_path / name)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_angles_that_are_not_finite_are_saved_as_such(tmp_path, bad):
    q = smooth_angles(ARM, 4, 0)
    path = path_of(ARM, q)
    q[2, 1] = bad
    file = of_motion(ARM, q, path=path).save(tmp_path / "out.csv")
    of_motion(ARM, q, path=path).save(tmp_path / "out.npz")
    first, _, *rows = file.read_text(encoding="utf-8").splitlines()
    assert json.loads(first[2:])["reasons"] == ["sample 2 has joint angles that are not finite"]
    assert rows[2].split(",")[2] == repr(float(bad))
