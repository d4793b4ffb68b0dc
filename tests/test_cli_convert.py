"""`armik convert`, and files that are no files of any format."""

from __future__ import annotations

import os
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.errors import ArmikError
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.marker_recording import MarkerRecording


def run(*arguments: object):
    return CliRunner().invoke(app, ["convert", *map(str, arguments)])


@pytest.fixture
def recording(tmp_path: Path) -> MarkerRecording:
    position = np.random.default_rng(0).uniform(-1, 1, (60, 2, 3))
    position[10:13, 1] = np.nan
    r = MarkerRecording(np.arange(60) / 59.94, ("me:ELB", "WRI"), position, declared_rate=59.94)
    ak.write_markers(tmp_path / "in.trc", r)
    return r


def test_markers_keep_names_gaps_rate_and_values(tmp_path: Path, recording: MarkerRecording) -> None:
    for options in ([], ["--nexus"]):
        done = run(tmp_path / "in.trc", tmp_path / "out.csv", *options)
        assert done.exit_code == 0, done.output
        assert "2 markers, 60 samples" in done.output
        back = ak.read_markers(tmp_path / "out.csv")
        assert (back.names, back.rate) == (recording.names, 59.94)
        np.testing.assert_array_equal(back.position, recording.position)
        assert (tmp_path / "out.csv").read_text().startswith("Trajectories") == bool(options)


def test_gaps_are_filled_and_markers_filtered_only_on_request(
    tmp_path: Path, recording: MarkerRecording
) -> None:
    done = run(tmp_path / "in.trc", tmp_path / "out.trc", "--fill", 0.1, "--cutoff", 6)
    assert done.exit_code == 0, done.output
    assert "1 gaps, 3 samples" in done.output
    assert "low-pass filtered at 6 Hz" in done.output
    expected = recording.filled("cubic", 0.1).filtered(6.0)
    np.testing.assert_array_equal(ak.read_markers(tmp_path / "out.trc").position, expected.position)


def test_joint_angles_and_tables(tmp_path: Path) -> None:
    q = np.random.default_rng(0).uniform(-1, 1, (20, 2))
    motion = JointMotion(np.arange(20) / 50, q, ("shoulder", "elbow"))
    ak.write_motion(tmp_path / "a.csv", motion)
    assert run(tmp_path / "a.csv", tmp_path / "b.mot").exit_code == 0
    assert run(tmp_path / "b.mot", tmp_path / "c.sto").exit_code == 0
    assert run(tmp_path / "c.sto", tmp_path / "d.csv", "--joints", "elbow").exit_code == 0
    back = ak.read_motion(tmp_path / "d.csv")
    assert back.joint_names == ("elbow",)
    np.testing.assert_allclose(back.q[:, 0], q[:, 1], rtol=1e-14)


def test_an_arm_becomes_urdf(tmp_path: Path) -> None:
    done = run("human", tmp_path / "human.urdf")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "human.urdf").read_text().count('type="revolute"') == 7


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["in.trc", "in.trc"], "would be overwritten by itself"),
        (["none.trc", "out.csv"], "none.trc: no such file"),
        (["in.trc", "out.doc"], "cannot write markers as '.doc'"),
        (["in.doc", "out.trc"], "cannot read '.doc'"),
        (["in.trc", "out.csv", "--joints", "a"], "--joints does not go with markers"),
        (["in.trc", "out.csv", "--unit", "mm"], "declares its own"),
        (["in.trc", "out.csv", "--cutoff", "99"], "less than half the sampling rate"),
        (["human", "out.urdf", "--fill", "1"], "--fill does not go with an arm"),
        (["path.csv", "out.trc"], "is a hand path"),
    ],
)
def test_what_cannot_be_converted_is_told_in_one_paragraph(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    recording: MarkerRecording,
    arguments: list[str],
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("path.csv").write_text("time [s],x [m],y [m],z [m]\n0,0,0,0\n1,0,0,0\n")
    done = run(*arguments)
    assert done.exit_code == 2
    assert done.stderr.startswith("error: ")
    assert message in " ".join(done.stderr.split())
    assert not Path("out.csv").exists()


READERS: dict[str, Callable[[Path], object]] = {
    ".trc": ak.read_markers,
    ".c3d": ak.read_markers,
    ".csv": ak.read_markers,
    ".bvh": ak.read_bvh,
    ".mot": ak.read_storage,
    ".sto": ak.read_motion,
    ".angles.csv": ak.read_motion,
    ".path.csv": ak.read_path,
}
STARTS = {
    ".trc": b"PathFileType\t4\t(X/Y/Z)\tx.trc\n",
    ".c3d": b"\x02P",
    ".csv": b"Trajectories\n100\n",
    ".bvh": b"HIERARCHY\nROOT a\n{\n",
    ".mot": b"Coordinates\nversion=1\n",
    ".sto": b"Coordinates\nversion=1\n",
    ".angles.csv": b"time [s],a [deg]\n",
    ".path.csv": b"time [s],x [m],y [m],z [m]\n",
}
SIZE = 2**30


def of_one_line(file: Path) -> None:
    file.write_bytes(b"x" * 4_000_000)


def of_noise(file: Path) -> None:
    file.write_bytes(np.random.default_rng(0).bytes(4_000_000))


def of_blank_lines(file: Path) -> None:
    file.write_bytes(b"\n" * 300_000)


def of_a_gigabyte_of_zeros(file: Path) -> None:
    with file.open("wb") as raw:
        raw.write(b"garbage ")
        os.truncate(raw.fileno(), SIZE)


def of_a_gigabyte_below_a_good_start(file: Path) -> None:
    with file.open("wb") as raw:
        raw.write(STARTS["".join(file.suffixes)])
        raw.flush()
        os.truncate(raw.fileno(), SIZE)


@pytest.mark.parametrize("ending", READERS)
@pytest.mark.parametrize(
    "garbage",
    [of_one_line, of_noise, of_blank_lines, of_a_gigabyte_of_zeros, of_a_gigabyte_below_a_good_start],
)
def test_garbage_of_any_size_is_refused_in_little_memory(
    tmp_path: Path, ending: str, garbage: Callable[[Path], None]
) -> None:
    file = tmp_path / f"x{ending}"
    garbage(file)  # files of zeros are sparse: they take no room on the disk
    tracemalloc.start()
    try:
        with pytest.raises(ArmikError, match=r"x\.\w+"):
            READERS[ending](file)
        assert tracemalloc.get_traced_memory()[1] < 60e6
    finally:
        tracemalloc.stop()
