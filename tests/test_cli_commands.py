"""The command `armik`: what it writes, prints and returns."""

from __future__ import annotations

import csv
import dataclasses
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym._version import __version__
from armik_sym.cli import app
from armik_sym.motion.bundled import data_folder

TASK = data_folder() / "tasks" / "drinking_reach_path.csv"
ANSI = "\x1b["
ROOT = Path(ak.__file__).parents[1]


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def python(*arguments, **options):
    """A process of its own, whose output is piped."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error", "COLUMNS": "40"}
    return subprocess.Popen(
        [sys.executable, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        env=environment,
        **options,
    )


def test_help_and_version():
    result = run("--help")
    assert result.exit_code == 0
    for name in ("demo", "solve", "emit-c", "doctor"):
        assert re.search(rf"^  {name} ", result.stdout, re.MULTILINE)
    assert run("--version").stdout == f"armik_sym {__version__}\n"
    for name in ("demo", "solve", "emit-c", "doctor"):
        assert run(name, "--help").exit_code == 0


def test_help_needs_no_solver_and_no_figures():
    """With a parent package that imports nothing, the commands themselves import nothing heavy."""
    code = (
        "import sys, types; parent = types.ModuleType('armik_sym'); parent.__path__ = [sys.argv.pop(1)];"
        "sys.modules['armik_sym'] = parent\n"
        "from armik_sym.cli import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = {'casadi', 'matplotlib', 'scipy', 'rich', 'control', 'serial', 'plotly', 'jinja2'}\n"
        "heavy &= set(sys.modules)\n"
        "sys.exit(f'imported {heavy}' if heavy else 0)"
    )
    process = python("-c", code, ROOT / "armik_sym", "--help")
    out, error = process.communicate(timeout=60)
    assert process.returncode == 0, error
    assert "emit-c" in out


def test_demo_in_a_pipe_writes_everything_and_cuts_nothing(tmp_path):
    # Its report is made and opened in test_browser_report.py.
    process = python("-m", "armik_sym", "demo", "--no-report", "--out", tmp_path / "demo")
    out, error = process.communicate(timeout=600)  # may be the first compilation of all
    assert (process.returncode, error) == (0, "")
    assert ANSI not in out
    assert "synthetic" in out
    assert str(tmp_path / "demo") in out
    for name in ak.task_names():
        (line,) = [line for line in out.splitlines() if line.startswith(name)]
        assert line.split()[-1] == "ok"
        assert len(line.split()) == 10
        for ending in ("solution.csv", "joints.png", "hand.png", "swivel_map.png"):
            assert (tmp_path / "demo" / f"{name}_{ending}").stat().st_size > 1000
    assert "synthetic" in (tmp_path / "demo" / "README.txt").read_text(encoding="utf-8")


def test_solve_writes_angles_and_figures_and_says_what_they_are_worth(tmp_path):
    result = run("solve", TASK, "--backend", "vm", "--out", tmp_path / "out", "--seed", "3", "--figures")
    assert result.exit_code == 0, result.stderr
    assert result.stdout.startswith("ok: arm ehmcs, 141 samples")
    assert ANSI not in result.stdout
    stem = tmp_path / "out" / TASK.stem
    for ending in ("solution.csv", "solution.npz", "joints.png", "hand.png", "swivel_map.png"):
        assert Path(f"{stem}_{ending}").exists()
        assert f"{stem}_{ending}" in result.stdout
    with np.load(f"{stem}_solution.npz") as saved:
        assert json.loads(str(saved["record"]))["seed"] == 3
        q = saved["q"]
    with Path(f"{stem}_solution.csv").open(encoding="utf-8") as file:
        next(file)
        rows = list(csv.reader(file))
    assert rows[0][1] == "shoulder_abduction [deg]"
    np.testing.assert_allclose(np.deg2rad(np.array(rows[1:], dtype=float)[:, 1:8]), q, atol=1e-12)


def test_the_next_best_trajectories_are_written_beside_the_best(tmp_path):
    """Their costs are printed, and their angles are those of the library."""
    path = ak.read_path(data_folder() / "tasks" / "playing_ball_path.csv")
    short = tmp_path / "ball.csv"
    ak.write_path(short, ak.HandPath(path.time[::4], path.position[::4], path.rotation[::4]))
    result = run(
        "solve", short, "--n-best", "3", "--search", "swivel", "--out", tmp_path / "out", "--figures"
    )
    assert result.exit_code == 0, result.stderr
    best = ak.solve(ak.catalog.ehmcs(), ak.read_path(short), n_best=3)
    assert len(best.alternatives) >= 1
    for number, each in enumerate((best, *best.alternatives), start=1):
        rank = f"_{number}" if number > 1 else ""
        for name in (f"ball_solution{rank}.csv", f"ball_solution{rank}.npz", f"ball_joints{rank}.png"):
            assert (tmp_path / "out" / name).exists()
            assert name in result.stdout
        with np.load(tmp_path / "out" / f"ball_solution{rank}.npz") as saved:
            np.testing.assert_allclose(saved["q"], each.q, atol=1e-9)
        assert f"cost {each.cost:.6g} 1/s" in " ".join(result.stdout.split())
    assert (tmp_path / "out" / "ball_swivel_map.png").exists()
    more = len(best.alternatives) + 2
    assert not (tmp_path / "out" / f"ball_solution_{more}.csv").exists()


@pytest.mark.parametrize("orientation", ["none", "pointing"])
def test_no_swivel_map_is_drawn_where_the_hand_is_free_to_turn(tmp_path, orientation):
    result = run("solve", TASK, "--orientation", orientation, "--out", tmp_path, "--figures")
    assert result.exit_code == 0, result.stderr
    assert not list(tmp_path.glob("*swivel_map*"))
    assert "_swivel_map.png" not in result.stdout


def test_a_soft_solution_is_drawn_on_the_map_of_its_path(tmp_path):
    result = run("solve", TASK, "--tracking", "soft", "--out", tmp_path, "--figures")
    assert result.exit_code == 0, result.stderr
    assert (tmp_path / f"{TASK.stem}_swivel_map.png").exists()


def test_search_and_n_best_reach_the_solver(tmp_path, monkeypatch):
    seen = {}

    def spy(arm, path, method, **options):
        seen.update(options)
        raise ak.ArmikError("enough")

    monkeypatch.setattr(ak, "solve", spy)
    run("solve", TASK, "--search", "full-space", "--n-best", "4", "--out", tmp_path)
    assert (seen["search"], seen["n_best"]) == ("full-space", 4)
    seen.clear()
    run("solve", TASK, "--set", "search=full-space", "--set", "n_best=4", "--out", tmp_path)
    assert (seen["search"], seen["n_best"]) == ("full-space", 4)
    seen.clear()
    run("solve", TASK, "--out", tmp_path)
    assert not {"search", "n_best"} & set(seen)


EVERY_OPTION = {
    "orientation": "full",
    "tracking": "exact",
    "max_speed": 9.0,
    "max_acceleration": [900.0, 900.0, 900.0, 900.0, 900.0, 900.0, 900.0],
    "speed_weight": 1.5,
    "acceleration_weight": 0.02,
    "posture_weight": 0.01,
    "clearance_weight": 1.0,
    "clearance": [0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2],
    "prefer": "elbow_low",
    "prefer_weight": 2.0,
    "position_sigma": 0.002,
    "rotation_sigma": 0.02,
    "position_tolerance": 1e-6,
    "rotation_tolerance": None,
    "start_tolerance": 0.1,
    "search": "swivel",
    "n_best": 2,
    "certify": False,
    "max_iterations": 200,
    "ipopt_output": False,
}


def test_every_option_of_the_trajectory_can_be_set(tmp_path):
    from armik_sym.trajectory import TrajectoryOptions

    assert set(EVERY_OPTION) == {field.name for field in dataclasses.fields(TrajectoryOptions)}
    typed = [word for name, value in EVERY_OPTION.items() for word in ("--set", f"{name}={value}")]
    result = run("solve", TASK, "--backend", "vm", "--out", tmp_path, *typed)
    assert result.exit_code == 0, result.stderr
    with np.load(tmp_path / f"{TASK.stem}_solution.npz") as saved:
        settings = json.loads(str(saved["record"]))["settings"]
    assert settings == EVERY_OPTION


def test_options_of_solve_reach_the_solver_in_si_units(tmp_path, monkeypatch):
    seen = {}

    def spy(arm, path, method, **options):
        seen.update(options, arm=arm.name, method=method)
        raise ak.ArmikError("enough")

    monkeypatch.setattr(ak, "solve", spy)
    result = run(
        "solve", TASK, "--arm", "human", "--orientation", "none", "--tracking", "soft", "--max-speed", "180",
        "--max-acceleration", "360", "--start", "10,20, 0,90,0,0,0", "--seed", "7", "--backend", "vm",
        "--out", tmp_path,
    )  # fmt: skip
    assert (result.exit_code, result.stderr) == (2, "error: enough\n")
    assert seen.pop("progress") is not None
    assert seen.pop("start") == pytest.approx(np.deg2rad([10, 20, 0, 90, 0, 0, 0]))
    assert seen.pop("max_speed") == pytest.approx(np.pi)
    assert seen.pop("max_acceleration") == pytest.approx(2 * np.pi)
    assert seen == {
        "arm": "human", "method": "trajectory", "orientation": "none", "tracking": "soft", "seed": 7,
        "backend": "vm",
    }  # fmt: skip


def test_set_reaches_the_options_of_the_trajectory(tmp_path):
    """The elbow is drawn to where it was typed, and joints keep clear of their limits."""
    angles = {}
    for name, pairs in {
        "plain": [],
        "low": ["prefer=elbow_low", "clearance_weight=10"],
        "vector": ["prefer=[-1, 0, 0]", "clearance_weight=10.0"],
        "posture": ["prefer=[0, 0, 0, 1, 0, 0, 0]", "posture_weight=0.5"],
    }.items():
        typed = [word for pair in pairs for word in ("--set", pair)]
        result = run("solve", TASK, "--backend", "vm", "--out", tmp_path / name, *typed)
        assert result.exit_code == 0, result.stderr
        with np.load(tmp_path / name / f"{TASK.stem}_solution.npz") as saved:
            angles[name] = saved["q"]
            settings = json.loads(str(saved["record"]))["settings"]
        for pair in pairs:
            key, value = pair.split("=")
            assert settings[key] == (value if value.startswith("elbow") else json.loads(value))
    arm = ak.catalog.ehmcs()
    assert arm.rom.margin(angles["low"]).min() > arm.rom.margin(angles["plain"]).min() + np.deg2rad(2)
    assert np.array_equal(angles["low"], angles["vector"])
    assert np.abs(angles["posture"] - angles["plain"]).max() > 0.1


def test_a_solution_that_is_not_what_was_asked_for_ends_with_1(tmp_path, monkeypatch):
    genuine = ak.solve

    def worse(*arguments, **options):
        solution = genuine(*arguments, **options)
        return dataclasses.replace(solution, q=solution.q + 0.01)

    monkeypatch.setattr(ak, "solve", worse)
    result = run("solve", TASK, "--backend", "vm", "--out", tmp_path)
    assert result.exit_code == 1
    assert result.stdout.startswith("NOT ok")
    assert "because         position error" in result.stdout
    monkeypatch.setattr(ak, "task_names", lambda: ("drinking_reach",))
    result = run("demo", "--backend", "vm", "--no-report", "--out", tmp_path)
    assert result.exit_code == 1
    assert "drinking_reach: position error" in result.stdout


def test_emit_c_writes_a_library_and_names_it(tmp_path):
    result = run("emit-c", "--arm", "ehmcs", "--out", tmp_path / "c", "--precision", "float")
    assert result.exit_code == 0, result.stderr
    assert "armik_ehmcs.c" in result.stdout
    assert "float" in (tmp_path / "c" / "armik_ehmcs.h").read_text(encoding="ascii")


@pytest.mark.skipif(os.name == "nt", reason="sends SIGINT")
def test_ctrl_c_ends_with_one_word_and_130(tmp_path):
    code = (
        "import armik_sym as ak, time\n"
        "def wait(*a, **k): print('solving', flush=True); time.sleep(60)\n"
        "ak.solve = wait\n"
        "from armik_sym.cli import main\n"
        "main()"
    )
    process = python("-c", code, "solve", TASK, "--out", tmp_path)
    assert process.stdout.readline() == "solving\n"
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=30)
    assert (process.returncode, error) == (130, "stopped\n")
