"""From C source to a loaded library, through the cache."""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from armik_sym._version import __version__
from armik_sym.compiled.cache_folder import cache_folder, temporary_folder
from armik_sym.compiled.compiler import Compiler, processor
from armik_sym.errors import CompilerError

_LIBRARY = "library.dll" if os.name == "nt" else "library.so"
_RECORD = "record.json"
_SOURCE = "source.c"

_Built = TypeVar("_Built")


@dataclass(frozen=True)
class Library:
    """A loaded shared library.

    Attributes:
        path: The library file.
        handle: The ctypes handle.
        compile_time: Seconds spent compiling now; 0 if it came from the cache.
    """

    path: Path
    handle: ctypes.CDLL
    compile_time: float


def build_library(source: str, compiler: Compiler) -> Library:
    """Compile C source, or take the library from the cache, and load it.

    The key is a hash of source, flags, compiler version and processor. An entry is a folder that
    appears by one atomic rename, so processes compiling at once cannot see half of one; its library
    is checked against a recorded checksum before loading, and built anew if damaged.

    Args:
        source: C source text.
        compiler: The compiler to use.

    Returns:
        The loaded library.

    Raises:
        CompilerError: If the compiler fails, or what it made can neither be stored nor loaded.

    Source:
        None (content-addressed cache).
    """
    return _in_a_folder(lambda folder: _build_in(folder, source, compiler))


def build_module(source: str, compiler: Compiler) -> bytes:
    """Compile C source for something else than this process, or take it from the cache, and read it.

    Args:
        source: C source text.
        compiler: The compiler to use.

    Returns:
        What the compiler made.

    Raises:
        CompilerError: If the compiler fails, or what it made can neither be stored nor read.

    Source:
        None (content-addressed cache, as `build_library`).
    """
    return _in_a_folder(lambda folder: _module_in(folder, source, compiler))


def _in_a_folder(build: Callable[[Path], _Built]) -> _Built:
    """Build in the cache folder, or in a temporary one where that cannot be used."""
    try:
        return build(cache_folder())
    except OSError as error:
        problem = f"cannot hold compiled code ({error.strerror or error})"
    try:
        return build(temporary_folder(problem))
    except OSError as error:
        raise CompilerError("compiled code can neither be stored nor loaded", str(error)) from error


def _module_in(folder: Path, source: str, compiler: Compiler) -> bytes:
    entry = folder / _key(source, compiler)
    if not _is_sound(entry):
        _compile_into(entry, source, compiler)
    return (entry / _LIBRARY).read_bytes()


def _build_in(folder: Path, source: str, compiler: Compiler) -> Library:
    """Take the library from a folder, or compile it there; one that does not load is compiled anew."""
    entry = folder / _key(source, compiler)
    started = time.perf_counter()
    if _is_sound(entry):
        try:
            return Library(entry / _LIBRARY, ctypes.CDLL(str(entry / _LIBRARY)), 0.0)
        except OSError:
            shutil.rmtree(entry, ignore_errors=True)
    _compile_into(entry, source, compiler)
    handle = ctypes.CDLL(str(entry / _LIBRARY))
    return Library(entry / _LIBRARY, handle, time.perf_counter() - started)


def _key(source: str, compiler: Compiler) -> str:
    parts = (__version__, source, *compiler.command, compiler.version, *compiler.flags, processor())
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:40]


def _is_sound(entry: Path) -> bool:
    try:
        record = json.loads((entry / _RECORD).read_text(encoding="utf-8"))
        return bool(record["sha256"] == _checksum(entry / _LIBRARY))
    except (OSError, ValueError, KeyError, TypeError):
        return False


def _checksum(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def _compile_into(entry: Path, source: str, compiler: Compiler) -> None:
    work = Path(tempfile.mkdtemp(prefix=f"{entry.name}.", dir=entry.parent))
    try:
        (work / _SOURCE).write_text(source, encoding="utf-8")
        compiler.compile_shared(work / _SOURCE, work / _LIBRARY)
        record = {"sha256": _checksum(work / _LIBRARY), "compiler": compiler.version, "flags": compiler.flags}
        (work / _RECORD).write_text(json.dumps(record), encoding="utf-8")
        _publish(work, entry)
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _publish(work: Path, entry: Path) -> None:
    """Rename the finished folder to its final name; a sound entry of another process wins."""
    for _ in range(5):
        try:
            work.rename(entry)
            return
        except OSError:
            if _is_sound(entry):
                return
            # A damaged entry: move it aside in one step, so that nobody sees it half deleted.
            aside = Path(tempfile.mkdtemp(prefix=f"{entry.name}.", dir=entry.parent))
            try:
                entry.replace(aside / "damaged")
            except OSError:
                pass
            finally:
                shutil.rmtree(aside, ignore_errors=True)
    work.rename(entry)
