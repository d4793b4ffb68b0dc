"""CSV files of hand paths and joint angles: round trips, and what each refusal says."""

from __future__ import annotations

import os
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armik_sym.errors import HandPathError, MotionFileError, UnitError, UnknownNameError
from armik_sym.motion import HandPath, read_joint_angles, read_path, write_joint_angles, write_path
from armik_sym.motion.units import ANGLE_UNITS, LENGTH_UNITS, TIME_UNITS, from_si, is_number, to_si

HEADER = "time [s],x [mm],y [mm],z [mm]"
SAMPLES = "0,100,200,300\n0.1,100,200,310\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("csv")


@pytest.fixture
def read(tmp_path):
    def read_text(content, reader=read_path):
        path = tmp_path / "motion.csv"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return reader(path)

    return read_text


def random_rotations(seed, n):
    return Rotation.from_quat(np.random.default_rng(seed).normal(size=(n, 4))).as_matrix()


times = st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=6, unique=True).map(sorted)
metres = st.floats(-10.0, 10.0)


@given(st.data())
@settings(deadline=None, max_examples=40)
def test_paths_come_back_to_the_last_bit(folder, data):
    time = data.draw(times)
    position = data.draw(st.lists(st.tuples(metres, metres, metres), min_size=len(time), max_size=len(time)))
    seed = data.draw(st.none() | st.integers(0, 2**32 - 1))
    rotation = None if seed is None else random_rotations(seed, len(time))
    path = HandPath(time, position, rotation)
    write_path(folder / "a.csv", path, comment="two\nlines, with comma")
    again = read_path(str(folder / "a.csv"))
    assert np.array_equal(again.time, path.time)
    assert np.array_equal(again.position, path.position)
    assert (again.rotation is None) == (rotation is None)
    if rotation is not None:
        assert np.abs(again.rotation - path.rotation).max() < 2e-15


@given(st.data())
@settings(deadline=None, max_examples=40)
def test_joint_angles_come_back(folder, data):
    time = data.draw(times)
    angle = st.floats(-12.0, 12.0)
    q = np.array(data.draw(st.lists(st.tuples(angle, angle), min_size=len(time), max_size=len(time))))
    for unit, ulps in (("rad", 0), ("deg", 4)):
        write_joint_angles(folder / "q.csv", time, q, ("a", "b"), unit=unit)
        again = read_joint_angles(folder / "q.csv")
        assert again.joint_names == ("a", "b")
        assert np.array_equal(again.time, time)
        assert (np.abs(again.q - q) <= ulps * np.spacing(np.abs(q))).all()


@given(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(["s", "ms", "m", "cm", "mm"]))
def test_decimal_units_are_exact_for_every_float(value, name):
    unit = {**TIME_UNITS, **LENGTH_UNITS}[name]
    text = from_si(value, unit)
    assert float(to_si(text, unit)).hex() == value.hex()


def test_units():
    assert to_si("345.1", LENGTH_UNITS["mm"]) == 0.3451
    assert to_si("180", ANGLE_UNITS["deg"]) == np.pi
    assert from_si(0.3451, LENGTH_UNITS["mm"]) == "345.1"
    assert [is_number(t) for t in ("1", "-.5", "2.", "1e-3", "", "1_0", "nan", "1e999", "1,5", "0x1")] == [
        *[True] * 4,
        *[False] * 6,
    ]


def test_the_file_is_plain_to_read(tmp_path):
    write_path(tmp_path / "a.csv", HandPath([0, 0.5], [[0.1, 0, 0], [0.2, 0, -0.0015]]), comment="A note")
    assert (tmp_path / "a.csv").read_bytes() == (
        b"# A note\ntime [s],x [mm],y [mm],z [mm]\n0.0,100,0,0\n0.5,200,0,-1.5\n"
    )


def test_quaternions_are_written_without_jumps_of_sign(tmp_path):
    angle = np.linspace(0, 2 * np.pi, 50)
    R = Rotation.from_rotvec(angle[:, None] * [0, 0, 1.0]).as_matrix()
    write_path(tmp_path / "a.csv", HandPath(np.arange(50.0), np.zeros((50, 3)), R))
    q = np.loadtxt(tmp_path / "a.csv", delimiter=",", skiprows=1)[:, 4:]
    assert np.abs(np.diff(q, axis=0)).max() < 0.1
    assert q[0, 0] > 0


def test_columns_units_and_line_ends_may_vary(read):
    wanted = read(f"{HEADER}\n{SAMPLES}")
    for text in (
        "\ufeff" + f"# note\n\n{HEADER}\n{SAMPLES}",
        f"{HEADER}\n{SAMPLES}".replace("\n", "\r\n"),
        f"{HEADER}\n{SAMPLES}".replace("\n", "\r").rstrip(),
        'z [cm], y [m] ,time [ms],"x [mm]"\n30,.2,0,100\n# pause\n31,0.2,100,1e2\n\n',
    ):
        path = read(text)
        assert np.array_equal(path.time, wanted.time)
        assert np.array_equal(path.position, wanted.position)


