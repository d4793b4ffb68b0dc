"""`armik simulate-device`: what it serves, says and writes."""

from __future__ import annotations

import io
import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import serial
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.cli.live_line import LiveLine
from armik_sym.device.calibration import load_calibration
from armik_sym.device.protocol import FrameParser, Sample
from armik_sym.device.simulator import Faults, Jump, SimulatedDevice, Stuck, sensors_of, true_calibration

ROOT = Path(ak.__file__).parents[1]
posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals")


class Simulator:
    """The command in a process of its own."""

    def __init__(self, *arguments: object) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "armik_sym", "simulate-device", *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error"},
        )
        # A command that never says its port must not hang the tests.
        self._alarm = threading.Timer(60.0, self.process.kill)
        self._alarm.start()
        assert self.process.stdout is not None
        self.said = []
        for line in self.process.stdout:
            self.said.append(line.strip())
            if line.startswith("record it:"):
                break
        self.port = next((line.split()[1] for line in self.said if line.startswith("port:")), "")

    def end(self) -> tuple[int, str]:
        out, error = self.process.communicate()
        self._alarm.cancel()
        assert error == ""
        return self.process.returncode, out

    def samples(self, n: int) -> list[Sample]:
        parser, found, deadline = FrameParser(), [], time.monotonic() + 30
        with serial.serial_for_url(self.port, timeout=0.1) as port:
            while len(found) < n and time.monotonic() < deadline:
                data = port.read(max(1, port.in_waiting))
                found += [frame for frame in parser.feed(data) if isinstance(frame, Sample)]
        return found[:n]


@posix
@pytest.mark.parametrize("request_to_end", [signal.SIGINT, signal.SIGTERM])
def test_a_request_to_end_leaves_no_port(tmp_path: Path, request_to_end: signal.Signals) -> None:
    link = tmp_path / "port"
    simulator = Simulator("--link", link, "--rate", 200, "--speed", 5)
    assert simulator.port == str(link)
    assert len(simulator.samples(100)) == 100
    simulator.process.send_signal(request_to_end)
    code, said = simulator.end()
    assert code == 0
    assert "stopped" in said
    assert "samples sent" in said
    assert not link.is_symlink()


def test_it_sends_the_device_it_was_asked_for_and_ends_by_itself(tmp_path: Path) -> None:
    arm, task = ak.catalog.ehmcs(), ak.load_task("playing_ball").measured
    motion, table = tmp_path / "motion.csv", tmp_path / "device_9.toml"
    backwards = ak.JointMotion(task.time, task.q[:, ::-1], task.joint_names[::-1])
    ak.write_motion(motion, backwards)
    simulator = Simulator(
        motion, "--joints", 5, "--rate", 100, "--speed", 0, "--seconds", 2, "--socket", "127.0.0.1:0",
        "--seed", 3, "--device-id", 9, "--noise", 2, "--stuck", "2:0.5:1", "--jump", "3:1:-200",
        "--calibration", table,
    )  # fmt: skip
    got = simulator.samples(200)
    code, said = simulator.end()
    assert code == 0
    assert "2.0 s, 200 samples sent" in said
    assert any("3 potentiometers and 2 encoders" in line for line in simulator.said)

    read = ak.read_motion(motion, list(arm.joint_names[:5]))
    expected = SimulatedDevice(
        read,
        sensors_of(arm, 5, seed=9, noise=2.0),
        device_id=9,
        rate=100,
        seed=3,
        faults=Faults(stuck=(Stuck(2, 0.5, 1.0),), jumps=(Jump(3, 1.0, -200),)),
    )
    iterator = expected.samples()
    assert got == [next(iterator) for _ in range(200)]

    calibration = load_calibration(table)
    assert calibration.device_id == 9
    calibration.check_device(expected.info)
    found = calibration.angles(np.array([sample.counts for sample in got]))
    truth = expected.true_angles(range(200))
    assert np.abs(found - truth)[:50].max() < np.deg2rad(1.0)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["dancing"], "no motion 'dancing'.*brushing"),
        (["--arm", "alfaiz"], "brushing: unknown column .*choose another --arm"),
        (["--joints", "9"], "9 joints"),
        (["--rate", "0"], "rate of 0"),
        (["--seconds", "0"], "--seconds"),
        (["--speed", "-1"], "speed is -1"),
        (["--damage", "2"], "damaged_bytes is 2"),
        (["--close-at", "1;2"], "--close-at '1;2'.*5,12.5"),
        (["--silent", "1:2:3"], "--silent '1:2:3'.*FROM"),
        (["--stuck", "1.5:2"], "--stuck.*1.5 is no whole number"),
        (["--jump", "1:2"], "--jump '1:2'.*CHANNEL:AT:COUNTS"),
        (["--jump", "8:2:5"], "channel 8"),
        (["--socket", "4400"], "--socket '4400'.*HOST:PORT"),
        (["--socket", "127.0.0.1:1", "--link", "x"], "give one of them"),
        (["--link", "."], "exists already"),
        (["--protocol-version", "256"], "version is 256"),
    ],
)
def test_wrong_use_has_a_clear_answer(arguments: list[str], named: str) -> None:
    result = CliRunner().invoke(app, ["simulate-device", *arguments])
    assert result.exit_code == 2
    assert re.search(named, result.stderr.replace("\n", " ")), result.stderr


def test_what_a_solver_wrote_can_be_played(tmp_path: Path) -> None:
    arm, task = ak.catalog.ehmcs(), ak.load_task("drinking_reach")
    path = ak.HandPath(task.path.time[:40], task.path.position[:40], task.path.rotation[:40])
    solution = ak.solve(arm, path, start=task.measured.q[0], backend="vm")
    played = tmp_path / "solved.csv"
    solution.save(played)
    simulator = Simulator(
        played, "--socket", "127.0.0.1:0", "--speed", 0, "--seconds", 1, "--seed", 5, "--noise", 0
    )
    got = simulator.samples(500)
    assert simulator.end()[0] == 0
    device = SimulatedDevice(
        ak.JointMotion(path.time, solution.q, arm.joint_names),
        sensors_of(arm, seed=1, noise=0.0),
        seed=5,
    )
    angles = true_calibration(device, arm).angles(np.array([sample.counts for sample in got]))
    assert np.abs(angles - device.true_angles(range(500))).max() < np.deg2rad(0.1)


class Terminal(io.StringIO):
    """What rich takes for a terminal."""

    def isatty(self) -> bool:
        return True


def test_live_line_changes_in_place_and_only_in_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    for stream in (Terminal(), io.StringIO()):
        monkeypatch.setattr(sys, "stderr", stream)
        with LiveLine() as line:
            line.show("one")
            line.show("two " * 50)
        said = stream.getvalue()
        if stream.isatty():
            assert "one" in said
            assert "\x1b[2K" in said
            assert "…" in said
            assert said.count("two") < 25
        else:
            assert said == ""
