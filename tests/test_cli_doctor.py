"""`armik doctor` on healthy and on ill machines."""

from __future__ import annotations

import subprocess
import sys

import pytest
from typer.testing import CliRunner

from armik_sym.cli import app, doctor_checks, doctor_solver
from armik_sym.compiled import compiler
from armik_sym.motion import bundled, tasks


@pytest.fixture
def cache(tmp_path, monkeypatch):
    folder = tmp_path / "cache"
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(folder))
    return folder


@pytest.fixture
def no_ipopt(monkeypatch):
    """Most tests are not about IPOPT: answer at once."""
    found = doctor_checks.Finding("IPOPT", "found", "as if", essential=True)
    monkeypatch.setattr(doctor_solver, "check_ipopt", lambda: found)


def run():
    result = CliRunner().invoke(app, ["doctor"])
    assert result.stderr == ""
    return result.exit_code, {line[9:27].strip(): line for line in result.stdout.splitlines()}, result.stdout


def test_a_healthy_machine_is_ready(cache):
    code, lines, said = run()
    assert code == 0, said
    assert said.endswith("Ready.\n")
    for name in ("Python", "armik_sym", "casadi", "numpy", "scipy", "IPOPT", "bundled data", "cache"):
        assert lines[name].startswith("found")
    for name in ("matplotlib", "control", "pyserial", "C compiler"):
        assert name in lines
    assert "MUMPS" in lines["IPOPT"]
    assert "5 tasks (synthetic), 3 arms, 3 patients" in lines["bundled data"]
    assert f"{cache} (mode 700), 0 entries, 0.0 MB" in lines["cache"]


def test_without_a_compiler_it_says_how_to_get_one_and_is_still_ready(cache, no_ipopt, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(compiler.importlib.util, "find_spec", lambda name: None)
    compiler._find.cache_clear()
    try:
        code, lines, said = run()
    finally:
        compiler._find.cache_clear()
    assert code == 0
    assert lines["C compiler"].startswith("missing")
    assert "pip install ziglang" in said


def test_a_compiler_that_fails_is_broken(cache, no_ipopt, monkeypatch, tmp_path):
    fake = tmp_path / "cc.py"
    fake.write_text("import sys; print('fake 1.0'); sys.exit('--version' not in sys.argv)", encoding="utf-8")
    monkeypatch.setenv("CC", f"{sys.executable} {fake}")
    _, lines, said = run()
    assert lines["C compiler"].startswith("broken")
    assert "pip install ziglang" in said
    monkeypatch.setenv("CC", "/no/such/compiler")
    assert "cannot be run" in run()[1]["C compiler"]


@pytest.mark.parametrize(
    ("code", "word"), [(1, "no module"), (-11, "exit code -11")], ids=["import fails", "crash"]
)
def test_a_solver_that_ends_its_process_is_reported(cache, monkeypatch, code, word):
    done = subprocess.CompletedProcess([], code, "", "no module" if code == 1 else "")
    monkeypatch.setattr(doctor_solver.subprocess, "run", lambda *a, **k: done)
    finding = doctor_solver.check_ipopt()
    assert finding.state == "broken"
    assert word in finding.detail
    assert "pip install" in finding.remedy


def test_missing_data_and_packages_make_it_not_ready(cache, no_ipopt, monkeypatch, tmp_path):
    package = tmp_path / "package" / "motion" / "bundled.py"
    monkeypatch.setattr(bundled, "__file__", str(package))
    monkeypatch.setattr(tasks, "data_folder", bundled.data_folder)
    genuine = doctor_checks.metadata.version

    def without_scipy(name):
        if name in ("scipy", "control"):
            raise doctor_checks.metadata.PackageNotFoundError(name)
        return genuine(name)

    monkeypatch.setattr(doctor_checks.metadata, "version", without_scipy)
    code, lines, said = run()
    assert code == 1
    assert lines["bundled data"].startswith("broken")
    assert lines["scipy"].startswith("missing")
    assert "pip install scipy" in said
    assert said.endswith("Not ready: scipy, bundled data.\n")


def test_a_cache_that_cannot_be_read_is_reported(cache, no_ipopt, monkeypatch):
    def refused():
        raise PermissionError(13, "Permission denied", str(cache))

    monkeypatch.setattr("armik_sym.compiled.cache_folder.cache_folder", refused)
    _, lines, said = run()
    assert lines["cache"].startswith("broken")
    assert "ARMIK_CACHE_DIR" in said
