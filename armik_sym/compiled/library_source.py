"""C source of the libraries that Python loads: generated functions and their batch loops."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from armik_sym.compiled.c_source import c_function, signature_of
from armik_sym.compiled.casadi_abi import casadi_entry_points
from armik_sym.compiled.lanes import fits_lanes, lanes_batch, lanes_header

PRELUDE = """\
#include <math.h>
#include <stddef.h>
typedef double real;
#define ONE 1.0
#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
"""

_BATCH = """\
EXPORT void {name}_batch(ptrdiff_t n, const real *q, const real *lengths, real *out) {{
  for (ptrdiff_t i = 0; i < n; ++i) {name}(q + i * {dof}, lengths, out + i * {size});
}}
"""


def batch_library(functions: Mapping[str, ca.Function]) -> str:
    """C source with a loop over postures for every function of (q, lengths).

    out_i = f(q_i, lengths) for i = 0 … n-1, postures one after the other in memory.

    Args:
        functions: CasADi Functions (q, lengths) → vector, by name.

    Returns:
        C source; function `f` becomes `armik_f_batch`.

    Source:
        None (packaging).
    """
    parts = [PRELUDE, lanes_header()]
    for name, function in functions.items():
        c_name = f"armik_{name}"
        parts.append("static " + c_function(function, c_name))
        if fits_lanes(function):
            parts.append(lanes_batch(function, c_name))
            continue
        parts.append(_BATCH.format(name=c_name, dof=function.numel_in(0), size=function.numel_out(0)))
    return "\n".join(parts)


def casadi_library(functions: Mapping[str, ca.Function]) -> str:
    """C source of functions that `casadi.external` can load.

    Args:
        functions: CasADi Functions of SX type with one dense output, by name.

    Returns:
        C source; function `f` is found by CasADi as `armik_f`.

    Source:
        CasADi user guide, "Using the generated code".
    """
    parts = [PRELUDE]
    for name, function in functions.items():
        parts.append("static " + c_function(function, f"{name}_values"))
        parts.append(casadi_entry_points(signature_of(function, f"{name}_values"), f"armik_{name}"))
    return "\n".join(parts)
