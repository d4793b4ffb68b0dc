"""What the tests of generated C share: compilers, strict flags, loading."""

from __future__ import annotations

import contextlib
import ctypes
import shutil
import stat
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from armik_sym.compiled import backend, cache_folder, compiler, kinematics

STRICT = (
    "-std=c99",
    "-pedantic",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Wshadow",
    "-Wconversion",
    "-Wdouble-promotion",
)
CC = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")

needs_cc = pytest.mark.skipif(CC is None, reason="no system C compiler")


def build_strictly(source: str, folder: Path, *flags: str) -> ctypes.CDLL:
    """Compile C text with every warning an error, and load it."""
    file, library = folder / "source.c", folder / "library.so"
    file.write_text(source)
    done = subprocess.run(
        [str(CC), *STRICT, "-O2", "-fPIC", "-shared", *flags, "-o", str(library), str(file), "-lm"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return ctypes.CDLL(str(library))


def caller(handle: ctypes.CDLL, name: str, size: int, dtype: type = np.float64) -> Callable[..., np.ndarray]:
    """Call a generated function of plain arrays."""

    def call(*inputs: np.ndarray) -> np.ndarray:
        arrays = [np.ascontiguousarray(x, dtype=dtype) for x in inputs]
        out = np.full(size, -77.0, dtype=dtype)
        getattr(handle, name)(*(ctypes.c_void_p(a.ctypes.data) for a in (*arrays, out)))
        return out

    return call


def forget() -> None:
    """Empty every in-process cache, as a new process would find them."""
    kinematics._program.cache_clear()
    backend.warn_once.cache_clear()
    compiler._find.cache_clear()
    cache_folder.temporary_folder.cache_clear()


@contextlib.contextmanager
def forgotten() -> Iterator[None]:
    """Start and leave with empty in-process caches."""
    forget()
    try:
        yield
    finally:
        forget()


def script(path: Path, body: str) -> Path:
    """An executable shell script."""
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def entries(folder: Path) -> list[str]:
    """Names in a cache folder."""
    return sorted(entry.name for entry in folder.iterdir())
