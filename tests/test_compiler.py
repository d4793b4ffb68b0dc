"""Finding and running C compilers."""

from __future__ import annotations

import importlib.util
import os
import sys

import pytest
from compiled_helpers import CC, forgotten, needs_cc, script

from armik_sym.compiled import compiler as module
from armik_sym.compiled.compiler import NATIVE, Compiler, find_compiler, processor
from armik_sym.errors import CompilerError


@pytest.fixture(autouse=True)
def _fresh():
    with forgotten():
        yield


def _fake(folder, name, version="fake 1.0", body="exit 1"):
    return script(folder / name, f'if [ "$1" = --version ]; then echo "{version}"; exit 0; fi\n{body}')


def test_cc_with_arguments_comes_first(tmp_path, monkeypatch):
    _fake(tmp_path, "cc", "from PATH")
    mine = script(tmp_path / "mine", 'echo "mine got $1 $2"')
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("CC", f"{mine} -m64")
    found = find_compiler()
    assert found.command == (str(mine), "-m64")
    assert found.version == "mine got -m64 --version"
    assert found.origin == "$CC"


def test_order_on_the_path(tmp_path, monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    for name in ("clang", "gcc", "cc"):
        _fake(tmp_path, name, f"I am {name}")
        module._find.cache_clear()
        assert find_compiler().version == f"I am {name}"
        assert find_compiler().origin == "PATH"


def test_a_compiler_that_does_not_answer_is_passed_over(tmp_path, monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    script(tmp_path / "cc", "exit 3")
    _fake(tmp_path, "gcc", "I am gcc")
    assert find_compiler().version == "I am gcc"


@pytest.mark.parametrize("cc", ["/no/such/compiler", "false --flag"])
def test_broken_cc_is_named(monkeypatch, cc):
    monkeypatch.setenv("CC", cc)
    with pytest.raises(CompilerError, match=f"CC='{cc}' cannot be run: unset CC"):
        find_compiler()


def test_cc_with_a_stray_quote_is_named(monkeypatch):
    monkeypatch.setenv("CC", "gcc '")
    with pytest.raises(CompilerError, match="CC="):
        find_compiler()


def test_blank_cc_counts_as_unset(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "  ")
    monkeypatch.setenv("PATH", str(tmp_path))
    _fake(tmp_path, "cc")
    assert find_compiler().origin == "PATH"


def test_ziglang_comes_last_and_nothing_is_none(monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(module, "_probe", lambda command, origin: Compiler(command, "zig", origin))
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: object())
    assert find_compiler().command == (sys.executable, "-m", "ziglang", "cc")
    module._find.cache_clear()
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert find_compiler() is None


def test_what_a_failing_compiler_prints_is_shown(tmp_path):
    broken = Compiler((str(_fake(tmp_path, "broken", body="echo boom >&2; exit 1")),), "1", "$CC")
    with pytest.raises(CompilerError, match=r"failed with exit code 1(.|\n)*boom") as caught:
        broken.compile_shared(tmp_path / "a.c", tmp_path / "a.so")
    assert caught.value.output.strip() == "boom"


def test_a_compiler_that_writes_nothing_has_failed(tmp_path):
    idle = Compiler((str(_fake(tmp_path, "idle", body="exit 0")),), "1", "$CC")
    with pytest.raises(CompilerError, match="exit code 0"):
        idle.compile_shared(tmp_path / "a.c", tmp_path / "a.so")


def test_a_compiler_that_vanished_is_an_error_of_ours(tmp_path):
    with pytest.raises(CompilerError, match="could not run"):
        Compiler((str(tmp_path / "gone"),), "1", "$CC").compile_shared(tmp_path / "a.c", tmp_path / "a.so")


@needs_cc
def test_a_compiler_without_native_still_serves(tmp_path):
    body = f'for a in "$@"; do [ "$a" = "{NATIVE}" ] && exit 1; done\nexec {CC} "$@"'
    old = Compiler((str(script(tmp_path / "old", body)),), "1", "$CC")
    (tmp_path / "a.c").write_text("int f(void);\nint f(void) { return 1; }\n")
    old.compile_shared(tmp_path / "a.c", tmp_path / "a.so")
    assert (tmp_path / "a.so").exists()


@pytest.mark.skipif(importlib.util.find_spec("ziglang") is None, reason="ziglang not installed")
def test_ziglang_compiles_and_answers_the_same(tmp_path, monkeypatch):
    import numpy as np
    from sample_arms import ARMS, postures

    from armik_sym.compiled import compile as compile_arm

    arm = ARMS["ehmcs"]
    monkeypatch.setenv("CC", f"{sys.executable} -m ziglang cc")
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path))
    with_zig, vm = compile_arm(arm, "c"), compile_arm(arm, "vm")
    q = postures(arm, 20)
    np.testing.assert_allclose(with_zig.jacobian(q), vm.jacobian(q), atol=1e-14)
    assert with_zig.compile_time > 0


def test_processor_is_part_of_the_machine():
    assert os.uname().machine in processor()
