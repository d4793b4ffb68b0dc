"""The cache of compiled libraries."""

from __future__ import annotations

import ctypes
import json
import stat
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from compiled_helpers import entries, needs_cc, script

from armik_sym.compiled import build, cache_folder
from armik_sym.compiled.build import build_library
from armik_sym.compiled.compiler import Compiler, find_compiler
from armik_sym.errors import CacheWarning, CompilerError

pytestmark = needs_cc

_SOURCE = '__attribute__((visibility("default"))) int answer(void);\nint answer(void) { return 42; }\n'


@pytest.fixture
def folder(tmp_path, monkeypatch):
    wanted = tmp_path / "cache"
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(wanted))
    return wanted


@pytest.fixture
def cc():
    return find_compiler()


def _answer(library) -> int:
    return int(library.handle.answer())


def test_second_build_compiles_nothing(folder, cc):
    first, second = build_library(_SOURCE, cc), build_library(_SOURCE, cc)
    assert first.compile_time > 0
    assert second.compile_time == 0
    assert first.path == second.path
    assert _answer(second) == 42
    assert len(entries(folder)) == 1
    assert entries(folder / entries(folder)[0]) == ["library.so", "record.json", "source.c"]
    assert stat.S_IMODE((folder / entries(folder)[0]).stat().st_mode) == 0o700


