"""`armik report`: what it reads, writes and refuses."""

from __future__ import annotations

import re

import numpy as np
import pytest
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.cli.report import write_solution_report
from armik_sym.cli.saved_solution import saved_solution
from armik_sym.motion.bundled import data_folder
from armik_sym.report import save_figure, solution_figure

TASKS = data_folder() / "tasks"
PATH, ANGLES = TASKS / "drinking_reach_path.csv", TASKS / "drinking_reach_angles.csv"


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def solution():
    return ak.solve(
        ak.catalog.ehmcs(), ak.read_path(PATH), start=ak.load_task("drinking_reach").measured.q[0]
    )


def test_a_saved_solution_is_read_back_as_it_was(solution, tmp_path):
    file = solution.save(tmp_path / "reach.npz")
    read, known = saved_solution(file, solution.arm)
    assert known
    np.testing.assert_array_equal(read.q, solution.q)
    np.testing.assert_array_equal(read.start, solution.start)
    for key in ("position_tolerance", "rotation_tolerance", "start_tolerance"):
        assert getattr(read.requirements, key) == getattr(solution.requirements, key)
    np.testing.assert_array_equal(read.requirements.max_speed, solution.requirements.max_speed)
    np.testing.assert_array_equal(read.requirements.max_acceleration, solution.requirements.max_acceleration)
    assert (read.method, read.seed, read.cost, read.reasons) == ("trajectory", 0, solution.cost, ())
    np.testing.assert_allclose(read.position_error, solution.position_error, atol=1e-15)


def test_a_report_of_a_solution_with_measured_angles_beside(solution, tmp_path):
    file = solution.save(tmp_path / "reach.npz")
    out = tmp_path / "new" / "reach.html"
    result = run("report", file, "--measured", ANGLES, "--out", out, "--title", "A <b>cup</b>")
    assert result.exit_code == 0, result.stderr
    assert str(out) in result.stdout
    text = out.read_text(encoding="utf-8")
    assert "A &lt;b&gt;cup&lt;/b&gt;" in text
    assert "The arm can make this motion" in text
    assert "Difference between this motion and the measured one" in text


def test_a_hand_path_is_solved_first_and_compared(tmp_path):
    out = tmp_path / "path.html"
    result = run("report", PATH, "--compare", "lm", "--out", out)
    assert result.exit_code == 0, result.stderr
    assert re.search(r"<th scope=\"row\">lm</th>", out.read_text(encoding="utf-8"))


def test_joint_angles_alone_have_a_report_without_errors(solution, tmp_path):
    for file in (ANGLES, solution.save(tmp_path / "reach.csv"), solution.save(tmp_path / "reach.mot")):
        out = tmp_path / "angles.html"
        result = run("report", file, "--out", out)
        assert result.exit_code == 0, result.stderr
        text = out.read_text(encoding="utf-8")
        assert "Which hand path was asked for is not known" in text
        assert "Does the hand stay on its path" not in text


def test_angles_outside_their_range_end_with_1(tmp_path):
    motion = ak.load_task("drinking_reach").measured
    file = tmp_path / "far.csv"
    ak.write_motion(file, ak.JointMotion(motion.time, motion.q + 1.0, motion.joint_names))
    result = run("report", file, "--out", tmp_path / "far.html")
    assert result.exit_code == 1
    assert "not what was asked for" in (tmp_path / "far.html").read_text(encoding="utf-8")


def test_what_does_not_fit_is_refused(solution, tmp_path):
    file = solution.save(tmp_path / "reach.npz")
    for arguments, words in (
        ((file, "--out", tmp_path / "a.pdf"), ".html"),
        ((file, "--arm", "human", "--out", tmp_path / "a.html"), "--arm"),
        ((file, "--arm", "alfaiz", "--out", tmp_path / "a.html"), "--arm"),
        ((ANGLES, "--compare", "lm", "--out", tmp_path / "a.html"), "--compare"),
        ((file, "--compare", "trajectory", "--out", tmp_path / "a.html"), "already"),
        ((tmp_path / "missing.npz", "--out", tmp_path / "a.html"), "missing.npz"),
    ):
        result = run("report", *arguments)
        assert result.exit_code == 2, result.stdout
        assert words in result.stderr
    np.savez(tmp_path / "other.npz", q=np.zeros(3))
    assert "no solution saved" in run("report", tmp_path / "other.npz", "--out", tmp_path / "a.html").stderr


def test_the_report_beside_the_files_of_a_solution(solution, tmp_path):
    assert write_solution_report(solution, tmp_path, "reach", title="Reach") == tmp_path / "reach_report.html"


def test_demo_draws_vector_figures(tmp_path, monkeypatch):
    monkeypatch.setattr(ak, "task_names", lambda: ("drinking_reach",))
    result = run("demo", "--format", "pdf", "--no-report", "--out", tmp_path)
    assert result.exit_code == 0, result.stderr
    assert not (tmp_path / "report.html").exists()
    for name in ("joints", "hand", "swivel_map"):
        assert f"_{name}.pdf" in result.stdout
        content = (tmp_path / f"drinking_reach_{name}.pdf").read_bytes()
        assert content.startswith(b"%PDF")
        # Text as TrueType, to be found and edited; no outlines of letters (Type 3).
        assert b"/Type0" in content or b"/TrueType" in content
        assert b"/Type3" not in content
    assert run("demo", "--format", "jpg", "--out", tmp_path).exit_code == 2


def test_svg_keeps_its_text(solution, tmp_path):
    text = save_figure(solution_figure(solution), tmp_path / "joints.svg").read_text(encoding="utf-8")
    assert "Elbow flexion" in text


def test_solve_writes_report_and_vector_figures(tmp_path):
    file, words = tmp_path / "drink.csv", ["--report", "--figures", "--format", "svg", "--backend", "vm"]
    lines = PATH.read_text(encoding="utf-8").splitlines(keepends=True)
    file.write_text("".join(lines[:50]), encoding="utf-8")
    done = run("solve", file, *words, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "drink.csv" in (tmp_path / "out" / "drink_report.html").read_text(encoding="utf-8")
    assert b"<svg" in (tmp_path / "out" / "drink_joints.svg").read_bytes()[:2000]
    done = run("solve", file, "--format", "gif", "--out", tmp_path)
    assert done.exit_code == 2
    assert "gif" in done.output
