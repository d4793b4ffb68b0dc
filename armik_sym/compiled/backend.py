"""Choosing between generated C and CasADi's virtual machine."""

from __future__ import annotations

import functools
import warnings
from typing import Literal

from armik_sym.compiled.build import Library, build_library
from armik_sym.compiled.compiler import HOW_TO_GET, find_compiler
from armik_sym.errors import CompilerError, CompilerWarning, OptionError

Backend = Literal["auto", "c", "vm"]


def build_or_none(source: str, backend: Backend) -> Library | None:
    """Build a C library as far as the machine and the wish allow.

    Args:
        source: C source text.
        backend: "c" demands a compiler, "vm" wants none, "auto" takes one if it works.

    Returns:
        The library, or None where CasADi's virtual machine shall serve.

    Raises:
        CompilerError: If `backend` is "c" and no compiler works.
        OptionError: If `backend` is another word.

    Source:
        None (packaging).
    """
    if backend not in ("auto", "c", "vm"):
        raise OptionError(f"backend is {backend!r}: valid are auto, c, vm")
    if backend == "vm":
        return None
    try:
        compiler = find_compiler()
        if compiler is None:
            remedy = f": {HOW_TO_GET}" if backend == "c" else ""
            raise CompilerError(f"no C compiler found ($CC, cc, gcc, clang, ziglang){remedy}")
        return build_library(source, compiler)
    except CompilerError as error:
        if backend == "c":
            raise
        warn_once(str(error))
        return None


@functools.cache
def warn_once(reason: str) -> None:
    """Say, once per process and reason, that compiled code is not used.

    Args:
        reason: Why.

    Source:
        None (packaging).
    """
    warnings.warn(
        f"{reason}.\nEverything works without compiled code, more slowly, in CasADi's virtual machine. "
        f"For full speed {HOW_TO_GET}.",
        CompilerWarning,
        stacklevel=5,
    )
