"""Generated C that evaluates several postures at once in the lanes of SIMD registers.

Two things make the plain loop slow: sine and cosine of libm take turns that a processor cannot predict
for changing angles, and compilers do not vectorise straight-line code across postures. The same
generated function, compiled for a vector type and with a branch-free sine, does both.
"""

from __future__ import annotations

from importlib import resources

import casadi as ca

from armik_sym.compiled.c_constant import Precision, c_constant
from armik_sym.compiled.c_source import c_function

_OPERATIONS = frozenset(
    {
        ca.OP_INPUT, ca.OP_OUTPUT, ca.OP_CONST, ca.OP_ASSIGN, ca.OP_ADD, ca.OP_SUB, ca.OP_MUL, ca.OP_DIV,
        ca.OP_NEG, ca.OP_SQ, ca.OP_TWICE, ca.OP_INV, ca.OP_SIN, ca.OP_COS,
    }
)  # fmt: skip
_LARGEST_CONSTANT = 1e4

_FUNCTION = """\
#if LANES > 1
#undef ONE
#define ONE lanes_of(1.0)
#define real lanes
#define sin lanes_sin
#define cos lanes_cos
static inline {function}
#undef cos
#undef sin
#undef real
#undef ONE
#define ONE 1.0
#endif
"""

_LOOP = """\
EXPORT void {name}_batch(ptrdiff_t n, const real *q, const real *lengths, real *out) {{
#if LANES > 1
  lanes x[{dof}], segments[{segments}], y[{size}];
  for (int j = 0; j < {dof}; ++j) x[j] = lanes_of(0.0);
  for (int j = 0; j < {segments}; ++j) segments[j] = lanes_of({n_lengths} ? lengths[j] : 0.0);
  for (ptrdiff_t start = 0; start < n; start += LANES) {{
    const int count = n - start < LANES ? (int)(n - start) : LANES;
    int all_sound = 1;
    for (int i = 0; i < count; ++i) {{
      for (int j = 0; j < {dof}; ++j) {{
        const real value = q[(start + i) * {dof} + j];
        all_sound &= fabs(value) <= LANES_LARGEST_ANGLE;
        x[j][i] = value;
      }}
    }}
    {name}_lanes(x, segments, y);
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < {size}; ++j) out[(start + i) * {size} + j] = y[j][i];
    if (all_sound) continue;
    for (int i = 0; i < count; ++i) {{
      int sound = 1;
      for (int j = 0; j < {dof}; ++j) sound &= fabs(q[(start + i) * {dof} + j]) <= LANES_LARGEST_ANGLE;
      if (!sound) {name}(q + (start + i) * {dof}, lengths, out + (start + i) * {size});
    }}
  }}
#else
  for (ptrdiff_t i = 0; i < n; ++i) {name}(q + i * {dof}, lengths, out + i * {size});
#endif
}}
"""


def lanes_header() -> str:
    """The hand-written vector types, sine and cosine: C source text."""
    return (resources.files("armik_sym.compiled") / "c" / "lanes.h").read_text(encoding="ascii")


def fits_lanes(function: ca.Function) -> bool:
    """Whether a function of (q, lengths) can run in lanes.

    It may add, multiply, divide and take sines and cosines of ±q + constant; constants above 1e4 could
    push an angle out of the range in which the vector sine is exact.

    Args:
        function: A CasADi Function (q, lengths) → vector.

    Returns:
        True if it can.

    Source:
        None (bookkeeping).
    """
    steps = range(function.n_instructions())
    if any(function.instruction_id(k) not in _OPERATIONS for k in steps):
        return False
    constants = [k for k in steps if function.instruction_id(k) == ca.OP_CONST]
    return all(abs(function.instruction_constant(k)) <= _LARGEST_CONSTANT for k in constants)


def lanes_batch(function: ca.Function, name: str) -> str:
    """C source of a function in lanes and the loop that feeds it.

    Every posture is computed in the same way wherever it stands in the batch; those with an angle above
    1e5 rad, infinite or NaN go through the plain function instead.

    Args:
        function: A CasADi Function (q, lengths) → vector that fits lanes.
        name: Name of the plain C function, already written.

    Returns:
        C source; the loop is `<name>_batch`.

    Source:
        None (packaging).
    """
    n_lengths = function.numel_in(1)
    return lanes_function(function, name) + _LOOP.format(
        name=name,
        dof=function.numel_in(0),
        size=function.numel_out(0),
        n_lengths=n_lengths,
        segments=max(1, n_lengths),
    )


def lanes_function(function: ca.Function, name: str) -> str:
    """C source of a function on vectors, several postures at once, where vector units can be used.

    Args:
        function: A CasADi Function (q, lengths) → vector that fits lanes.
        name: Name of the plain C function.

    Returns:
        C source; the function is `<name>_lanes`, there if `LANES > 1`.

    Source:
        None (packaging).
    """
    return _FUNCTION.format(function=c_function(function, f"{name}_lanes", constant=_splat))


def _splat(value: float, precision: Precision) -> str:
    return f"lanes_of({c_constant(value, precision)})"
