"""`.trc` files: round trips, and what is refused."""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from opensim_answers import answer_of_opensim, needs_opensim
from random_recordings import assert_same, recordings

from armik_sym.errors import ArmikError, MotionFileError, MotionFileWarning, UnitError, UnknownNameError
from armik_sym.motion.trc import read_trc, write_trc

GOOD = """PathFileType\t4\t(X/Y/Z)\tx.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
59.94\t59.94\t3\t2\tmm\t59.94\t1\t3
Frame#\tTime\tELB\t\t\tWRI\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2

1\t0.0\t1\t2\t3\t4\t5\t6
2\t0.016683\t1\t2\t3\t\t\t
3\t0.033367\t1\t2\t3\t4\tnan\t6
"""


def read(tmp_path: Path, text: str | bytes):
    file = tmp_path / "x.trc"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_trc(file)


def test_units_gaps_and_rate(tmp_path: Path) -> None:
    r = read(tmp_path, GOOD)
    assert r.names == ("ELB", "WRI")
    assert r.rate == 59.94
    np.testing.assert_array_equal(r.time, [0.0, 0.016683, 0.033367])
    np.testing.assert_array_equal(r.of("ELB"), [[0.001, 0.002, 0.003]] * 3)
    assert np.isnan(r.of("WRI")).all(axis=1).tolist() == [False, True, True]
    assert (r.note, r.source) == ("", "x.trc")


@pytest.mark.parametrize(("unit", "factor"), [("m", 1.0), ("cm", 0.01), ("mm", 0.001)])
def test_every_unit_of_length(tmp_path: Path, unit: str, factor: float) -> None:
    assert read(tmp_path, GOOD.replace("\tmm\t", f"\t{unit}\t")).of("ELB")[0, 1] == 2 * factor


@pytest.mark.parametrize("ends", ["\r\n", "\r", "\n"])
def test_line_ends_marks_and_commas_do_not_matter(tmp_path: Path, ends: str) -> None:
    expected = read(tmp_path, GOOD)
    assert_same(read(tmp_path, b"\xef\xbb\xbf" + GOOD.replace("\n", ends).encode()), expected)
    commas = "\n".join(line + ",,," for line in GOOD.replace("\t", ",").splitlines())
    assert_same(read(tmp_path, commas), expected)


def test_the_path_in_the_first_line_may_have_any_encoding(tmp_path: Path) -> None:
    assert read(tmp_path, GOOD.replace("x.trc", "Müller.trc").encode("latin-1")).names == ("ELB", "WRI")


def test_more_frames_promised_than_there_is_a_warning_and_a_note(tmp_path: Path) -> None:
    with pytest.warns(MotionFileWarning, match=r"x\.trc: the header promises 500 rows"):
        r = read(tmp_path, GOOD.replace("59.94\t3\t2", "59.94\t500\t2"))
    assert len(r) == 3
    assert "promises 500 rows (NumFrames), the file has 3, fewer" in r.note


