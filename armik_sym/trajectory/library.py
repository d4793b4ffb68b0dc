"""The shared library of the whole-trajectory method: angles over the swivel angle and hand-written loops."""

from __future__ import annotations

import functools

from armik_sym.compiled.backend import Backend, build_or_none
from armik_sym.compiled.build import Library
from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.hand_written import loop_text
from armik_sym.compiled.library_source import PRELUDE
from armik_sym.trajectory.one_curve.stage import SIZE, curve_functions

_LOOPS = ("curve_objective.h", "curve_descent.h", "shortest_path.h", "smoothest_path.h")


@functools.lru_cache(maxsize=8)
def trajectory_library(backend: Backend = "auto") -> Library | None:
    """The loops of the whole-trajectory method, compiled once for all arms.

    Args:
        backend: "auto", "c" or "vm" (no library: the NumPy implementations serve).

    Returns:
        The library, or None.

    Raises:
        CompilerError: If `backend` is "c" and no compiler works.
        OptionError: If `backend` is another word.

    Source:
        None (packaging).
    """
    if backend == "vm":
        return None
    return build_or_none(library_source(), backend)


def library_source() -> str:
    """C source of the library.

    Returns:
        C source text.

    Source:
        None (packaging).
    """
    parts = [PRELUDE, f"#define CURVE_PARAMETERS {SIZE}\n"]
    parts += ["static inline " + c_function(f, f"armik_{name}") for name, f in curve_functions().items()]
    return "\n".join([*parts, *(loop_text(name) for name in _LOOPS)])