def _damage_library(entry: Path) -> None:
    data = (entry / "library.so").read_bytes()
    (entry / "library.so").unlink()  # a loaded file must not be changed in place
    (entry / "library.so").write_bytes(data[: len(data) // 2])


@pytest.mark.parametrize(
    "damage",
    [
        _damage_library,
        lambda entry: (entry / "library.so").unlink(),
        lambda entry: (entry / "record.json").write_text('{"sha256": "12'),
        lambda entry: (entry / "record.json").write_text("[]"),
        lambda entry: (entry / "record.json").write_text('{"other": 1}'),
        lambda entry: (entry / "record.json").write_bytes(b"\xff\xfe"),
        lambda entry: (entry / "record.json").unlink(),
        lambda entry: (entry / "record.json").write_text('{"sha256": null}'),
    ],
)
def test_damaged_entry_is_built_anew(folder, cc, damage):
    first = build_library(_SOURCE, cc)
    damage(first.path.parent)
    again = build_library(_SOURCE, cc)
    assert again.compile_time > 0
    assert _answer(again) == 42
    assert len(entries(folder)) == 1
    assert build_library(_SOURCE, cc).compile_time == 0


def test_empty_entry_left_by_another_process_is_replaced(folder, cc):
    folder.mkdir(mode=0o700)
    (folder / build._key(_SOURCE, cc)).mkdir()
    assert _answer(build_library(_SOURCE, cc)) == 42
    assert len(entries(folder)) == 1


def test_file_in_place_of_an_entry_is_replaced(folder, cc):
    folder.mkdir(mode=0o700)
    (folder / build._key(_SOURCE, cc)).write_text("?")
    assert _answer(build_library(_SOURCE, cc)) == 42
    assert len(entries(folder)) == 1


def test_sound_entry_of_another_process_wins(folder, cc, monkeypatch):
    other = build_library(_SOURCE, cc)
    checks = iter([False])  # at first sight the entry is not there yet
    sound = build._is_sound
    monkeypatch.setattr(build, "_is_sound", lambda entry: next(checks, None) is not False and sound(entry))
    before = other.path.stat().st_ino
    assert _answer(build_library(_SOURCE, cc)) == 42
    assert other.path.stat().st_ino == before
    assert len(entries(folder)) == 1


def test_processes_that_compile_at_once_share_one_entry(folder, tmp_path):
    code = (
        "import pathlib, sys, time\n"
        "from armik_sym.compiled.build import build_library\n"
        "from armik_sym.compiled.compiler import find_compiler\n"
        "cc = find_compiler()\n"
        "pathlib.Path(sys.argv[1]).touch()\n"
        "while not pathlib.Path(sys.argv[2]).exists(): time.sleep(0.001)\n"
        f"print(build_library({_SOURCE!r}, cc).handle.answer())\n"
    )
    go = tmp_path / "go"
    ready = [tmp_path / f"ready{i}" for i in range(3)]
    root = str(Path(build.__file__).parents[2])
    workers = [
        subprocess.Popen(
            [sys.executable, "-c", code, str(flag), str(go)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=root,
        )
        for flag in ready
    ]  # fmt: skip
    while not all(flag.exists() for flag in ready):
        assert all(worker.poll() is None for worker in workers)
    go.touch()
    for worker in workers:
        out, err = worker.communicate(timeout=60)
        assert out.strip() == "42", err
    assert len(entries(folder)) == 1


def test_key_depends_on_source_compiler_and_flags(folder, cc, monkeypatch):
    key = build._key(_SOURCE, cc)
    others = [
        build._key(_SOURCE + " ", cc),
        build._key(_SOURCE, replace(cc, version="another")),
        build._key(_SOURCE, replace(cc, command=(*cc.command, "-g"))),
    ]
    monkeypatch.setattr(Compiler, "flags", ("-O0",))
    others.append(build._key(_SOURCE, cc))
    monkeypatch.setattr(build, "processor", lambda: "another")
    others.append(build._key(_SOURCE, cc))
    assert len({key, *others}) == 6


def test_another_cc_gets_its_own_entry(folder, cc, tmp_path):
    wrapper = script(tmp_path / "wrapped", f'exec {cc.command[0]} "$@"')
    build_library(_SOURCE, cc)
    assert build_library(_SOURCE, replace(cc, command=(str(wrapper),))).compile_time > 0
    assert len(entries(folder)) == 2


def test_failed_compilation_leaves_nothing(folder, cc):
    with pytest.raises(CompilerError, match="no_such_word"):
        build_library("int f(void) { return no_such_word; }\n", cc)
    assert entries(folder) == []


def test_record_says_how_it_was_built(folder, cc):
    library = build_library(_SOURCE, cc)
    record = json.loads((library.path.parent / "record.json").read_text())
    assert record["compiler"] == cc.version
    assert isinstance(library.handle, ctypes.CDLL)


def test_a_library_that_is_intact_but_does_not_load_is_built_again(folder, cc, monkeypatch):
    build_library(_SOURCE, cc)
    genuine, calls = ctypes.CDLL, []

    def fails_once(path):
        calls.append(path)
        if len(calls) == 1:
            raise OSError("wrong ELF class")
        return genuine(path)

    monkeypatch.setattr(ctypes, "CDLL", fails_once)
    again = build_library(_SOURCE, cc)
    assert again.compile_time > 0
    assert _answer(again) == 42
    assert len(entries(folder)) == 1


def test_where_the_cache_cannot_hold_code_a_temporary_folder_does(folder, cc, monkeypatch):
    genuine = ctypes.CDLL

    cache_folder.temporary_folder.cache_clear()

    def refuses_the_cache(path):
        if str(path).startswith(str(folder)):
            raise OSError(1, "failed to map segment")
        return genuine(path)

    monkeypatch.setattr(ctypes, "CDLL", refuses_the_cache)
    with pytest.warns(CacheWarning, match="cannot hold compiled code .*map segment.*temporary folder"):
        library = build_library(_SOURCE, cc)
    assert not library.path.is_relative_to(folder)


def test_where_nothing_can_hold_code_the_error_is_ours(folder, cc, monkeypatch):
    cache_folder.temporary_folder.cache_clear()

    def refuses(path):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(ctypes, "CDLL", refuses)
    with (
        pytest.warns(CacheWarning, match="No space left"),
        pytest.raises(CompilerError, match="neither be stored nor loaded"),
    ):
        build_library(_SOURCE, cc)
