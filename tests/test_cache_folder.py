"""The private cache folder."""

from __future__ import annotations

import os
import stat
import warnings
from pathlib import Path

import platformdirs
import pytest
from compiled_helpers import forgotten

from armik_sym.compiled.cache_folder import cache_folder
from armik_sym.errors import CacheWarning


@pytest.fixture(autouse=True)
def _fresh():
    with forgotten():
        yield


def _expect_temporary(reason: str, wanted: Path) -> Path:
    with pytest.warns(CacheWarning, match=reason) as caught:
        folder = cache_folder()
    assert len(caught) == 1
    assert "ARMIK_CACHE_DIR" in str(caught[0].message)
    assert folder != wanted
    assert folder.is_dir()
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert cache_folder() == folder  # the same one, and no second warning
    return folder


def test_is_created_private(tmp_path, monkeypatch):
    wanted = tmp_path / "a" / "b"
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(wanted))
    old = os.umask(0)
    try:
        assert cache_folder() == wanted
    finally:
        os.umask(old)
    assert stat.S_IMODE(wanted.stat().st_mode) == 0o700


def test_default_is_the_platforms_cache(tmp_path, monkeypatch):
    monkeypatch.delenv("ARMIK_CACHE_DIR", raising=False)
    monkeypatch.setattr(platformdirs, "user_cache_dir", lambda *a, **k: str(tmp_path / "user"))
    assert cache_folder() == tmp_path / "user"


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o777, 0o720])
def test_folder_others_may_write_to_is_refused(tmp_path, monkeypatch, mode):
    wanted = tmp_path / "shared"
    wanted.mkdir()
    wanted.chmod(mode)
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(wanted))
    _expect_temporary("can be written by other users", wanted)


def test_folder_of_another_user_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path / "cache"))
    me = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: me + 1)
    _expect_temporary("belongs to another user", tmp_path / "cache")


def test_folder_that_cannot_be_created(monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", "/dev/null/x")
    _expect_temporary("cannot be created", Path("/dev/null/x"))


def test_cache_path_that_is_a_file(tmp_path, monkeypatch):
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(file))
    _expect_temporary("cannot be created", file)


def test_read_only_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(os, "access", lambda *a, **k: False)
    _expect_temporary("is read-only", tmp_path / "cache")
