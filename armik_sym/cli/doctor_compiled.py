"""Checks of what makes kinematics fast: C compiler and cache."""

from __future__ import annotations

import ctypes
import shlex
import stat
import tempfile
import time
from pathlib import Path

from armik_sym.cli.finding import Finding

_SOURCE = """#if defined(_WIN32)
__declspec(dllexport)
#else
__attribute__((visibility("default")))
#endif
int armik_answer(void) { return 42; }
"""
_ANSWER = 42


def check_compiler() -> Finding:
    """Find a C compiler, compile a function with it, load and call that.

    Returns:
        The finding.

    Source:
        None (command line).
    """
    from armik_sym.compiled.compiler import HOW_TO_GET, find_compiler
    from armik_sym.errors import CompilerError

    remedy = f"works without, more slowly; {HOW_TO_GET}"
    try:
        compiler = find_compiler()
        if compiler is None:
            return Finding("C compiler", "missing", "no $CC, cc, gcc, clang or ziglang", remedy)
        began = time.perf_counter()
        with _workplace() as work:
            source, library = Path(work) / "test.c", Path(work) / "test.so"
            source.write_text(_SOURCE, encoding="ascii")
            compiler.compile_shared(source, library)
            answer = ctypes.CDLL(str(library)).armik_answer()
    except (CompilerError, OSError, AttributeError) as error:
        return Finding("C compiler", "broken", " ".join(str(error).split()), remedy)
    name = f"{shlex.join(compiler.command)} ({compiler.version}, from {compiler.origin})"
    if answer != _ANSWER:
        return Finding("C compiler", "broken", f"{name}: compiles wrongly", remedy)
    took = time.perf_counter() - began
    return Finding("C compiler", "found", f"{name}; compiled a test in {took:.2f} s")


def _workplace() -> tempfile.TemporaryDirectory[str]:
    """A folder inside the cache, where compiled code has to load from."""
    from armik_sym.compiled.cache_folder import cache_folder

    return tempfile.TemporaryDirectory(prefix="doctor_", dir=cache_folder(), ignore_cleanup_errors=True)


def check_cache() -> Finding:
    """Look at the folder of compiled code: where, whose, how much.

    Returns:
        The finding.

    Source:
        None (command line).
    """
    from armik_sym.compiled.cache_folder import ENVIRONMENT_VARIABLE, cache_folder

    try:
        folder = cache_folder()
        entries = [entry for entry in folder.iterdir() if entry.is_dir()]
        size = sum(file.stat().st_size for entry in entries for file in entry.rglob("*") if file.is_file())
        mode = stat.S_IMODE(folder.stat().st_mode)
    except OSError as error:
        remedy = f"set {ENVIRONMENT_VARIABLE} to a private writable folder"
        return Finding("cache", "broken", str(error), remedy)
    return Finding("cache", "found", f"{folder} (mode {mode:o}), {len(entries)} entries, {size / 1e6:.1f} MB")
