"""`armik solve` and `armik compare` on recordings: what does not go together, and what is missing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from synthetic_markers import known_markers, with_gaps
from test_cli_solve_recordings import write_points
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.motion.bundled import data_folder

TASK = data_folder() / "tasks" / "drinking_reach_path.csv"
ANGLES = data_folder() / "tasks" / "drinking_reach_angles.csv"


def failure(*arguments: object) -> str:
    """What a failing command says; everything else about a failure is checked here."""
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert "\n\n" not in result.stderr.strip()
    return " ".join(result.stderr.split())


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("markers")
    recording = known_markers("left", n=60).recording
    ak.write_markers(folder / "me.trc", recording)
    every = {name: [(0, 58)] for name in ("WRI_rad",)}
    ak.write_markers(folder / "gaps.trc", with_gaps(recording, every))
    ak.write_markers(folder / "hand.trc", recording.selected(("WRI_rad", "WRI_uln", "MCP2", "MCP5")))
    write_points(folder, "left")
    text = (folder / "points.toml").read_text(encoding="utf-8")
    (folder / "hand.toml").write_text(
        "\n".join(line for line in text.splitlines() if not line.startswith(("shoulder", "elbow"))),
        encoding="utf-8",
    )
    (folder / "whose.toml").write_text(text.replace('side = "left"', ""), encoding="utf-8")
    (folder / "axes.toml").write_text(text.replace("frame =", "# frame ="), encoding="utf-8")
    (folder / "flat.toml").write_text(
        "\n".join(line for line in text.splitlines() if not line.startswith("hand")), encoding="utf-8"
    )
    (folder / "skeleton.bvh").write_text("HIERARCHY\n", encoding="utf-8")
    return folder


@pytest.mark.parametrize("command", ["solve", "compare"])
@pytest.mark.parametrize(
    ("typed", "words"),
    [
        (["me.trc"], ["--points is missing", "SHO", "Without shoulder and elbow"]),
        (["hand.trc"], ["--points is missing", "MCP2", "in the base frame of the arm"]),
        (["hand.trc", "--points", "hand.toml", "--arm", "human"], ["no shoulder", "in the base frame"]),
        (["hand.trc", "--points", "points.toml"], ["has no marker 'SHO'", "WRI_rad"]),
        (["me.trc", "--points", "flat.toml"], ["do not tell how the hand is turned"]),
        (["me.trc", "--points", "whose.toml"], ["side is missing: give --side 'left' or 'right'"]),
        (["me.trc", "--points", "axes.toml"], ["frame is missing: give --frame"]),
        (["me.trc", "--points", "none.toml"], ["none.toml", "no such file"]),
        (["me.trc", "--points", "points.toml", "--rom", "wide"], ["valid are model, widened"]),
        (["me.trc", "--points", "points.toml", "--base", "floating"], ["'fixed' or 'moving'"]),
        (["me.trc", "--points", "points.toml", "--unit", "mm"], ["declares its own"]),
        (["me.trc", "--points", "points.toml", "--begin", "0.56"], ["4 samples from 0.56", "a fit needs"]),
        (["me.trc", "--points", "points.toml", "--arm", "alfaiz"], ["does not say which way is up"]),
        (["me.trc", "--points", "points.toml", "--arm", "squid"], ["squid", "alfaiz, ehmcs, human"]),
        (["gaps.trc", "--points", "points.toml"], ["2 of 60 samples have all points", "with --fill"]),
        (["skeleton.bvh", "--points", "points.toml"], ["have no unit", "--unit cm"]),
        ([ANGLES], ["holds joint angles: say of which arm, as in --arm"]),
        (
            [ANGLES, "--arm", "ehmcs", "--points", "points.toml"],
            ["--points does not go with", "joint angles"],
        ),
        ([ANGLES, "--arm", "ehmcs", "--base", "fixed"], ["--base does not go with", "about markers"]),
        ([ANGLES, "--arm", "alfaiz"], ["has no joint", "all its joints are needed"]),
        (["none.mot", "--arm", "ehmcs"], ["none.mot", "no such file"]),
    ],
)
def test_both_commands_say_what_is_wrong_with_a_recording(
    folder, monkeypatch, command, typed, words, tmp_path
):
    monkeypatch.chdir(folder)
    said = failure(command, *typed, "--out", tmp_path)
    for word in words:
        assert word in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ([TASK, "--points", "points.toml"], ["--points does not go with", "hand path"]),
        ([TASK, "--lengths", "arm"], ["--lengths does not go with", "hand path"]),
        ([TASK, "--start", "recorded"], ["a hand path has no recorded posture"]),
        ([ANGLES, "--arm", "ehmcs", "--lengths", "arm"], ["--lengths does not go with", "joint angles"]),
        (["me.trc", "--points", "points.toml", "--lengths", "arm"], ["--lengths arm needs --arm"]),
        (["me.trc", "--points", "points.toml", "--lengths", "long"], ["valid are fitted, arm"]),
        (
            ["me.trc", "--points", "points.toml", "--n-best", "2"],
            ["--n-best needs exact", "--tracking exact"],
        ),
        (["me.trc", "--points", "points.toml", "--search", "swivel"], ["--search needs exact tracking"]),
        (["me.trc", "--points", "points.toml", "--start", "1,2"], ["--start has 2 angles", "expected 7"]),
    ],
)
def test_solve_says_what_does_not_go_together(folder, monkeypatch, typed, words, tmp_path):
    monkeypatch.chdir(folder)
    said = failure("solve", *typed, "--out", tmp_path)
    for word in words:
        assert word in said
    assert list(tmp_path.iterdir()) == []


def test_a_hand_path_without_a_coordinate_is_no_table_of_angles(tmp_path):
    (tmp_path / "flat.csv").write_text("time [s],x [mm],y [mm]\n0,1,2\n1,2,3\n", encoding="utf-8")
    said = failure("solve", tmp_path / "flat.csv", "--out", tmp_path)
    assert "line 1" in said
    assert "z" in said.partition("line 1")[2]
    assert "joint angles" not in said


def test_a_hand_path_cannot_be_compared(tmp_path):
    assert "nothing of joints to compare with: use armik solve" in failure("compare", TASK, "--out", tmp_path)


def test_the_arm_that_was_read_is_not_overwritten(folder, monkeypatch, tmp_path):
    monkeypatch.chdir(folder)
    ak.save_arm(ak.catalog.human(), tmp_path / "me_arm.toml")
    before = (tmp_path / "me_arm.toml").read_bytes()
    typed = ["me.trc", "--points", "points.toml", "--arm", tmp_path / "me_arm.toml", "--out", tmp_path]
    assert "would be overwritten" in failure("solve", *typed)
    assert (tmp_path / "me_arm.toml").read_bytes() == before


def test_a_person_who_walks_is_told_of_the_moving_base(folder, tmp_path):
    known = known_markers("left", n=60, sway=0.08)
    ak.write_markers(tmp_path / "walk.trc", known.recording)
    typed = ["walk.trc", "--points", folder / "points.toml", "--out", tmp_path]
    said = {}
    for base in ("fixed", "moving"):
        result = CliRunner().invoke(
            app, ["solve", str(tmp_path / "walk.trc"), *map(str, typed[1:]), "--base", base]
        )
        said[base] = " ".join(result.output.split())
    assert "the arm stands still: --base moving follows it" in said["fixed"]
    assert "--base moving follows it" not in said["moving"]
    with np.load(tmp_path / "walk_solution.npz") as saved:
        np.testing.assert_allclose(saved["path_position"], known.hand, atol=1e-8)
