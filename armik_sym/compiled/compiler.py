"""Finding a C compiler and running it."""

from __future__ import annotations

import functools
import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from armik_sym.errors import CompilerError

# IEEE semantics stay intact (NaN in, NaN out): nothing from -ffast-math but errno and traps, which
# this code never reads.
OPTIMISATION = ("-O3", "-fno-math-errno", "-fno-trapping-math")
STANDARD = ("-std=c99", "-fPIC", "-shared", "-fvisibility=hidden")
NATIVE = "-march=native"

HOW_TO_GET = "install one with: pip install ziglang (any platform), or your system's gcc or clang"

_CANDIDATES = ("cc", "gcc", "clang")
# Against hanging only: the first call of zig on a slow machine builds its C library, which takes minutes.
_TIMEOUT = 900.0


@dataclass(frozen=True)
class Compiler:
    """A C compiler that answered when asked for its version.

    Attributes:
        command: The command and its leading arguments.
        version: First line of what it says about its version.
        origin: Where it was found: "$CC", "PATH" or "ziglang".
    """

    command: tuple[str, ...]
    version: str
    origin: str

    def compile_shared(self, source: Path, library: Path) -> None:
        """Compile one C file into a shared library, for this processor if the compiler can tell which.

        Args:
            source: The C file.
            library: Where the library goes.

        Raises:
            CompilerError: If the compiler fails; carries what it printed.

        Source:
            None (packaging).
        """
        try:
            self._run(self.flags, source, library)
        except CompilerError as error:
            # Not every compiler knows -march=native on every processor.
            try:
                self._run(tuple(flag for flag in self.flags if flag != NATIVE), source, library)
            except CompilerError:
                raise error from None

    def _run(self, flags: tuple[str, ...], source: Path, library: Path) -> None:
        command = [*self.command, *flags, "-o", str(library), str(source), "-lm"]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, errors="replace", timeout=_TIMEOUT, check=False
            )
        except (OSError, subprocess.SubprocessError) as error:
            raise CompilerError(
                f"C compiler {shlex.join(self.command)!r} could not run", str(error)
            ) from None
        if done.returncode != 0 or not library.exists():
            raise CompilerError(
                f"C compiler failed with exit code {done.returncode}: {shlex.join(command)}",
                done.stdout + done.stderr,
            )

    @property
    def flags(self) -> tuple[str, ...]:
        """All flags used, part of the cache key."""
        return (*STANDARD, *OPTIMISATION, NATIVE)


def find_compiler() -> Compiler | None:
    """The first C compiler that works: `$CC`, then cc, gcc, clang, then the package ziglang.

    A `$CC` that is set counts alone: whoever set it does not want another one.

    Returns:
        The compiler, or None if there is none.

    Raises:
        CompilerError: If `$CC` is set but cannot be run.

    Source:
        None (POSIX `$CC`).
    """
    return _find(os.environ.get("CC", ""), os.environ.get("PATH", ""))


@functools.cache
def _find(cc: str, path: str) -> Compiler | None:
    if cc.strip():
        try:
            found = _probe(tuple(shlex.split(cc)), "$CC")
        except ValueError as error:
            raise CompilerError(f"CC={cc!r} cannot be read as a command: {error}") from None
        if found is None:
            raise CompilerError(f"CC={cc!r} cannot be run: unset CC or name a working C compiler")
        return found
    for name in _CANDIDATES:
        executable = shutil.which(name, path=path)
        found = _probe((executable,), "PATH") if executable else None
        if found:
            return found
    return _ziglang()


def find_zig() -> Compiler | None:
    """Zig's C compiler, which compiles for every platform: the package ziglang, then zig on the path.

    Returns:
        The compiler, or None if there is none.

    Source:
        None (packaging).
    """
    return _find_zig(os.environ.get("PATH", ""))


@functools.cache
def _find_zig(path: str) -> Compiler | None:
    executable = shutil.which("zig", path=path)
    return _ziglang() or (_probe((executable, "cc"), "PATH") if executable else None)


def _ziglang() -> Compiler | None:
    if importlib.util.find_spec("ziglang") is None:
        return None
    return _probe((sys.executable, "-m", "ziglang", "cc"), "ziglang")


def _probe(command: tuple[str, ...], origin: str) -> Compiler | None:
    try:
        done = subprocess.run(
            [*command, "--version"],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_TIMEOUT,
            check=False,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    if done.returncode != 0:
        return None
    first = done.stdout.strip().splitlines()
    return Compiler(command, first[0] if first else "unknown version", origin)


@functools.cache
def processor() -> str:
    """What `-march=native` means on this machine: part of the cache key.

    Returns:
        Architecture and, where the system tells, processor model and feature flags.

    Source:
        None (Linux: /proc/cpuinfo).
    """
    parts = [platform.machine(), platform.processor()]
    try:
        seen = set()
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            key = line.partition(":")[0].strip()
            if key in {"model name", "flags", "Features", "CPU part"} and key not in seen:
                seen.add(key)
                parts.append(line)
    except OSError:
        pass
    return "\n".join(parts)
