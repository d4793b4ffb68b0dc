"""Evaluating many postures, in generated C and in the virtual machine."""

from __future__ import annotations

import numpy as np
import pytest
from compiled_helpers import needs_cc
from sample_arms import ARMS, postures

from armik_sym.compiled.backend import build_or_none
from armik_sym.compiled.batch import CompiledFunction, VirtualMachineFunction
from armik_sym.compiled.kinematic_functions import kinematic_functions
from armik_sym.compiled.library_source import batch_library
from armik_sym.symbolic import express


def _both(arm):
    functions = kinematic_functions(express(arm))
    library = build_or_none(batch_library(functions), "c")
    for f in functions.values():
        yield CompiledFunction(library, f, arm.length_values), VirtualMachineFunction(f, arm.length_values)


@needs_cc
@pytest.mark.parametrize("arm", ARMS.values(), ids=list(ARMS))
def test_c_equals_the_virtual_machine(arm):
    q = postures(arm, 1000, stretch=2.0)
    for in_c, in_vm in _both(arm):
        wanted, found = in_vm.many(q), in_c.many(q)
        # Relative to the largest entry: single entries may cancel to nothing.
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * np.abs(wanted).max())
        for i in (0, 999):
            np.testing.assert_array_equal(in_c.one(q[i]), found[i])
            np.testing.assert_array_equal(in_vm.one(q[i]), wanted[i])


@needs_cc
@pytest.mark.parametrize("n", [0, 1, 2, 7, 8, 9, 255, 256, 257, 600])
def test_every_batch_size_gives_the_same_rows(n):
    arm = ARMS["ehmcs"]
    q = postures(arm, 600)
    for pair in _both(arm):
        for function in pair:
            np.testing.assert_array_equal(function.many(q[:n]), function.many(q)[:n])


def test_the_virtual_machine_writes_into_a_given_array():
    arm = ARMS["ehmcs_4dof"]
    f = kinematic_functions(express(arm))["position"]
    function = VirtualMachineFunction(f, arm.length_values)
    q, out = postures(arm, 300), np.empty((300, 3))
    assert function.many(q, out) is out
    np.testing.assert_array_equal(out, function.many(q))
