"""Choosing between WebAssembly and frames: compiler, cache, refusals."""

from __future__ import annotations

import importlib.util
import json
import shutil

import numpy as np
import pytest
from compiled_helpers import entries, forgotten, script
from page_scripts import ALL_ARMS, needs_zig

from armik_sym.compiled import build, compiler
from armik_sym.compiled.compiler import Compiler, find_zig
from armik_sym.errors import CompilerError, OptionError, ShapeError
from armik_sym.report.wasm import page_kinematics, wasm_compiler

ARM = ALL_ARMS["ehmcs"]
Q = np.tile(ARM.rom.middle, (3, 1))


@pytest.fixture(autouse=True)
def _fresh():
    """As a new process would find everything, and as it was afterwards."""
    with forgotten():
        compiler._find_zig.cache_clear()
        wasm_compiler._module.cache_clear()
        yield
    compiler._find_zig.cache_clear()
    wasm_compiler._module.cache_clear()


@pytest.fixture
def _no_ziglang(monkeypatch, tmp_path):
    """No zig but one in `tmp_path`; other compilers stay, so that only the page is concerned."""
    which = shutil.which
    monkeypatch.setattr(compiler, "_ziglang", lambda: None)
    elsewhere = {"path": str(tmp_path)}
    monkeypatch.setattr(
        shutil, "which", lambda name, **at: which(name, **(elsewhere if name == "zig" else at))
    )


@pytest.mark.usefixtures("_no_ziglang")
def test_without_a_compiler_there_are_frames_and_the_note_says_why():
    page = page_kinematics(ARM, Q)
    assert page.kind == page.data["kind"] == "frames"
    assert page.note == page.data["note"]
    assert "computed beforehand, because no compiler for WebAssembly was found" in page.note
    assert "pip install ziglang" in page.note
    with pytest.raises(CompilerError, match="no compiler for WebAssembly"):
        page_kinematics(ARM, Q, kind="wasm")


@pytest.mark.usefixtures("_no_ziglang")
def test_a_compiler_that_fails_is_asked_once_and_the_note_says_so(tmp_path, caplog):
    log = tmp_path / "log"
    body = f'if [ "$2" = --version ]; then echo "clang version 1 (home)"; exit 0; fi\necho asked >> {log}\n'
    script(tmp_path / "zig", body + 'echo "no such target"; exit 1')
    for _ in range(2):
        page = page_kinematics(ARM, Q)
        assert page.kind == "frames"
        assert "because the compiler for WebAssembly failed" in page.note
        assert str(tmp_path) not in json.dumps(page.data)
    assert log.read_text().splitlines() == ["asked"]
    assert "no such target" in caplog.text
    with pytest.raises(CompilerError, match="no such target"):
        page_kinematics(ARM, Q, kind="wasm")


def test_zig_of_the_path_serves_where_the_package_is_missing(tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name, *_: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    script(tmp_path / "zig", 'echo "clang version 1, told $1 $2"')
    found = find_zig()
    assert found == Compiler((str(tmp_path / "zig"), "cc"), "clang version 1, told cc --version", "PATH")


@needs_zig
def test_module_is_compiled_once_for_all_arms_of_a_structure(tmp_path, monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path))
    made = []
    compile_into = build._compile_into
    monkeypatch.setattr(build, "_compile_into", lambda *a: (made.append(a), compile_into(*a)))
    other = ARM.with_lengths(**{key: 2 * value for key, value in ARM.lengths.items()})
    pages = [page_kinematics(arm, Q) for arm in (ARM, other, ARM.with_rom(-ARM.rom.upper, ARM.rom.upper))]
    assert {page.kind for page in pages} == {"wasm"}
    assert len({page.data["module"] for page in pages}) == 1
    assert len(made) == 1
    wasm_compiler._module.cache_clear()  # another process
    assert page_kinematics(ARM, Q).data["module"] == pages[0].data["module"]
    assert len(made) == 1
    (entry,) = entries(tmp_path)
    (tmp_path / entry / build._LIBRARY).write_bytes(b"damaged")
    wasm_compiler._module.cache_clear()
    assert page_kinematics(ARM, Q).data["module"] == pages[0].data["module"]
    assert len(made) == 2


@needs_zig
def test_data_are_plain_json_and_safe_inside_a_page():
    for kind in ("wasm", "frames"):
        page = page_kinematics(ARM, Q, kind=kind)
        text = json.dumps(page.data, allow_nan=False)
        assert json.loads(text) == page.data
        assert "<" not in text
        assert "http" not in text
        assert "</" not in page.script
        assert "eval" not in page.script
        assert page.landmarks == {"shoulder": 0, "elbow": 3, "wrist": 4, "hand": 7}


@pytest.mark.parametrize(
    ("postures", "kind", "error", "words"),
    [
        (Q, "js", OptionError, "kind is 'js': valid are auto, wasm, frames"),
        (Q[0], "frames", ShapeError, r"postures \(7,\): expected \(n, 7\)"),
        (Q[:0], "auto", ShapeError, r"postures \(0, 7\).*n at least 1"),
        (np.where(np.arange(3)[:, None] == 1, np.nan, Q), "auto", ShapeError, "sample 1 .*no finite number"),
    ],
)
def test_refusals(postures, kind, error, words):
    with pytest.raises(error, match=words):
        page_kinematics(ARM, postures, kind=kind)


def test_references_of_another_length_are_refused():
    with pytest.raises(ShapeError, match=r"reference \(2, 3\)"):
        page_kinematics(ARM, Q, np.eye(3)[:2], kind="frames")