def test_rotation_as_quaternion_or_matrix(read):
    turn = Rotation.from_rotvec([[0.1, 0.2, 0.3], [0.3, 0.2, 0.1]])
    for names, values in (
        (["qw", "qx [-]", "qy [1]", "qz"], turn.as_quat()[:, [3, 0, 1, 2]]),
        ([f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)], turn.as_matrix().reshape(2, 9)),
    ):
        rows = [",".join([t, "0,0,0", *map(repr, row)]) for t, row in zip("01", values.tolist(), strict=True)]
        path = read("\n".join([",".join([HEADER, *names]), *rows]))
        assert np.abs(path.rotation - turn.as_matrix()).max() < 1e-15


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "the file is empty"),
        (b" \n\n", "the file is empty"),
        (b"\xef\xbb\xbf", "only comments|empty"),
        ("# only\n# words\n", "only comments, expected a header row"),
        (f"{HEADER}\n", "header on line 1 is followed by no samples"),
        (SAMPLES, "line 1 holds numbers where the header row should be"),
        (f"{HEADER}\n0,1,2,3\n1,1,zwei,3\n", r"line 3, column 'y' is 'zwei', expected a number"),
        (f"{HEADER}\n0,1,2,3\n1,1,,3\n", "line 3, column 'y' is empty"),
        (f"{HEADER}\n0,1,2,3\n1,NaN,2,3\n", "line 3, column 'x' is 'NaN', expected a finite number"),
        (f"{HEADER}\n0,1,2,3\n1,1e999,2,3\n", "line 3, column 'x' is '1e999'"),
        (f"{HEADER}\n0,1,2,3\n1,1_0,2,3\n", "column 'x' is '1_0'"),
        (f"{HEADER}\n0,1,2,3\n1,1,2\n", "line 3 has 3 cells, expected 4: the file seems cut off"),
        (f"{HEADER}\n0,1,2\n1,1,2,3\n", "line 2 has 3 cells, expected 4, one for each"),
        (f"{HEADER}\n0,1,2,3,\n1,1,2,3\n", "line 2 has 5 cells, expected 4, one for each"),
        (f"{HEADER}\n0,0,1,5,2,5,3,5\n", "line 2 has 8 cells, expected 4: decimal commas"),
        (f"{HEADER},x [mm]\n0,1,2,3,4\n", "column 'x' occurs twice"),
        (f"{HEADER},\n0,1,2,3,4\n", "column 5 of the header is ''"),
        ("time [s],x [mm,y [mm],z [mm]\n0,1,2,3\n", r"column 2 of the header is 'x \[mm'"),
        (f"{HEADER},speed [m/s],w\n0,1,2,3,4,5\n", "unknown columns 'speed', 'w': known are time, x, y, z"),
        ("time [s],x [mm],z [mm]\n0,1,2\n", "no column 'y': a path needs time, x, y, z"),
        (f"{HEADER},qw,qx\n0,1,2,3,1,0\n", "no column 'qy', 'qz'"),
        (f"{HEADER},qw,r11\n0,1,2,3,1,1\n", "rotation twice"),
        (HEADER.replace(",", ";") + "\n0;1;2;3\n", "separates its columns by semicolons: use commas"),
        (HEADER.replace(",", "\t") + "\n0\t1\t2\t3\n", "separates its columns by tabs"),
        (f'{HEADER}\n0,1,"2,3\n', "line 2 is not comma-separated text"),
        (f"{HEADER}\n0,1,2,3\n\0\0\0", "line 3 holds a NUL byte.*binary or damaged"),
        (f"# größe\n{HEADER}\n".encode("latin-1"), "line 1 holds the byte 0xf6, which is not UTF-8"),
        (f"{HEADER}\n{SAMPLES}".encode("utf-16"), "UTF-16 text: save it as UTF-8"),
    ],
)
def test_files_refused(read, content, words):
    with pytest.raises(MotionFileError, match=words) as caught:
        read(content)
    assert "motion.csv" in str(caught.value)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (f"# a\n{HEADER}\n1,0,0,0\n1,0,0,0\n", r"time of line 4 \(sample 1\) is 1\.0 s, equal"),
        (f"{HEADER}\n1,0,0,0\n0,0,0,0\n", r"runs backwards at line 3 \(sample 1\)"),
        (f"{HEADER},qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,0,0,0,0\n", r"quaternion of line 3 \(sample 1\)"),
        (
            f"{HEADER},r11,r12,r13,r21,r22,r23,r31,r32,r33\n0,0,0,0,1,0,0,0,1,0,0,0,-1\n"
            "1,0,0,0,1,0,0,0,1,0,0,0,1\n",
            r"rotation of line 2 \(sample 0\) is a reflection",
        ),
    ],
)
def test_values_that_cannot_be_followed_name_their_line(read, content, words):
    with pytest.raises(HandPathError, match=words) as caught:
        read(content)
    assert "motion.csv" in str(caught.value)


def test_one_sample_is_no_path(read):
    with pytest.raises(ValueError, match=r"motion\.csv.*at least two samples"):
        read(f"{HEADER}\n0,1,2,3\n")


