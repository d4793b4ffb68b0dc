"""Text files line by line: garbage of any length is refused early and in little memory."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

import armik_sym as ak
from armik_sym.errors import MotionFileError
from armik_sym.motion.file_kind import file_kind
from armik_sym.motion.numbered_lines import NumberedLines
from armik_sym.motion.read_markers import read_markers

READERS = {"path": ak.read_path, "motion": ak.read_motion, "markers": read_markers, "kind": file_kind}


@pytest.mark.parametrize("reader", READERS.values(), ids=READERS)
@pytest.mark.parametrize("content", [b"a\n", b"\n", b"#\n", b"a,b,c", b"\xff\xfe"])
def test_garbage_is_refused_in_little_memory(
    tmp_path: Path, reader: Callable[[Path], object], content: bytes
) -> None:
    file = tmp_path / "x.csv"
    file.write_bytes(content * (30_000_000 // len(content)))
    tracemalloc.start()
    try:
        if content == b"a\n" and reader is file_kind:
            assert file_kind(file) == "motion"
        else:
            with pytest.raises(MotionFileError, match=r"x\.csv: .*line|x\.csv: "):
                reader(file)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 12_000_000


def test_a_table_takes_the_memory_of_its_numbers(tmp_path: Path) -> None:
    file = tmp_path / "x.csv"
    file.write_text("time [s],x [mm],y [mm],z [mm]\n" + "".join(f"{i},1,2,3\n" for i in range(100_000)))
    tracemalloc.start()
    try:
        path = ak.read_path(file)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(path.time) == 100_000
    # 32 bytes of numbers in a row, in a few copies; as text they took more than 400.
    assert peak < 25_000_000


def test_comments_stand_anywhere_and_may_say_something(tmp_path: Path) -> None:
    file = tmp_path / "x.csv"
    file.write_text("# Note: from a rig\n\n#\ntime [s]\n  # more: ignored\n1\n# note: second\n")
    with NumberedLines(file) as lines:
        assert [lines.next_uncommented() for _ in range(3)] == ["time [s]", "1", None]
        assert lines.number == 7
        assert (lines.said("note:"), lines.said("more:"), lines.said("rate:")) == (
            "from a rig",
            "ignored",
            "",
        )


def test_markers_with_comments_between_their_rows(tmp_path: Path) -> None:
    file = tmp_path / "x.csv"
    file.write_text("time [s],a.x [m],a.y [m],a.z [m]\n0,1,2,3\n# pause\n\n1,1,2,3\n# rate: 1\n")
    recording = read_markers(file)
    assert (recording.n, recording.declared_rate) == (2, 1.0)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_text_of_other_encodings_is_refused(tmp_path: Path, encoding: str) -> None:
    file = tmp_path / "x.trc"
    file.write_bytes("PathFileType\t4".encode(encoding))
    said = "UTF-16 text: save it as UTF-8" if encoding == "utf-16" else "NUL byte"
    with pytest.raises(MotionFileError, match=said):
        read_markers(file)


@pytest.mark.parametrize("number", ["1e-320", "0", "-1", "1e300", "nan"])
def test_rates_that_are_none(tmp_path: Path, number: str) -> None:
    files = {
        "x.csv": f"Trajectories\n{number}\n,,a\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n9,0,1,2,3\n",
        "y.csv": f"# rate: {number}\ntime [s],a.x [m],a.y [m],a.z [m]\n0,1,2,3\n",
        "z.trc": f"PathFileType\t4\nDataRate\tUnits\n{number}\tmm\n"
        "Frame#\tTime\ta\n\t\tX1\tY1\tZ1\n1\t0\t1\t2\t3\n",
        "w.bvh": "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\n"
        f"Frame Time: {number}\n1\n",
    }
    for name, content in files.items():
        (tmp_path / name).write_text(content)
        with pytest.raises(MotionFileError, match=rf"{name}: .*expected .*positive number"):
            read_markers(tmp_path / name, "cm" if name.endswith("bvh") else None)
