"""C source of single functions and constants."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np
import pytest
from compiled_helpers import build_strictly, caller, needs_cc
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.compiled.c_constant import c_constant, check_precision
from armik_sym.compiled.c_source import c_function, signature_of
from armik_sym.errors import OptionError

_HEAD = "#include <math.h>\ntypedef double real;\n#define ONE 1.0\n"


def _number(text: str) -> float:
    return float(text.strip("()").removesuffix("f"))


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_double_constants_read_back(value):
    text = c_constant(value, "double")
    assert _number(text) == value
    assert text.startswith("(-") == (math.copysign(1, value) < 0)
    assert any(c in text for c in ".e")


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_float_constants_read_back(value):
    text = c_constant(value, "float")
    assert text.rstrip(")").endswith("f")
    assert np.float32(_number(text)) == np.float32(value)


def test_float_constants_are_rounded_not_cut_off():
    assert c_constant(0.1, "float") == "0.1f"
    assert c_constant(1 / 3, "float") == "0.33333334f"
    assert c_constant(1e-60, "float") == "0.0f"
    assert c_constant(-1e60, "float") == "(-(float)INFINITY)"


@pytest.mark.parametrize("precision", ["double", "float"])
def test_constants_that_are_no_numbers(precision):
    # The macros are of type float: a cast keeps double code free of silent promotion.
    assert c_constant(math.nan, precision) == f"(({precision})NAN)"
    assert c_constant(-math.nan, precision) == f"(({precision})NAN)"
    assert c_constant(math.inf, precision) == f"({precision})INFINITY"
    assert c_constant(-math.inf, precision) == f"(-({precision})INFINITY)"
    assert c_constant(-0.0, precision).startswith("(-0.0")


def test_precision_is_one_of_two():
    assert check_precision("float") == "float"
    with pytest.raises(OptionError, match="precision is 'half': valid are double, float"):
        check_precision("half")


def test_signature_names_arrays_and_sizes():
    x, p = ca.SX.sym("x", 3), ca.SX.sym("p", 0)
    f = ca.Function("f", [x, p], [x, x.T @ x], ["x", "p"], ["same", "square"])
    signature = signature_of(f, "g")
    assert signature.inputs == (("x", 3), ("p", 0))
    assert signature.outputs == (("same", 3), ("square", 1))
    assert signature.declaration("real") == (
        "void g(const real *restrict x, const real *restrict p, real *restrict same, real *restrict square)"
    )


@needs_cc
def test_unused_inputs_constants_and_several_outputs_compile_strictly(tmp_path):
    x, unused = ca.SX.sym("x", 2), ca.SX.sym("unused", 2)
    constants = ca.SX(ca.DM([0.0, -0.0, -1.5, math.inf, -math.inf, math.nan]))
    values = ca.vertcat(x[0] - constants[2], -x[1], constants)
    f = ca.Function("f", [x, unused], [values, x[1]], ["x", "unused"], ["values", "last"])
    text = c_function(f, "f")
    handle = build_strictly(_HEAD + text[: text.index(" {")] + ";\n" + text, tmp_path)
    out = np.zeros(8)
    found = caller(handle, "f", 1)(np.array([1.0, 2.0]), np.zeros(2), out)
    np.testing.assert_array_equal(out, [2.5, -2.0, 0.0, 0.0, -1.5, np.inf, -np.inf, np.nan])
    assert found[0] == 2.0


@needs_cc
def test_outputs_are_written_column_by_column(tmp_path):
    x = ca.SX.sym("x", 2, 3)
    f = ca.Function("f", [x], [x.T], ["x"], ["out"])
    text = c_function(f, "f")
    handle = build_strictly(_HEAD + text[: text.index(" {")] + ";\n" + text, tmp_path)
    matrix = np.arange(6.0).reshape(2, 3)
    found = caller(handle, "f", 6)(matrix.ravel(order="F"))
    np.testing.assert_array_equal(found.reshape(3, 2, order="F"), matrix.T)


def test_sparse_and_matrix_functions_are_refused():
    x = ca.SX.sym("x", 2)
    with pytest.raises(OptionError, match="'y' is sparse, densify"):
        c_function(ca.Function("f", [x], [ca.diag(x)], ["x"], ["y"]), "f")
    z = ca.MX.sym("z", 2)
    with pytest.raises(OptionError, match="'g' is no SX function: expand"):
        c_function(ca.Function("g", [z], [ca.sin(z)]), "g")
