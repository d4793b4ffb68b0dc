"""`armik record`: what it writes, says and returns, and how it ends."""

from __future__ import annotations

import contextlib
import itertools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from device_recorders import simulated
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.cli.device_recording import device_motion, is_device_recording
from armik_sym.cli.recorded import from_device
from armik_sym.device.calibration import save_calibration
from armik_sym.device.recording import read_recording
from armik_sym.device.simulator import Faults, SimulatedDevice, serve_socket, true_calibration

ROOT = Path(ak.__file__).parents[1]


def command(*arguments: object, stderr: int = subprocess.PIPE) -> subprocess.Popen[str]:
    environment = {**os.environ, "TERM": "xterm", "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error"}
    return subprocess.Popen(
        [sys.executable, "-m", "armik_sym", "record", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
        env=environment,
    )


def run(*arguments: object):
    return CliRunner().invoke(app, ["record", *map(str, arguments)])


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_sigterm_end_cleanly(number: int, tmp_path: Path) -> None:
    device, file = simulated(), tmp_path / "a.armikrec"
    arm = ak.catalog.ehmcs()
    calibration = save_calibration(true_calibration(device, arm), tmp_path / "device.toml")
    with serve_socket(device) as served:
        extra = ("--calibration", calibration, "--live", "swivel,endpoint")
        process = command("--port", served.port, "--out", file, *extra)
        until = time.monotonic() + 60.0
        while len(served.truth.sent) < 700 and time.monotonic() < until:
            time.sleep(0.02)
        process.send_signal(number)
        said, noted = process.communicate(timeout=30)
    assert process.returncode == 0, noted
    recording = read_recording(file)
    assert recording.complete
    assert (recording.lost, recording.damaged, recording.gaps) == (0, 0, ())
    assert f"{file}: {recording.n:,} samples" in said
    assert "lost            0 samples" in said
    assert "samples/s" in noted
    assert "device [deg]  shoulder_abduction" in noted
    assert "human [deg]   shoulder_flexion" in noted
    assert "endpoint [mm]  x " in noted
    table = ak.read_motion(tmp_path / "a.csv")
    assert table.n == recording.n
    # What the arm really did, through what the sensors saw of it.
    path = from_device(file, "ehmcs", None).path
    true = ak.compile(arm, backend="vm").position(device.true_angles(np.round(path.time * 500)))
    assert np.abs(path.position - true).max() < 3e-3
    assert path.rotation is not None
    assert device_motion(file).n == recording.n
    done = CliRunner().invoke(app, ["convert", str(file), str(tmp_path / "again.mot")])
    assert done.exit_code == 0, done.output
    np.testing.assert_allclose(ak.read_motion(tmp_path / "again.mot").q, table.q, atol=1e-9)


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_in_a_terminal_the_lines_change_in_place(tmp_path: Path) -> None:
    device, file = simulated(), tmp_path / "a.armikrec"
    calibration = save_calibration(true_calibration(device), tmp_path / "device.toml")
    master, slave = os.openpty()
    with serve_socket(device) as served:
        extra = ("--seconds", 1.0, "--calibration", calibration)
        process = command("--port", served.port, "--out", file, *extra, stderr=slave)
        os.close(slave)
        seen = b""
        with contextlib.suppress(OSError):  # The end of a terminal is an error on Linux.
            while data := os.read(master, 4096):
                seen += data
        said, _ = process.communicate(timeout=30)
        os.close(master)
    assert process.returncode == 0, seen
    text = seen.decode()
    assert 1 <= text.count("samples/s") <= 14
    assert "\x1b[" in text
    assert "shoulder_abduction" in text
    assert "\x1b[" not in said


def test_losses_are_exit_code_1(tmp_path: Path) -> None:
    file = tmp_path / "a.armikrec"
    with serve_socket(simulated(Faults(damaged_bytes=0.01))) as served:
        done = run("--port", served.port, "--out", file, "--seconds", "1")
    assert done.exit_code == 1, done.output
    recording = read_recording(file)
    assert recording.lost > 10
    assert f"lost            {recording.lost:,} samples" in done.output
    assert f"damaged         {recording.damaged:,} pieces" in done.output


def test_errors_are_exit_code_2(tmp_path: Path) -> None:
    file = tmp_path / "a.armikrec"
    done = run("--port", "loop://", "--out", file, "--wait", "0.2")
    assert done.exit_code == 2
    assert "error: loop://: no sample within 0.2 s: no byte came" in done.output
    for arguments, words in (
        (("--out", tmp_path / "a.csv"), "recordings end in .armikrec"),
        (("--out", file, "--live", "swivel"), "--live swivel needs angles: give --calibration"),
        (("--out", file, "--arm", "ehmcs"), "--arm is for angles: give --calibration"),
        (("--out", file, "--baud", "0"), "baud is 0"),
        (("--out", file, "--live", "speed"), "valid are swivel, endpoint"),
        (("--out", file, "--calibration", tmp_path / "no.toml"), "no.toml: no such file"),
    ):
        done = run("--port", "loop://", *arguments)
        assert done.exit_code == 2
        assert words in done.output
    (tmp_path / "a.csv").write_text("precious", encoding="utf-8")
    done = run("--port", "loop://", "--out", file, "--calibration", tmp_path / "no.toml")
    assert "a.csv: exists already" in done.output
    assert [each.name for each in tmp_path.iterdir()] == ["a.csv"]


def captured(folder: Path) -> tuple[SimulatedDevice, list[str]]:
    """A second of a device's bytes, as `cat` writes them to a file, and the calibration to read them with."""
    device, file = simulated(), folder / "a.armikrec"
    file.write_bytes(b"".join(frame.data for frame in itertools.islice(device.frames(), 502)))
    calibration = save_calibration(true_calibration(device, ak.catalog.ehmcs()), folder / "device.toml")
    return device, [str(file), "--calibration", str(calibration)]


def test_a_recording_is_converted_and_solved(tmp_path: Path) -> None:
    device, words = captured(tmp_path)
    done = CliRunner().invoke(app, ["convert", words[0], str(tmp_path / "a.csv"), *words[1:]])
    assert done.exit_code == 0, done.output
    angles = ak.read_motion(tmp_path / "a.csv")
    assert np.abs(angles.q - device.true_angles(np.arange(angles.n))).max() < np.radians(0.5)
    done = CliRunner().invoke(app, ["solve", *words, "--backend", "vm", "--out", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    arm = ak.catalog.ehmcs()
    solved = ak.read_motion(tmp_path / "out" / "a_solution.csv", arm.joint_names)
    hand = ak.compile(arm, backend="vm").position
    true = device.true_angles(np.round(solved.time * 500))
    assert np.abs(hand(solved.q) - hand(true)).max() < 3e-3
    compared = ["compare", *words, "--method", "swivel-constant", "--out", str(tmp_path / "compared")]
    done = CliRunner().invoke(app, compared)
    assert done.exit_code == 0, done.output
    assert "elbow position [mm]" in done.output


def test_wrong_use_of_recordings_by_other_commands(tmp_path: Path) -> None:
    _, (file, *calibration) = captured(tmp_path)
    out = ("--out", str(tmp_path / "out"))
    path = tmp_path / "path.csv"
    path.write_text("time [s],x [mm],y [mm],z [mm]\n0,300,0,0\n")
    for words, said in (
        (["convert", file, "a.trc", *calibration], "written as .csv, .mot or .sto"),
        (["convert", file, "a.csv", "--fill", "1"], "--fill does not go with a recording of a device"),
        (["convert", file, str(tmp_path / "b.csv")], "holds no calibration"),
        (["convert", str(tmp_path / "b.armikrec"), "b.csv"], "no such file"),
        (["solve", file, *out], "holds no calibration"),
        (["solve", str(path), *calibration, *out], "--calibration is for recordings"),
        (["solve", file, *calibration, "--arm", "human", *out], "angles of these names are others"),
        (["solve", file, *calibration, "--side", "left", *out], "--side does not go with"),
        (["compare", file, *out], "holds no calibration"),
    ):
        done = CliRunner().invoke(app, words)
        assert (done.exit_code, said in done.output) == (2, True), done.output


def test_recordings_are_recognised_by_their_ending() -> None:
    assert is_device_recording(Path("x.ARMIKREC"))
    assert not is_device_recording(Path("x.csv"))
