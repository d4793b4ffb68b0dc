"""Several postures at once in SIMD lanes."""

from __future__ import annotations

import ctypes

import casadi as ca
import numpy as np
import pytest
from compiled_helpers import build_strictly, caller, needs_cc

from armik_sym.compiled.lanes import fits_lanes, lanes_header
from armik_sym.compiled.library_source import batch_library

_HARNESS = """
#include <math.h>
#include <stddef.h>
{header}
void turns(const double *x, double *s, double *c);
void turns(const double *x, double *s, double *c) {{
  for (int start = 0; start < {n}; start += LANES) {{
    lanes v = lanes_of(0.0);
    for (int i = 0; i < LANES; ++i) v[i] = x[start + i];
    const lanes a = lanes_sin(v), b = lanes_cos(v);
    for (int i = 0; i < LANES; ++i) s[start + i] = a[i];
    for (int i = 0; i < LANES; ++i) c[start + i] = b[i];
  }}
}}
"""


def _angles() -> np.ndarray:
    rng = np.random.default_rng(0)
    quarters = np.arange(-63_000, 63_000, 41) * (np.pi / 2)
    close = np.concatenate(
        [np.nextafter(quarters, np.inf), quarters, quarters + 1e-9 * rng.standard_normal(len(quarters))]
    )
    x = np.concatenate(
        [rng.uniform(-7, 7, 50_000), rng.uniform(-1e5, 1e5, 50_000), close, [0.0, -0.0, 1e-300, 1e5, -1e5]]
    )
    return np.resize(x, 8 * (len(x) // 8))


@needs_cc
@pytest.mark.parametrize("flags", [("-march=native",), ("-march=native", "-ffp-contract=fast"), ("-O0",)])
def test_sine_and_cosine_are_right_to_rounding(tmp_path, flags):
    x = _angles()
    handle = build_strictly(_HARNESS.format(header=lanes_header(), n=len(x)), tmp_path, *flags)
    s = np.empty(len(x))
    c = caller(handle, "turns", len(x))(x, s)
    np.testing.assert_allclose(s, np.sin(x), rtol=0, atol=2.3e-16)
    np.testing.assert_allclose(c, np.cos(x), rtol=0, atol=2.3e-16)


def _function(value: ca.SX, q: ca.SX) -> ca.Function:
    return ca.Function("f", [q, ca.SX.sym("lengths", 0)], [value], ["q", "lengths"], ["out"])


def test_only_what_lanes_can_do_runs_in_lanes():
    q = ca.SX.sym("q", 2)
    assert fits_lanes(_function(ca.sin(q) * q[0] / (1 + q[1] ** 2), q))
    assert not fits_lanes(_function(ca.sqrt(q), q))
    assert not fits_lanes(_function(ca.sin(q + 2e4), q))


@needs_cc
@pytest.mark.parametrize("lanes", [1, 2, 4, 8])
def test_every_width_gives_the_same(tmp_path, lanes):
    q = ca.SX.sym("q", 2)
    f = _function(ca.vertcat(ca.sin(q[0]) * q[1], ca.cos(q[1]) - 1 / q[0], 0, -1.5, q[0]), q)
    source = batch_library({"f": f}).replace(
        "#if LANES > 1\ntypedef", f"#undef LANES\n#define LANES {lanes}\n#if LANES > 1\ntypedef", 1
    )
    prototype = "void armik_f_batch(ptrdiff_t n, const real *q, const real *lengths, real *out);\n"
    source = source.replace("EXPORT void", prototype + "EXPORT void", 1)
    handle = build_strictly(source, tmp_path, "-Wno-psabi")
    x = np.random.default_rng(0).uniform(-3, 3, (13, 2))
    x[4] = np.nan, 1.0
    x[7] = 1e300, np.inf
    out = np.full((14, 5), 7.0)
    handle.armik_f_batch(
        ctypes.c_ssize_t(13), *(ctypes.c_void_p(a) for a in (x.ctypes.data, None, out.ctypes.data))
    )
    wanted = np.array([np.array(f(row, [])).ravel() for row in x])
    np.testing.assert_allclose(out[:13], wanted, rtol=1e-14, atol=1e-15)
    assert np.all(out[13] == 7.0)
