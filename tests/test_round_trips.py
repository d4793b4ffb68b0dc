"""What is written is read again as it was, or refused when it is written: names and values of every kind."""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armik_sym.errors import ArmikError, HandPathError, MotionFileError, MotionFileWarning, RecordingError
from armik_sym.motion.bvh import read_bvh, write_bvh
from armik_sym.motion.bvh_motion import BvhJoint, BvhMotion
from armik_sym.motion.file_kind import file_kind
from armik_sym.motion.joint_csv import write_joint_angles
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.read_markers import read_markers, write_markers
from armik_sym.motion.storage import read_storage, write_storage
from armik_sym.motion.storage_table import StorageTable

# Characters that end lines or cells, are white space, invisible, not ASCII, or no character at all.
CHARACTERS = "\t\n\r\v\f\x1c\x85\u2028\0 ,;:#\"'[]{}=.-\ufeff\xa0\u3000é漢\U0001f600\x7f\ud800a1"
WORDS = ("time", "nan", ".x", "_end", "note:", "X1", "endheader", "nRows=")
ODD = st.sampled_from([*CHARACTERS, *WORDS])
NAMES = st.lists(ODD, min_size=1, max_size=4).map("".join)
NUMBERS = st.one_of(
    st.floats(-20, 20), st.floats(-1e99, 1e99), st.sampled_from([0.0, -0.0, 5e-324, 1e38, 4e38, 1 / 3])
)
STEPS = st.one_of(st.floats(1e-9, 1e6), st.sampled_from([1 / 59.94, 0.01, 1e-310, 1e15, 1e200]))


@st.composite
def anything(draw: st.DrawFn) -> MarkerRecording | None:
    names = draw(st.lists(NAMES, min_size=1, max_size=3))
    times = np.cumsum(draw(st.lists(STEPS, min_size=1, max_size=3)))
    rate = draw(st.sampled_from([None, 59.94, 29.97]))
    time = times if rate is None else np.arange(len(times)) / rate
    count = len(time) * len(names) * 3
    position = np.array(draw(st.lists(NUMBERS, min_size=count, max_size=count)))
    position[: 3 * draw(st.integers(0, 2))] = np.nan
    note = draw(st.sampled_from(["", "a\nb", "rate: 3", "x\u2028y"]))
    try:
        return MarkerRecording(
            time, tuple(names), position.reshape(len(time), -1, 3), note, declared_rate=rate
        )
    except (RecordingError, ArmikError):
        return None


@pytest.mark.parametrize("ending", [".trc", ".csv", ".c3d", "nexus.csv"])
@given(recording=anything())
@settings(max_examples=60)
def test_markers_survive_or_are_refused(ending: str, recording: MarkerRecording | None) -> None:
    if recording is None:
        return
    if ending == ".c3d":
        pytest.importorskip("ezc3d", reason="ezc3d is not installed (extra c3d)")
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        file = Path(folder) / f"x{ending}"
        try:
            write_markers(file, recording, nexus=ending == "nexus.csv")
        except MotionFileError as error:
            assert str(file) in str(error)  # noqa: PT017
            return
        back = read_markers(file)
        assert (back.names, file_kind(file)) == (recording.names, "markers")
        single = ending == ".c3d"
        # 32-bit numbers: seven digits, the smallest 1e-45 of the file's millimetres.
        np.testing.assert_allclose(
            back.position, recording.position, rtol=1e-6 if single else 0, atol=2e-48 if single else 0
        )
        if ending in (".trc", ".csv"):
            np.testing.assert_array_equal(back.time, recording.time)
        if recording.declared_rate is not None:
            assert back.rate == recording.declared_rate


@given(NAMES, st.lists(NUMBERS, min_size=2, max_size=2), st.sampled_from([True, False, None]), NAMES, NAMES)
@settings(max_examples=150)
def test_tables_survive_or_are_refused(
    name: str, values: list[float], degrees: bool | None, title: str, comment: str
) -> None:
    try:
        table = StorageTable([0.0, 1.0], (name,), np.array(values)[:, None], degrees, title)
    except RecordingError:
        return
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "x.sto"
        try:
            write_storage(file, table, comment)
        except MotionFileError:
            return
        back = read_storage(file)
        assert (back.names, back.in_degrees) == (table.names, degrees)
        np.testing.assert_array_equal(back.values, table.values)


@pytest.mark.parametrize("field", ["inDegrees=no", "nRows=7", "DataType=Vec3", "datacolumns 4"])
def test_titles_and_comments_that_would_be_read_as_fields_are_refused(tmp_path: Path, field: str) -> None:
    for title, comment in ((field, ""), ("fine", f"first\n{field}")):
        with pytest.raises(MotionFileError, match="a field of the header"):
            write_storage(tmp_path / "x.sto", StorageTable([0.0], ("a",), [[1.0]], True, title), comment)


@given(NAMES, NAMES, NUMBERS, STEPS)
@settings(max_examples=100)
def test_skeletons_survive_or_are_refused(root: str, child: str, value: float, step: float) -> None:
    joints = (
        BvhJoint(root, -1, (0.0, 0.0, 0.0), ("Xposition", "Zrotation")),
        BvhJoint(child, 0, (value, 0.0, 1.0), ("Yrotation",)),
    )
    try:
        motion = BvhMotion(joints, step, np.array([[value, 1.0, 2.0]]))
    except RecordingError:
        return
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionFileWarning)
        file = Path(folder) / "x.bvh"
        try:
            write_bvh(file, motion)
        except MotionFileError:
            return
        back = read_bvh(file)
    assert (back.joints, back.frame_time) == (joints, step)
    np.testing.assert_array_equal(back.values, motion.values)


def test_a_joint_called_like_the_times_is_refused(tmp_path: Path) -> None:
    with pytest.raises(HandPathError, match="'time' cannot be written"):
        write_joint_angles(tmp_path / "x.csv", [0.0, 1.0], [[1.0], [2.0]], ["time"])
