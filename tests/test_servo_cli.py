"""`armik servo` and its figures."""

from __future__ import annotations

import re

import numpy as np
import pytest
from servo_helpers import first_second, plain_drive, swing, two_bodies, two_links
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.motion import JointMotion, write_motion
from armik_sym.motion.bundled import data_folder
from armik_sym.report import save_figure
from armik_sym.servo import check

TASK = data_folder() / "tasks" / "drinking_lift_path.csv"
ANGLES = data_folder() / "tasks" / "drinking_lift_angles.csv"
UNIT = re.compile(r"\[(s|ms|Hz|dB|deg|mm|Nm|-)\]")


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def solution():
    task = ak.load_task("drinking_lift")
    return ak.solve(ak.catalog.ehmcs(), first_second(task.path), start=task.measured.q[0])


def test_every_form_of_a_solution_gives_the_same_verdict(tmp_path, solution):
    shown = []
    for ending in (".npz", ".csv", ".mot"):
        file = solution.save(tmp_path / f"drink{ending}")
        result = run("servo", file, "--no-figures", "--out", tmp_path / "out")
        assert result.exit_code == 0, result.stderr
        shown.append(result.stdout)
    assert shown[0] == shown[1] == shown[2]
    assert shown[0].startswith("ok: the drives can follow: arm ehmcs, drive light_exoskeleton")


def test_a_hand_path_is_solved_first_and_figures_are_written(tmp_path):
    result = run("servo", TASK, "--out", tmp_path, "--controller", "pid", "--rate", "500")
    assert result.exit_code == 0, result.stderr
    assert "pid, 8 Hz, 50°" in result.stdout
    assert "500 Hz" in result.stdout
    for name in ("servo", "loops"):
        assert (tmp_path / f"{TASK.stem}_{name}.png").stat().st_size > 10_000


def test_what_is_too_fast_is_retimed_and_the_exit_code_says_so(tmp_path, solution):
    fast = tmp_path / "fast.csv"
    write_motion(fast, JointMotion(solution.time / 8, solution.q, solution.arm.joint_names))
    result = run("servo", fast, "--retime", "--no-figures", "--rate", "500", "--out", tmp_path / "out")
    assert result.exit_code == 1, result.stderr
    assert "NOT ok" in result.stdout
    factor = float(re.search(r"takes ([\d.]+) times as long", result.stdout).group(1))
    assert factor > 1
    assert "re-timed: " in result.stdout
    written = ak.read_motion(tmp_path / "out" / "fast_retimed.csv")
    np.testing.assert_allclose(written.q, solution.q, atol=1e-12)
    assert solution.time[-1] / 8 < written.duration


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((ANGLES, "--arm", "alfaiz"), "has no joint shoulder_1"),
        ((ANGLES, "--drive", "none.toml"), "none.toml: no such file"),
        ((ANGLES, "--controller", "lqr"), "valid are cascade, pid"),
        ((ANGLES, "--feedforward", "all"), "valid are acceleration, none, speed"),
        ((ANGLES, "--mass", "0"), "mass is 0.0"),
        ((ANGLES, "--hand-tolerance", "0"), "tolerance hand"),
        ((ANGLES, "--bandwidth", "300"), "lower bandwidth"),
        (("missing.npz",), "missing.npz"),
    ],
)
def test_errors_are_one_paragraph(tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    result = run("servo", *arguments, "--no-figures")
    assert result.exit_code == 2
    assert said in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("controller", ["cascade", "pid"])
@pytest.mark.parametrize("duration", [1.0, 0.3])
def test_figures_have_units_and_say_the_verdict(tmp_path, controller, duration):
    arm = two_links()
    drive = plain_drive(arm.joint_names)
    found = check(swing(arm, 1.5, duration), drive, controller, bodies=two_bodies())
    page = found.plot(title="swing")
    loops = found.plot_loops()
    assert ("can follow" in page.get_suptitle()) == found.ok
    for figure in (page, loops):
        for axes in figure.axes:
            labels = [axes.get_xlabel(), axes.get_ylabel()]
            assert all(UNIT.search(text) for text in labels if text), labels
            assert labels[1]
        assert save_figure(figure, tmp_path / "figure.pdf").stat().st_size > 5000
    phase = next(axes for axes in loops.axes if "Phase" in axes.get_title("left"))
    low, high = phase.get_ylim()
    shown = phase.lines[0].get_ydata()
    assert ((shown > low) & (shown < high)).mean() > 0.8
    step = loops.axes[3].lines[0].get_ydata()
    assert abs(step[-1] - 1) < 0.05
