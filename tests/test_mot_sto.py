"""OpenSim's `.mot` and `.sto` files: round trips, refusals, and OpenSim's own reader."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from opensim_answers import answer_of_opensim, needs_opensim
from random_recordings import COORDINATES, names
from solutions import of_motion

from armik_sym.arm.catalog import ehmcs
from armik_sym.errors import (
    ArmikError,
    HandPathError,
    MotionFileError,
    MotionFileWarning,
    OptionError,
    UnitError,
    UnknownNameError,
)
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.read_motion import read_motion, write_motion
from armik_sym.motion.storage import read_storage, write_storage
from armik_sym.motion.storage_table import StorageTable

GOOD = """Coordinates
version=1
nRows=2
nColumns=4
inDegrees=yes

Units are S.I. units (second, meters, Newtons, ...)

endheader
time\tshoulder\telbow\tbase_tx
0.0\t10\t90\t0.5
0.01\t11\t nan\t0.6
"""


def read(tmp_path: Path, text: str, name: str = "x.mot") -> StorageTable:
    (tmp_path / name).write_text(text)
    return read_storage(tmp_path / name)


def test_columns_units_and_gaps(tmp_path: Path) -> None:
    table = read(tmp_path, GOOD)
    assert (table.title, table.in_degrees, table.note) == ("Coordinates", True, "")
    assert table.names == ("shoulder", "elbow", "base_tx")
    np.testing.assert_array_equal(table.of("elbow"), [90.0, np.nan])
    motion = table.joint_motion(["shoulder"])
    np.testing.assert_array_equal(motion.q[:, 0], np.array([10.0, 11.0]) * (math.pi / 180))
    assert table.joint_motion({"sh": "shoulder"}).joint_names == ("sh",)
    with pytest.raises(HandPathError, match=r"x\.mot: q of sample 1"):
        table.joint_motion(["elbow"])
    with pytest.raises(UnknownNameError, match="base_tx, elbow, shoulder"):
        table.of("wrist")


def test_translations_are_left_out_of_joint_angles_and_this_is_said(tmp_path: Path) -> None:
    table = read(tmp_path, GOOD.replace(" nan", "91"))
    with pytest.warns(MotionFileWarning, match="left out, by their names translations: base_tx"):
        assert table.joint_motion().joint_names == ("shoulder", "elbow")


def test_radians_and_silence_about_units(tmp_path: Path) -> None:
    in_radians = read(tmp_path, GOOD.replace("=yes", "=no"))
    np.testing.assert_array_equal(in_radians.joint_motion(["shoulder"]).q[:, 0], [10.0, 11.0])
    silent = read(tmp_path, GOOD.replace("inDegrees=yes\n", ""))
    assert silent.in_degrees is None
    with pytest.raises(UnitError, match="does not say whether angles are in degrees"):
        silent.joint_motion(["shoulder"])


@pytest.mark.parametrize(
    "text",
    [
        GOOD.replace("\t", ",").replace("\n", ",,\n"),
        "\n".join(
            " ".join(line.split()) if i > 9 else line for i, line in enumerate(GOOD.splitlines())
        ).replace("time\tshoulder\telbow\tbase_tx", "time shoulder elbow base_tx"),
        GOOD.replace("nRows=2\nnColumns=4", "datacolumns 4\ndatarows 2"),
        GOOD.replace("version=1\nnRows=2\nnColumns=4", "DataType=double\nversion=3\nOpenSimVersion=4.5"),
    ],
    ids=["commas", "blanks", "SIMM", "version 3"],
)
def test_other_forms_of_the_same_table(tmp_path: Path, text: str) -> None:
    expected, table = read(tmp_path, GOOD), read(tmp_path, text)
    assert (table.names, table.in_degrees) == (expected.names, True)
    np.testing.assert_array_equal(table.values, expected.values)


def test_other_counts_than_promised_are_warnings_and_notes(tmp_path: Path) -> None:
    with pytest.warns(MotionFileWarning) as told:
        table = read(tmp_path, GOOD.replace("nRows=2", "nRows=250").replace("nColumns=4", "nColumns=9"))
    assert len(told) == 2
    assert "promises 250 rows (nRows), the file has 2" in table.note
    assert "promises 9 columns (nColumns) and names 4" in table.note


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("endheader", "end", "no line 'endheader' in 12 lines"),
        ("nRows=2", "nRows=two", "line 3: nrows is 'two'"),
        ("=yes", "=maybe", "line 5: inDegrees is 'maybe', expected yes or no"),
        ("version=1", "DataType=Vec3", "line 2: DataType is 'Vec3'"),
        ("time\t", "t\t", "line 10 starts with 't', expected 'time'"),
        ("time\tshoulder\telbow\tbase_tx", "time;shoulder;elbow;base_tx", "semicolons"),
        ("\telbow", "\tshoulder", "line 10: column 'shoulder' occurs twice"),
        ("\t90\t", "\tninety\t", "line 11 column 'elbow' is 'ninety'"),
        ("\t90\t", "\t90,5\t", "is '90,5', expected a number with a decimal point"),
        ("\t90\t", "\t", "line 11 has 3 cells, expected 4, one for each"),
        ("0.01\t11\t nan\t0.6\n", "0.01\t11\t", "line 12 has 3 cells, expected 4: the file seems cut off"),
        ("0.01", "0.0", r"time of line 12 \(sample 1\) is 0.0 s, equal"),
        ("0.0\t10\t90\t0.5\n0.01\t11\t nan\t0.6\n", "", "line 10 and is followed by no rows"),
        ("\t90\t", "\t1e999\t", "is '1e999'"),
    ],
)
def test_wrong_files_are_refused_with_line_and_reason(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in GOOD
    with pytest.raises((MotionFileError, UnitError), match=message) as caught:
        read(tmp_path, GOOD.replace(old, new, 1))
    assert "x.mot" in str(caught.value)


def test_an_endless_header_is_refused_early(tmp_path: Path) -> None:
    with pytest.raises(MotionFileError, match="line 1001 is still header"):
        read(tmp_path, "nothing here\n" * 5000)


def test_loads_are_no_angles(tmp_path: Path) -> None:
    with pytest.raises(UnitError, match="'shoulder_moment' is a load"):
        read(tmp_path, GOOD.replace("shoulder", "shoulder_moment")).joint_motion(["shoulder_moment"])


@st.composite
def tables(draw: st.DrawFn) -> StorageTable:
    labels = tuple(draw(names(forbidden=" \t,;").filter(lambda some: "time" not in map(str.lower, some))))
    n = draw(st.integers(1, 6))
    time = np.cumsum(draw(st.lists(st.floats(1e-4, 10.0), min_size=n, max_size=n)))
    cell = st.one_of(COORDINATES, st.just(math.nan), st.floats(-1e6, 1e6))
    values = draw(st.lists(cell, min_size=n * len(labels), max_size=n * len(labels)))
    degrees = draw(st.sampled_from([True, False, None]))
    return StorageTable(time, labels, np.array(values).reshape(n, -1), degrees, "Any title")


def test_names_that_would_be_read_as_something_else_are_not_written(tmp_path: Path) -> None:
    for name in ("a b", "a\tb", "a,b", "a;b", "Time"):
        with pytest.raises(MotionFileError, match="cannot be written"):
            write_storage(tmp_path / "x.sto", StorageTable([0.0], (name,), [[1.0]]))
    with pytest.raises(MotionFileError, match="endheader"):
        write_storage(tmp_path / "x.sto", StorageTable([0.0], ("a",), [[1.0]]), "endheader")


@settings(max_examples=60, deadline=None)
@given(tables())
def test_round_trip_is_exact(table: StorageTable) -> None:
    with tempfile.TemporaryDirectory() as folder:
        for ending in ("mot", "sto"):
            file = Path(folder) / f"x.{ending}"
            write_storage(file, table, "a comment\nwith inDegrees maybe")
            back = read_storage(file)
            assert (back.names, back.in_degrees, back.title) == (table.names, table.in_degrees, "Any title")
            np.testing.assert_array_equal(back.time, table.time)
            np.testing.assert_array_equal(back.values, table.values)


@pytest.mark.parametrize("ending", [".mot", ".sto", ".csv"])
@pytest.mark.parametrize("unit", ["deg", "rad"])
def test_joint_angles_survive(tmp_path: Path, ending: str, unit: str) -> None:
    rng = np.random.default_rng(3)
    motion = JointMotion(np.arange(20) / 59.94, rng.uniform(-3, 3, (20, 2)), ("shoulder", "elbow"))
    write_motion(tmp_path / f"x{ending}", motion, unit)
    back = read_motion(tmp_path / f"x{ending}")
    assert back.joint_names == motion.joint_names
    np.testing.assert_array_equal(back.time, motion.time)
    np.testing.assert_allclose(back.q, motion.q, rtol=0 if unit == "rad" else 1e-15, atol=0)
    chosen = read_motion(tmp_path / f"x{ending}", {"e": "elbow"})
    assert chosen.joint_names == ("e",)
    np.testing.assert_array_equal(chosen.q[:, 0], back.q[:, 1])


def test_angles_without_time_and_unit_need_both_from_the_caller(tmp_path: Path) -> None:
    file = tmp_path / "x.csv"
    file.write_text("\ufeffElbow flexion-extension,Wrist\n90,1\n180,2\n", encoding="utf-8")
    motion = read_motion(file, {"elbow": "Elbow flexion-extension"}, rate=50.0, unit="deg")
    np.testing.assert_allclose(motion.q[:, 0], [math.pi / 2, math.pi])
    np.testing.assert_array_equal(motion.time, [0.0, 0.02])
    with pytest.raises(OptionError, match="belong together"):
        read_motion(file, rate=50.0)
    with pytest.raises(ArmikError):
        read_motion(file)
    with pytest.raises(UnknownNameError, match="Wrist"):
        read_motion(file, ["Knee"], rate=50.0, unit="deg")
    with pytest.raises(MotionFileError, match="valid are"):
        read_motion(tmp_path / "x.doc")


@pytest.fixture
def solution():
    rng = np.random.default_rng(1)
    arm = ehmcs()
    q = arm.rom.middle + 0.1 * np.cumsum(rng.uniform(-0.1, 0.1, (30, arm.dof)), axis=0)
    return of_motion(arm, q)


@pytest.mark.parametrize("ending", ["mot", "sto"])
def test_a_solution_is_written_and_read_again(tmp_path: Path, solution, ending: str) -> None:
    motion = read_motion(solution.save(tmp_path / f"x.{ending}"))
    assert motion.joint_names == solution.arm.joint_names
    np.testing.assert_array_equal(motion.time, solution.time)
    np.testing.assert_allclose(motion.q, solution.q, rtol=1e-15)


_ASK_OPENSIM = """
import json, sys
import opensim
table, storage = opensim.TimeSeriesTable(sys.argv[1]), opensim.Storage(sys.argv[1])
columns = range(table.getNumColumns())
rows = [[float(table.getRowAtIndex(i)[j]) for j in columns] for i in range(table.getNumRows())]
print("RESULT", json.dumps({
    "names": list(table.getColumnLabels()), "time": list(table.getIndependentColumn()), "rows": rows,
    "in_degrees": table.getTableMetaDataAsString("inDegrees"), "storage": storage.isInDegrees(),
    "size": storage.getSize(),
}))
"""


@needs_opensim
@pytest.mark.parametrize("ending", ["mot", "sto"])
def test_opensim_reads_the_same_numbers(tmp_path: Path, solution, ending: str) -> None:
    file = solution.save(tmp_path / f"x.{ending}")
    answer = answer_of_opensim(_ASK_OPENSIM, file)
    assert answer["names"] == list(solution.arm.joint_names)
    assert (answer["in_degrees"], answer["storage"], answer["size"]) == ("yes", True, 30)
    np.testing.assert_array_equal(answer["time"], solution.time)
    np.testing.assert_allclose(np.deg2rad(answer["rows"]), solution.q, rtol=1e-14)
