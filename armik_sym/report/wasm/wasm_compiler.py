"""From an arm to the bytes of its WebAssembly module."""

from __future__ import annotations

import functools
import logging
from pathlib import Path

from armik_sym.arm.model import Arm
from armik_sym.compiled.build import build_module
from armik_sym.compiled.compiler import Compiler, find_zig
from armik_sym.compiled.structure import ArmStructure
from armik_sym.errors import CompilerError
from armik_sym.report.wasm.module_source import module_source
from armik_sym.swivel.spherical_arm import why_not_spherical
from armik_sym.symbolic import express

# A library without a main function; zig brings the sines along.
FLAGS = ("-std=c99", "-O2", "-s", "-target", "wasm32-wasi", "-mexec-model=reactor")

NO_COMPILER = "no compiler for WebAssembly was found (pip install ziglang brings one)"

_LOG = logging.getLogger(__name__)


class WasmCompiler(Compiler):
    """A C compiler that is asked for WebAssembly instead of code for this processor."""

    @property
    def flags(self) -> tuple[str, ...]:
        """All flags used, part of the cache key."""
        return FLAGS

    def compile_shared(self, source: Path, library: Path) -> None:
        """Compile one C file into a WebAssembly module.

        Args:
            source: The C file.
            library: Where the module goes.

        Raises:
            CompilerError: If the compiler fails; carries what it printed.

        Source:
            None (packaging).
        """
        # The first time on a machine zig also builds a C library, which takes a minute.
        _LOG.info("compiling the kinematics of the page to WebAssembly")
        self._run(self.flags, source, library)


def wasm_module(arm: Arm) -> tuple[bytes, Compiler]:
    """The WebAssembly module of an arm, compiled once for all arms of its structure.

    Args:
        arm: The arm; its lengths and limits do not matter.

    Returns:
        The module, and the compiler that made it.

    Raises:
        CompilerError: If there is no compiler for WebAssembly, or it fails.

    Source:
        None (packaging).
    """
    zig = find_zig()
    if zig is None:
        raise CompilerError(NO_COMPILER)
    compiler = WasmCompiler(zig.command, zig.version, zig.origin)
    module = _module(ArmStructure.of(arm), why_not_spherical(arm) is None, compiler)
    if isinstance(module, CompilerError):
        raise module
    return module, compiler


@functools.lru_cache(maxsize=16)
def _module(structure: ArmStructure, swivel: bool, compiler: WasmCompiler) -> bytes | CompilerError:
    """The module, or why there is none: several reports do not wait for the same failure."""
    try:
        return build_module(module_source(express(structure.arm), swivel), compiler)
    except CompilerError as error:
        return error