def test_other_counts_and_rates_than_promised_are_warnings_too(tmp_path: Path) -> None:
    with pytest.warns(MotionFileWarning, match="promises 7 markers"):
        assert "7 markers" in read(tmp_path, GOOD.replace("59.94\t3\t2", "59.94\t3\t7")).note
    with pytest.warns(MotionFileWarning, match="declares 120 Hz"):
        assert read(tmp_path, GOOD.replace("59.94\t59.94\t3", "120\t120\t3")).rate == pytest.approx(
            59.94, rel=1e-3
        )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("PathFileType", "FilePath", "line 1 starts with 'FilePath"),
        ("\tUnits\t", "\tUnit\t", "line 2 names no field 'Units'"),
        ("\tmm\t", "\tinch\t", "line 3: Units is 'inch', allowed: m, cm, mm"),
        ("\tmm\t", "\t\t", "line 3: Units is ''"),
        ("59.94\t59.94\t3", "fast\t59.94\t3", "line 3: DataRate is 'fast'"),
        ("59.94\t3\t2", "59.94\t-3\t2", "line 3: NumFrames is '-3'"),
        ("59.94\t3\t2", "59.94\t99999999999999999999999\t2", "NumFrames is '999"),
        ("WRI", "ELB", "line 4: marker 'ELB' occurs twice"),
        ("\tELB\t\t\tWRI", "\tELB\tWRI\t\t", "line 4 has 'WRI' between"),
        ("\tX2\tY2\tZ2", "\tX2\tY2", "line 5 has 5 names of coordinates"),
        ("\t3\t4\t5\t6\n2", "\t3\t4\tfive\t6\n2", r"line 7 column 'WRI Y' is 'five'"),
        ("\t3\t4\t5\t6\n2", "\t3\t4\t5,0\t6\n2", "line 7 column 'WRI Y' is '5,0'.*decimal point"),
        ("\t3\t4\t5\t6\n2", "\t3\t4\tinf\t6\n2", "is 'inf'"),
        ("\t3\t4\t5\t6\n2", "\t3\t4\t5\t6\t7\n2", "line 7 has 9 cells, expected 8"),
        ("2\t0.016683", "2\t", "line 8 column 'Time' is empty"),
        ("0.016683", "0.05", r"time runs backwards at line 9 \(sample 2\)"),
        ("0.016683", "0.0", "equal to the one before"),
        ("1\t0.0\t1\t2\t3\t4\t5\t6", "1;0.0;1;2;3;4;5;6", "line 7 has 1 cells.*semicolons"),
    ],
)
def test_wrong_files_are_refused_with_line_and_reason(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in GOOD
    with pytest.raises((MotionFileError, UnitError), match=message) as caught:
        read(tmp_path, GOOD.replace(old, new, 1))
    assert "x.trc" in str(caught.value)


def test_a_file_that_is_cut_off_never_gives_a_recording_of_the_last_line(tmp_path: Path) -> None:
    raw = GOOD.encode()
    refused = 0
    for end in range(raw.rindex(b"\t") + 1):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            try:
                assert len(read(tmp_path, raw[:end])) < 3
                assert "fewer" in str(told[0].message)
            except ArmikError:
                refused += 1
    assert refused > end / 2
    with pytest.raises(MotionFileError, match="line 9 has 5 cells, expected 8: the file seems cut off"):
        read(tmp_path, raw[: raw.rindex(b"4\tnan") - 1])


@pytest.mark.parametrize("zero", ["", "\n\n\n", GOOD[: GOOD.index("1\t0.0")]])
def test_files_without_frames_are_refused(tmp_path: Path, zero: str) -> None:
    with pytest.raises(MotionFileError):
        read(tmp_path, zero)


@settings(max_examples=60, deadline=None)
@given(recordings(forbidden="\t"))
def test_round_trip_is_exact(recording) -> None:
    with tempfile.TemporaryDirectory() as folder:
        for unit in ("mm", "m"):
            write_trc(Path(folder) / "x.trc", recording, unit)
            assert_same(read_trc(Path(folder) / "x.trc"), recording)


_ASK_OPENSIM = """
import json, sys
import opensim
table = opensim.TimeSeriesTableVec3(sys.argv[1])
rows = [[[float(cell[k]) for k in range(3)] for cell in
         (table.getRowAtIndex(i)[j] for j in range(table.getNumColumns()))]
        for i in range(table.getNumRows())]
print("RESULT", json.dumps({"names": list(table.getColumnLabels()), "rows": rows,
      "time": list(table.getIndependentColumn()), "unit": table.getTableMetaDataAsString("Units"),
      "rate": table.getTableMetaDataAsString("DataRate")}))
"""


@needs_opensim
def test_opensim_reads_the_same_numbers(tmp_path: Path) -> None:
    recording = read(tmp_path, GOOD)
    write_trc(tmp_path / "y.trc", recording)
    answer = answer_of_opensim(_ASK_OPENSIM, tmp_path / "y.trc")
    assert (answer["names"], answer["unit"]) == (["ELB", "WRI"], "mm")
    assert float(answer["rate"]) == 59.94
    np.testing.assert_array_equal(answer["time"], recording.time)
    np.testing.assert_allclose(answer["rows"], 1000 * recording.position, rtol=1e-15)


def test_names_that_would_be_read_as_something_else_are_not_written(tmp_path: Path) -> None:
    r = read(tmp_path, GOOD)
    for name in ("a\tb", " a", "a\nb"):
        with pytest.raises(MotionFileError, match="cannot be written"):
            write_trc(tmp_path / "y.trc", r.renamed({"ELB": name}))
    with pytest.raises(UnknownNameError, match="cm, m, mm"):
        write_trc(tmp_path / "y.trc", r, "inch")
    with pytest.raises(MotionFileError, match="no folder"):
        write_trc(tmp_path / "none" / "y.trc", r)
