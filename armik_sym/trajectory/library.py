"""The shared library of the whole-trajectory method: angles over the swivel angle and hand-written loops."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from importlib import resources

from armik_sym.compiled.backend import Backend, build_or_none
from armik_sym.compiled.build import Library
from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.library_source import PRELUDE
from armik_sym.trajectory.one_curve.stage import SIZE, curve_functions

_LOOPS = ("curve_objective.h", "curve_descent.h", "shortest_path.h", "smoothest_path.h")


@dataclass(frozen=True, eq=False)
class TrajectoryLibrary:
    """Compiled loops, the same for every arm.

    Attributes:
        library: The loaded library, or None where NumPy has to serve.
    """

    library: Library | None

    @property
    def compile_time(self) -> float:
        """Seconds the C compiler took; 0 if the cache had the library."""
        return self.library.compile_time if self.library else 0.0


@functools.lru_cache(maxsize=8)
def trajectory_library(backend: Backend = "auto") -> TrajectoryLibrary:
    """Compile the loops of the whole-trajectory method.

    Args:
        backend: "auto", "c" or "vm" (no library: the NumPy implementations serve).

    Returns:
        The library.

    Raises:
        CompilerError: If `backend` is "c" and no compiler works.

    Source:
        None (packaging).
    """
    return TrajectoryLibrary(build_or_none(library_source(), backend))


def library_source() -> str:
    """C source of the library.

    Returns:
        C source text.

    Source:
        None (packaging).
    """
    parts = [PRELUDE, f"#define CURVE_PARAMETERS {SIZE}\n"]
    parts += ["static inline " + c_function(f, f"armik_{name}") for name, f in curve_functions().items()]
    folder = resources.files("armik_sym.compiled") / "c"
    parts += [(folder / name).read_text(encoding="ascii") for name in _LOOPS]
    return "\n".join(parts)
