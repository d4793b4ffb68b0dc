"""Everything that can go wrong on the command line: one paragraph on stderr, exit code 2."""

from __future__ import annotations

import os
import warnings

import pytest
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.cli import app
from armik_sym.cli.failures import paragraph, tidy_warnings
from armik_sym.cli.progress_bar import ProgressBar, detail
from armik_sym.errors import CompilerWarning
from armik_sym.motion.bundled import data_folder

TASK = data_folder() / "tasks" / "drinking_reach_path.csv"


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def failure(*arguments):
    """What a failing command says; everything else about a failure is checked here."""
    result = run(*arguments)
    assert result.exit_code == 2, result.stdout + result.stderr
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert result.stderr.startswith("error: ")
    assert "\n\n" not in result.stderr.strip()
    return result.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["no.csv"], ["no.csv", "no such file"]),
        ([data_folder()], ["is a folder"]),
        ([TASK, "--arm", "octopus"], ["octopus", "alfaiz, ehmcs, human"]),
        ([TASK, "--arm", "no.toml"], ["no.toml"]),
        ([TASK, "--method", "magic"], ["magic", "trajectory"]),
        ([TASK, "--orientation", "upside"], ["upside", "full", "none", "pointing"]),
        ([TASK, "--tracking", "loose"], ["loose", "exact, soft"]),
        ([TASK, "--backend", "gpu"], ["gpu", "auto, c, vm"]),
        (
            [TASK, "--start", "1,2,3"],
            ["--start has 3 angles", "expected 7 angles in degrees", "elbow_flexion"],
        ),
        ([TASK, "--start", "1,2,3,x,5,6,7"], ["--start holds 'x'", "expected 7"]),
        ([TASK, "--start", "1,2,3,nan,5,6,7"], ["--start holds 'nan'", "expected 7"]),
        ([TASK, "--start", "0,0,0,170,0,0,0"], ["elbow_flexion", "170", "145"]),
        ([TASK, "--max-speed", "0"], ["--max-speed is 0", "positive"]),
        ([TASK, "--max-acceleration", "-5"], ["--max-acceleration is -5", "positive"]),
        ([TASK, "--set", "prefer=low"], ["prefer is 'low'", "elbow_low, elbow_high, elbow_out, elbow_in"]),
        ([TASK, "--set", "prefer=elbow_out", "--arm", "alfaiz"], ["does not say where outward is"]),
        ([TASK, "--set", "prefer=[0,0,0,90,0,0,0]"], ["elbow_flexion", "90 rad", "angles are in radians"]),
        ([TASK, "--set", "clearance_weight=much"], ["clearance_weight is 'much'", "finite number"]),
        ([TASK, "--set", "clearance=[0.1, 0.2]"], ["clearance has 2 numbers", "7 joints"]),
        ([TASK, "--set", "clearence=0.1"], ["'clearence'", "clearance, clearance_weight"]),
        ([TASK, "--n-best", "0"], ["--n-best is 0", "whole number ≥ 1"]),
        ([TASK, "--set", "n_best=1.5"], ["--n-best is 1.5", "whole number ≥ 1"]),
        ([TASK, "--n-best", "2", "--orientation", "none"], ["--n-best 2 needs the swivel map", "full poses"]),
        ([TASK, "--n-best", "2", "--method", "lm"], ["--n-best belongs to --method trajectory"]),
        ([TASK, "--search", "map"], ["search is 'map'", "auto, swivel, full-space"]),
        (
            [TASK, "--search", "swivel", "--tracking", "soft"],
            ["--search swivel does not fit", "--search auto"],
        ),
        ([TASK, "--search", "swivel", "--method", "lm"], ["--search belongs to --method trajectory"]),
    ],
)
def test_solve_says_what_is_wrong(tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    said = failure("solve", *arguments, *([] if "--backend" in arguments else ["--backend", "vm"]))
    for word in words:
        assert word in said


def test_a_path_out_of_reach_names_samples_and_distance(tmp_path):
    path = ak.read_path(TASK)
    far = tmp_path / "far.csv"
    ak.write_path(far, ak.HandPath(path.time[::14], 1.5 * path.position[::14], path.rotation[::14]))
    said = failure("solve", far, "--backend", "vm", "--out", tmp_path / "out")
    assert "cannot be reached" in said
    assert "mm" in said


@pytest.mark.parametrize("content", [b"", b"\x00\x01\x02", b"time,x,y,z\n0,1,2,3\n", b"hello\n"])
def test_a_file_that_is_no_path_is_named(tmp_path, content):
    file = tmp_path / "odd.csv"
    file.write_bytes(content)
    assert "odd.csv" in failure("solve", file, "--out", tmp_path / "out")


@pytest.mark.skipif(os.name == "nt" or os.getuid() == 0, reason="needs permissions that count")
def test_a_file_that_must_not_be_read_is_named(tmp_path):
    file = tmp_path / "secret.csv"
    file.write_text("x", encoding="utf-8")
    file.chmod(0)
    assert "secret.csv" in failure("solve", file)


def test_a_file_in_the_way_of_the_results_is_noticed_before_solving(tmp_path, monkeypatch):
    monkeypatch.setattr(ak, "solve", lambda *a, **k: pytest.fail("solved first"))
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    for out in (tmp_path / "out", tmp_path / "out" / "deeper"):
        assert "a file stands in the way" in failure("solve", TASK, "--out", out)
        assert "a file stands in the way" in failure("demo", "--out", out)


def test_emit_c_lists_valid_words(tmp_path):
    assert "alfaiz, ehmcs, human" in failure("emit-c", "--arm", "squid", "--out", tmp_path)
    said = failure("emit-c", "--arm", "ehmcs", "--out", tmp_path, "--precision", "half")
    assert "double" in said
    said = failure("emit-c", "--arm", "ehmcs", "--out", tmp_path, "--lengths", "long")
    assert "baked" in said
    assert "parameter" in said


def test_a_missing_compiler_says_how_to_get_one(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "/no/such/compiler")
    said = failure("solve", TASK, "--backend", "c", "--out", tmp_path)
    assert "/no/such/compiler" in said


def test_wrong_usage_shows_the_usage():
    for arguments in (["solve"], ["dance"], ["solve", TASK, "--seed", "x"], ["demo", "--no"]):
        result = run(*arguments)
        assert result.exit_code == 2
        assert "Usage:" in result.stderr
        assert "Traceback" not in result.stderr


def test_errors_of_the_system_become_one_paragraph(monkeypatch):
    def full(name):
        raise OSError(28, "No space left on device", "disk.csv")

    monkeypatch.setattr(ak, "load_arm", full)
    assert failure("solve", TASK) == "error: disk.csv: No space left on device\n"
    monkeypatch.setenv("ARMIK_DEBUG", "1")
    result = run("solve", TASK)
    assert isinstance(result.exception, OSError)


def test_a_bug_is_not_dressed_up_as_a_user_error(monkeypatch):
    def buggy(name):
        raise ZeroDivisionError

    monkeypatch.setattr(ak, "load_arm", buggy)
    assert isinstance(run("solve", TASK).exception, ZeroDivisionError)


def test_ctrl_c_is_no_error(monkeypatch):
    def interrupted(name):
        raise KeyboardInterrupt

    monkeypatch.setattr(ak, "load_arm", interrupted)
    result = run("solve", TASK)
    assert (result.exit_code, result.stdout, result.stderr) == (130, "", "stopped\n")


def test_blank_lines_and_silent_errors():
    assert paragraph(ak.ArmikError("first\n\n  second  \n")) == "first\n  second"
    assert paragraph(ak.ArmikError()) == "ArmikError"
    assert paragraph(OSError("odd")) == "odd"


def test_warnings_take_one_line(capsys):
    with tidy_warnings():
        warnings.warn("no compiler\nfound", CompilerWarning, stacklevel=1)
    assert capsys.readouterr().err == "warning: no compiler found\n"


def test_other_warnings_stay_what_they_are():
    with pytest.warns(UserWarning, match="other"), tidy_warnings():
        warnings.warn("other", UserWarning, stacklevel=1)


def test_progress_is_shown_in_a_terminal_only(capsys, monkeypatch):
    assert detail(ak.Progress("exact tracking", 7, 2e-5)) == "exact tracking, iteration 7, violation 2e-05"
    assert detail(ak.Progress("first guess")) == "first guess"
    for terminal in (False, True):
        monkeypatch.setattr("sys.stderr.isatty", lambda terminal=terminal: terminal)
        with ProgressBar("demo", steps=1) as bar:
            bar.begin("drinking")
            bar(ak.Progress("first guess", 1, 0.5))
            bar.finish()
        captured = capsys.readouterr()
        assert captured.out == ""
        assert bool(captured.err) is terminal


def test_messages_speak_the_language_of_the_command_line():
    from armik_sym.cli.failures import as_typed

    assert (
        as_typed('Use tracking="soft" or orientation="none".') == "Use --tracking soft or --orientation none."
    )
    assert as_typed("Raise max_speed.") == "Raise --max-speed."
    assert (
        as_typed('n_best=2 or n_best; search="full-space"') == "--n-best 2 or --n-best; --search full-space"
    )
