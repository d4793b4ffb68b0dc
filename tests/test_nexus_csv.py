"""Marker tables as comma-separated text: exports of Vicon Nexus, and our own form."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from random_recordings import assert_same, recordings

from armik_sym.errors import MotionFileError, MotionFileWarning, UnitError
from armik_sym.motion.file_kind import file_kind
from armik_sym.motion.marker_csv import read_marker_csv, write_marker_csv
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.nexus_csv import read_nexus_csv, write_nexus_csv
from armik_sym.motion.read_markers import read_markers, write_markers

NEXUS = """Trajectories
59.94
,,me:ELB,,,me:WRI,,
Frame,Sub Frame,X,Y,Z,X,Y,Z
,,mm,mm,mm,mm,mm,mm
41,0,1,2,3,4,5,6
42,0,1,2,3,,,
43,0,1,2,3,4,5,6.5

"""
OURS = """# rate: 59.94
# note: made up
time [s],ELB.x [mm],ELB.y [mm],ELB.z [mm]
0.0,1,2,3
0.016683,1,,3
"""


def read(tmp_path: Path, text: str) -> MarkerRecording:
    (tmp_path / "x.csv").write_text("\ufeff" + text, encoding="utf-8")
    return read_markers(tmp_path / "x.csv")


def test_nexus_units_gaps_and_times(tmp_path: Path) -> None:
    r = read(tmp_path, NEXUS)
    assert (r.names, r.rate, r.note) == (("me:ELB", "me:WRI"), 59.94, "")
    np.testing.assert_array_equal(r.time, np.array([40, 41, 42]) / 59.94)
    np.testing.assert_array_equal(r.of("WRI")[[0, 2]], [[0.004, 0.005, 0.006], [0.004, 0.005, 0.0065]])
    assert np.isnan(r.of("WRI")[1]).all()
    assert file_kind(tmp_path / "x.csv") == "markers"


def test_other_sections_of_an_export_are_passed_over_and_named(tmp_path: Path) -> None:
    r = read(tmp_path, "Devices\n1000\n,,EMG\nFrame,Sub Frame,V\n,,mV\n1,0,0.5\n\n" + NEXUS)
    assert len(r) == 3
    assert r.note == "sections not read: Devices"
    with pytest.raises(MotionFileError, match="has Devices but no section 'Trajectories'"):
        read(tmp_path, "Devices\n1000\n,,EMG\n")


def test_what_follows_the_trajectories_is_another_section(tmp_path: Path) -> None:
    assert len(read(tmp_path, NEXUS + "Devices\n1000\n,,EMG\n")) == 3


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("59.94", "fast", "line 2 is 'fast', expected the frame rate"),
        (",,me:ELB,,,me:WRI,,", ",,me:ELB,,,me:ELB,,", "line 3: marker 'me:ELB' occurs twice"),
        (",,me:ELB,,,me:WRI,,", ",,me:ELB,me:WRI", "line 3 has 'me:WRI' out of place"),
        (",,me:ELB,,,me:WRI,,", ",,,,", "line 3 names no markers"),
        ("X,Y,Z,X,Y,Z", "X,Y,Z,X',Y',Z'", "line 4 has 8 cells.*no velocities"),
        ("mm,mm,mm,mm,mm,mm", "mm,mm,mm,m,m,m", "line 5: units are mixed, mm and, for marker 'me:WRI', m"),
        ("mm,mm,mm,mm,mm,mm", "mm,mm,mm,mm,mm,in", "line 5: marker 'me:WRI' has the unit 'in'"),
        ("mm,mm,mm,mm,mm,mm", "mm,mm,mm", "line 5 has units of 3 columns, expected 6"),
        ("42,0,1", "42,0,one", "line 7 column 'me:ELB X' is 'one'"),
        ("42,0,1", "42;0;1", "line 7 has 6 cells, expected 8"),
        ("42,0,1", "41,0,1", "line 7 has frame 41 after frame 41"),
        ("42,0,1", "41.5,0,1", "line 7 has frame 41.5"),
        ("42,0,1", "42,3,1", "sub frame 3"),
        ("43,0,1,2,3,4,5,6.5\n", "43,0,1,2", "line 8 has 4 cells, expected 8: the file seems cut off"),
    ],
)
def test_wrong_exports_are_refused_with_line_and_reason(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in NEXUS
    with pytest.raises((MotionFileError, UnitError), match=message) as caught:
        read(tmp_path, NEXUS.replace(old, new, 1))
    assert "x.csv" in str(caught.value)


def test_exports_without_frames_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MotionFileError, match="followed by no frames"):
        read(tmp_path, NEXUS[: NEXUS.index("41,")])


@settings(max_examples=60, deadline=None)
@given(recordings(forbidden=',"', grid=True))
def test_nexus_round_trip_is_exact_on_its_grid(recording: MarkerRecording) -> None:
    with tempfile.TemporaryDirectory() as folder:
        write_nexus_csv(Path(folder) / "x.csv", recording)
        assert_same(read_nexus_csv(Path(folder) / "x.csv"), recording)


def test_times_between_frames_cannot_be_written_for_nexus(tmp_path: Path) -> None:
    off_grid = MarkerRecording([0.0, 0.01, 0.0249, 0.03], ("a",), np.zeros((4, 1, 3)), declared_rate=100.0)
    with pytest.raises(MotionFileError, match=r"time of sample 2 is .* no whole frame at 100 Hz"):
        write_nexus_csv(tmp_path / "x.csv", off_grid)
    with pytest.raises(MotionFileError, match="single sample"):
        write_nexus_csv(tmp_path / "x.csv", MarkerRecording([0.0], ("a",), np.zeros((1, 1, 3))))


def test_our_form_keeps_rate_and_note(tmp_path: Path) -> None:
    r = read(tmp_path, OURS)
    assert (r.names, r.rate, r.note) == (("ELB",), 59.94, "made up")
    np.testing.assert_array_equal(r.of("ELB")[0], [0.001, 0.002, 0.003])
    assert np.isnan(r.of("ELB")[1]).all()
    assert file_kind(tmp_path / "x.csv") == "markers"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("ELB.y [mm]", "ELB.y", "line 3: column 'ELB.y' has the unit None"),
        ("ELB.y [mm]", "ELB.y [m]", "line 3: units are mixed, m and mm"),
        ("ELB.y [mm]", "ELB.y [in]", "has the unit 'in'"),
        ("ELB.y [mm]", "ELB.x [mm]", "'ELB.x' occurs twice"),
        ("ELB.y [mm]", "WRI.y [mm]", "NAME.x, NAME.y and NAME.z"),
        ("59.94", "fast", "the rate is 'fast'"),
        ("0.016683,1", "0.016683,one", "line 5 column 'ELB.x' is 'one'"),
        ("0.0,1,2,3\n0.016683,1,,3\n", "", "header on line 3 is followed by no samples"),
    ],
)
def test_wrong_tables_are_refused_with_line_and_reason(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    with pytest.raises((MotionFileError, UnitError), match=message):
        read(tmp_path, OURS.replace(old, new, 1))


def test_a_rate_that_contradicts_the_times_is_a_warning(tmp_path: Path) -> None:
    with pytest.warns(MotionFileWarning, match="declares 100 Hz"):
        assert "100 Hz" in read(tmp_path, OURS.replace("59.94", "100")).note


@settings(max_examples=60, deadline=None)
@given(recordings(forbidden="[]"))
def test_our_round_trip_is_exact(recording: MarkerRecording) -> None:
    with tempfile.TemporaryDirectory() as folder:
        for unit in ("mm", "m"):
            write_marker_csv(Path(folder) / "x.csv", recording, unit)
            back = read_marker_csv(Path(folder) / "x.csv")
            assert_same(back, recording)
            assert back.declared_rate == recording.declared_rate


def test_write_markers_goes_by_the_ending(tmp_path: Path) -> None:
    r = read(tmp_path, NEXUS)
    for name, nexus in (("a.csv", False), ("b.csv", True), ("c.trc", False)):
        write_markers(tmp_path / name, r, nexus=nexus)
        assert_same(read_markers(tmp_path / name), r)
    assert (tmp_path / "b.csv").read_text().startswith("Trajectories\n59.94\n")
    with pytest.raises(MotionFileError, match=r"valid are \.trc, \.c3d, \.csv"):
        write_markers(tmp_path / "d.bvh", r)
    with pytest.raises(MotionFileError, match=r"cannot read markers from .\.doc."):
        read_markers(tmp_path / "d.doc")
