"""Generated C behind `casadi.external`."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from compiled_helpers import build_strictly, needs_cc
from sample_arms import ARMS, BARE, postures

from armik_sym.compiled.c_source import CSignature
from armik_sym.compiled.casadi_abi import casadi_entry_points
from armik_sym.compiled.kinematic_functions import kinematic_functions
from armik_sym.compiled.library_source import casadi_library
from armik_sym.symbolic import express

pytestmark = needs_cc


def _externals(arm, folder):
    functions = kinematic_functions(express(arm))
    # long long is no warning in C99; prototypes of exported functions are CasADi's business.
    handle = build_strictly(casadi_library(functions), folder, "-Wno-missing-prototypes")
    return functions, {name: ca.external(f"armik_{name}", handle._name) for name in functions}


@pytest.mark.parametrize("arm", [ARMS["ehmcs"], ARMS["custom_modified"], BARE], ids=lambda a: a.name)
def test_external_functions_equal_the_virtual_machine(tmp_path, arm):
    functions, externals = _externals(arm, tmp_path)
    for name, f in externals.items():
        assert f.size_in(0) == (arm.dof, 1)
        assert f.size_in(1) == (len(arm.lengths), 1)
        for q in postures(arm, 20):
            wanted = np.array(functions[name](q, arm.length_values))
            np.testing.assert_allclose(np.array(f(q, arm.length_values)), wanted, rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("arm", [ARMS["ehmcs"], BARE], ids=lambda a: a.name)
def test_external_functions_work_in_a_map(tmp_path, arm):
    functions, externals = _externals(arm, tmp_path)
    n = 25
    q = postures(arm, n).T
    lengths = np.tile(arm.length_values[:, None], n)
    mapped = np.array(externals["pose_and_jacobian"].map(n)(q, lengths))
    wanted = np.array(functions["pose_and_jacobian"].map(n)(q, lengths))
    np.testing.assert_allclose(mapped, wanted, rtol=1e-13, atol=1e-15)


def test_external_functions_work_inside_expressions(tmp_path):
    arm = ARMS["ehmcs"]
    _, externals = _externals(arm, tmp_path)
    q = ca.MX.sym("q", 7)
    f = ca.Function("f", [q], [ca.norm_2(externals["position"](q, arm.length_values))])
    assert 0 < float(f(postures(arm, 1)[0])) < arm.reach


def test_an_output_nobody_asks_for_is_not_written():
    text = casadi_entry_points(CSignature("f", (("q", 2), ("lengths", 0)), (("out", 3),)), "armik_f")
    assert "if (arg[0] && res[0]) f(arg[0], arg[1], res[0]);" in text
