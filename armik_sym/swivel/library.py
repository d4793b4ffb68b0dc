"""The shared library of the swivel angle: generated closed form and hand-written loops, one for all arms."""

from __future__ import annotations

import functools

import casadi as ca

from armik_sym.compiled.backend import Backend, build_or_none
from armik_sym.compiled.build import Library
from armik_sym.compiled.c_source import c_function, signature_of
from armik_sym.compiled.hand_written import loop_text
from armik_sym.compiled.lanes import fits_lanes, lanes_function, lanes_header
from armik_sym.compiled.library_source import PRELUDE
from armik_sym.swivel.constants import NEAR, PARALLEL, POLE, REACH, ROUNDING, ROUNDS, TIE
from armik_sym.swivel.expressions import swivel_functions

# The hand-written C, in the order in which one file needs the other.
LOOPS = (
    "swivel_arm.h", "swivel_triple.h", "swivel_postures.h", "swivel_posture_batch.h",
    "swivel_margins.h", "swivel_cuts.h", "swivel_intervals.h", "swivel_blocking.h",
)  # fmt: skip

_ROWS = """\
EXPORT void armik_{name}_rows(ptrdiff_t n, {arguments}, real *out) {{
  for (ptrdiff_t i = 0; i < n; ++i) armik_{name}({values}, out + i * {size});
}}
"""


@functools.lru_cache(maxsize=8)
def swivel_library(backend: Backend = "auto") -> Library | None:
    """The loops of the swivel angle, compiled once for all arms: geometry and limits are arguments.

    Args:
        backend: "auto", "c" or "vm" (no library: NumPy and CasADi's virtual machine serve).

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
    return build_or_none(swivel_source(), backend)


def swivel_source() -> str:
    """C source of the library.

    Function `f` of `swivel_functions` becomes `armik_f`, with a loop `armik_f_rows` over samples.

    Returns:
        C source.

    Source:
        None (packaging).
    """
    parts = [PRELUDE, "#include <string.h>", lanes_header(), loop_text("lanes_atan2.h")]
    parts += swivel_constants()
    for name, function in swivel_functions().items():
        parts.append("static inline " + c_function(function, f"armik_{name}"))
        if fits_lanes(function):
            parts.append(lanes_function(function, f"armik_{name}"))
        parts.append(_rows(function, name))
    return "\n".join([*parts, *(loop_text(name) for name in LOOPS)])


def swivel_constants() -> list[str]:
    """The numbers of `swivel/constants.py` as the hand-written C knows them.

    Returns:
        Lines of C.

    Source:
        None (packaging).
    """
    constants = {
        "ROUNDING": ROUNDING, "REACH": REACH, "POLE": POLE, "NEAR": NEAR, "PARALLEL": PARALLEL,
        "ROUNDS": ROUNDS, "TIE": TIE,
    }  # fmt: skip
    return [f"#define SWIVEL_{name} {value!r}" for name, value in constants.items()]


def _rows(function: ca.Function, name: str) -> str:
    inputs = [input_name for input_name, _ in signature_of(function, name).inputs]
    return _ROWS.format(
        name=name,
        arguments=", ".join(f"const real *{key}, ptrdiff_t {key}_step" for key in inputs),
        values=", ".join(f"{key} + i * {key}_step" for key in inputs),
        size=function.numel_out(0),
    )