def test_units_are_never_guessed_but_the_fix_is_shown(read):
    with pytest.raises(UnitError) as caught:
        read("# rig\ntime,x,z,y,qw,qx,qy,qz\n0,100,200,300,1,0,0,0\n0.1,100,200,300,1,0,0,0\n")
    message = str(caught.value)
    assert "line 2 declares no unit for time, x, y, z" in message
    assert "\ntime [s],x [mm],z [mm],y [mm],qw,qx,qy,qz\n" in message
    assert "time: s or ms; x, y, z: m or cm or mm" in message


@pytest.mark.parametrize(
    ("header", "samples", "fixed"),
    [
        ("time,x,y,z", "0,.1,.2,.3\n10,.1,.2,.3", "time [ms],x [m],y [m],z [m]"),
        ("time [s],x [cm],y [],z", "0,1,2,3\n1,1,2,3", "time [s],x [cm],y [m],z [m]"),
        ("time,x [m],y [m],z [m]", "0,1,2,3\n.01,1,2,3", "time [s],x [m],y [m],z [m]"),
        ("time,x [m],y [m],z [m]", "0,1,2,3\nq,1,2,3", "time [s],x [m],y [m],z [m]"),
    ],
)
def test_the_header_shown_is_the_one_to_write(read, header, samples, fixed):
    with pytest.raises(UnitError) as caught:
        read(f"{header}\n{samples}\n")
    assert f"\n{fixed}\n" in str(caught.value)


def test_unknown_and_contradicted_units(read):
    with pytest.raises(UnitError, match="line 1: column 'x' has the unit 'inch', allowed: m, cm, mm"):
        read("time [s],x [inch],y [mm],z [mm]\n0,1,2,3\n1,1,2,3\n")
    with pytest.raises(UnitError, match="column 'qw' has the unit 'rad'"):
        read(f"{HEADER},qw [rad],qx,qy,qz\n0,1,2,3,1,0,0,0\n")
    with pytest.raises(UnitError, match=r"motion\.csv: position of line 2 .*write \[mm\] in the header"):
        read(f"{HEADER}\n{SAMPLES}".replace("mm", "m"))


def test_missing_file_folder_and_places_that_cannot_be_written(tmp_path):
    path = HandPath([0, 1], np.zeros((2, 3)))
    with pytest.raises(MotionFileError, match=r"none\.csv: no such file"):
        read_path(tmp_path / "none.csv")
    with pytest.raises(MotionFileError, match="is a folder, expected a file"):
        read_path(tmp_path)
    with pytest.raises(MotionFileError, match="cannot be read"):
        read_path("nul\0byte.csv")
    with pytest.raises(MotionFileError, match="cannot be written: there is no folder"):
        write_path(tmp_path / "no" / "a.csv", path)
    with pytest.raises(MotionFileError, match="cannot be written"):
        write_path(tmp_path, path)


@pytest.mark.skipif(sys.platform == "win32" or not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root")
def test_unreadable_file(tmp_path):
    (tmp_path / "a.csv").write_text(HEADER)
    (tmp_path / "a.csv").chmod(0)
    with pytest.raises(MotionFileError, match="cannot be read: Permission denied"):
        read_path(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("content", "error", "words"),
    [
        ("time [s]\n0\n", MotionFileError, "at least one joint"),
        ("elbow [deg]\n0\n", MotionFileError, "need 'time'"),
        ("time [s],no good [deg]\n0,1\n", MotionFileError, "line 1: joint name 'no good' is not a plain"),
        ("time [s],x [mm]\n0,1\n", UnitError, "unit of length.*read_path"),
        ("time [s],elbow [grad]\n0,1\n", UnitError, "'grad', allowed: rad, deg"),
        ("time,elbow\n0,1\n", UnitError, r"(?s)declares no unit.*\ntime \[s\],elbow \[rad\]\n.*rad or deg"),
        ("time,elbow\n0,90\n", UnitError, r"(?s)\ntime \[s\],elbow \[deg\]\n"),
        ("time [s],elbow [rad]\n0,90\n", UnitError, r"reaches 90 rad.*write 'elbow \[deg\]' in line 1"),
        ("time [s],elbow [deg]\n0,x\n", MotionFileError, "line 2, column 'elbow' is 'x'"),
        ("time [s],elbow [deg]\n0,1\n0,2\n", HandPathError, r"motion.csv: time of line 3 \(sample 1\)"),
    ],
)
def test_joint_files_refused(read, content, error, words):
    with pytest.raises(error, match=words):
        read(content, read_joint_angles)


def test_joint_angles_as_written(tmp_path):
    write_joint_angles(tmp_path / "q.csv", [0, 1], np.radians([[0], [90]]), ["elbow"], comment="note")
    assert (tmp_path / "q.csv").read_text() == "# note\ntime [s],elbow [deg]\n0.0,0.0\n1.0,90.0\n"
    with pytest.raises(UnknownNameError, match="unknown angle unit 'turns': valid are deg, rad"):
        write_joint_angles(tmp_path / "q.csv", [0], [[0]], ["elbow"], unit="turns")
    with pytest.raises(HandPathError, match="q of sample 0"):
        write_joint_angles(tmp_path / "q.csv", [0], [[np.nan]], ["elbow"])
