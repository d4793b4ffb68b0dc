"""Every operation with a C99 spelling against CasADi's virtual machine."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from compiled_helpers import build_strictly, caller, needs_cc

from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.operations import C_OPERATIONS
from armik_sym.errors import OptionError

_UNARY = {
    "neg": lambda x: -x, "sq": lambda x: x * x, "twice": lambda x: x + x, "inv": lambda x: 1 / x,
    "sqrt": ca.sqrt, "sin": ca.sin, "cos": ca.cos, "tan": ca.tan, "asin": ca.asin, "acos": ca.acos,
    "atan": ca.atan, "sinh": ca.sinh, "cosh": ca.cosh, "tanh": ca.tanh, "asinh": ca.asinh, "acosh": ca.acosh,
    "atanh": ca.atanh, "exp": ca.exp, "log": ca.log, "log1p": ca.log1p, "expm1": ca.expm1, "erf": ca.erf,
    "fabs": ca.fabs, "floor": ca.floor, "ceil": ca.ceil, "sign": ca.sign, "not": ca.logic_not,
    "constpow": lambda x: x**2.5,
}  # fmt: skip
_BINARY = {
    "add": lambda x, y: x + y, "sub": lambda x, y: x - y, "mul": lambda x, y: x * y,
    "div": lambda x, y: x / y, "pow": lambda x, y: x**y, "atan2": ca.atan2, "fmin": ca.fmin, "fmax": ca.fmax,
    "hypot": ca.hypot, "copysign": ca.copysign, "fmod": ca.fmod, "remainder": ca.remainder,
    "lt": lambda x, y: x < y, "le": lambda x, y: x <= y, "eq": lambda x, y: x == y, "ne": lambda x, y: x != y,
    "and": ca.logic_and, "or": ca.logic_or, "if_else_zero": lambda x, y: ca.if_else(x, y, 0),
}  # fmt: skip
_NAMES = [*_UNARY, *_BINARY]
_SPECIAL = [0.0, -0.0, 0.3, -0.7, 1.0, -1.0, 2.5, -3.25, 1e-30, 7e5, np.inf, -np.inf, np.nan]


def _single_operations() -> ca.Function:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    values = [f(x) for f in _UNARY.values()] + [f(x, y) for f in _BINARY.values()]
    return ca.Function("ops", [x, y], [ca.vertcat(*values)], ["x", "y"], ["out"])


def _source(function: ca.Function, precision: str) -> str:
    one = {"double": "1.0", "float": "1.0f"}[precision]
    body = c_function(function, "ops", precision)
    return f"#include <math.h>\ntypedef {precision} real;\n#define ONE {one}\n{_prototype(body)}\n{body}"


def _prototype(body: str) -> str:
    return body[: body.index(" {")] + ";"


def test_every_spelled_operation_is_exercised():
    function = _single_operations()
    used = {function.instruction_id(k) for k in range(function.n_instructions())}
    assert set(C_OPERATIONS) - used == {ca.OP_ASSIGN}


@needs_cc
@pytest.mark.parametrize(
    ("precision", "dtype", "tolerance"), [("double", np.float64, 1e-14), ("float", np.float32, 1e-6)]
)
def test_single_operations_equal_the_virtual_machine(tmp_path, precision, dtype, tolerance):
    function = _single_operations()
    call = caller(build_strictly(_source(function, precision), tmp_path), "ops", len(_NAMES), dtype)
    for x in _SPECIAL:
        for y in _SPECIAL:
            a, b = float(dtype(x)), float(dtype(y))
            wanted = np.array(function(a, b)).ravel()
            found = call(np.array([a]), np.array([b])).astype(np.float64)
            with np.errstate(over="ignore"):
                wanted = wanted.astype(dtype).astype(np.float64)
            for name, f, w in zip(_NAMES, found, wanted, strict=True):
                if name in {"sin", "cos", "tan"} and precision == "float" and abs(x) > 1e4:
                    continue  # conditioning, not spelling
                assert (np.isnan(f) and np.isnan(w)) or f == w or abs(f - w) <= tolerance * abs(w), (
                    name,
                    x,
                    y,
                    f,
                    w,
                )


@needs_cc
@pytest.mark.parametrize("seed", range(12))
def test_random_expressions_of_all_operations_equal_the_virtual_machine(tmp_path, seed):
    rng = np.random.default_rng(seed)
    symbols = ca.SX.sym("x", 4)
    pool = [symbols[i] for i in range(4)] + [ca.SX(0.5), ca.SX(-1.25)]
    for name in rng.permutation(_NAMES):
        # Bounded, and one-to-one enough that every operation keeps mattering.
        a, b = (ca.tanh(pool[rng.integers(len(pool))]) * 0.9 for _ in range(2))
        if name == "copysign":
            b = ca.fmax(b, -1)  # the sign of a NaN is nobody's promise
        pool.append(_UNARY[name](a) if name in _UNARY else _BINARY[name](a, b))
    function = ca.Function("ops", [symbols], [ca.vertcat(*pool)], ["x"], ["out"])
    call = caller(build_strictly(_source(function, "double"), tmp_path), "ops", len(pool))
    for x in (*rng.standard_normal((20, 4)), np.array([np.nan, 1, 2, 3]), np.array([np.inf, -np.inf, 0, 1])):
        np.testing.assert_allclose(call(x), np.array(function(x)).ravel(), rtol=1e-13, atol=1e-13)


def test_operation_without_spelling_is_named():
    x = ca.SX.sym("x")
    with pytest.raises(OptionError, match="OP_ERFINV has no C99 spelling"):
        c_function(ca.Function("f", [x], [ca.erfinv(x)]), "f")
