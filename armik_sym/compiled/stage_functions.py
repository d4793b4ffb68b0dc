"""Residual, Jacobian and Hessian of one sample, compiled for use inside CasADi problems.

A whole-trajectory problem calls these once per sample, so its length never compiles anything.
"""

from __future__ import annotations

import functools
import time
from dataclasses import dataclass

import casadi as ca

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend, build_or_none
from armik_sym.compiled.library_source import casadi_library
from armik_sym.compiled.structure import ArmStructure
from armik_sym.symbolic import ArmExpressions, Orientation, express, tracking_residual
from armik_sym.symbolic.dense_function import dense_function


@dataclass(frozen=True, eq=False)
class StageFunctions:
    """One sample's tracking equations r(q, lengths, target) and their exact derivatives.

    Attributes:
        residual: (q, lengths, target) → r, shape (m, 1).
        jacobian: (q, lengths, target) → dr/dq column by column, shape (m·dof, 1).
        hessian: (q, lengths, target, multipliers) → d²(multipliersᵀ r)/dq², shape (dof·dof, 1).
        backend: "c" or "vm".
        build_time: Seconds spent on expressions in this process.
        compile_time: Seconds the C compiler took; 0 if the cache had the library.
    """

    residual: ca.Function
    jacobian: ca.Function
    hessian: ca.Function
    backend: str
    build_time: float
    compile_time: float


def compile_stage(arm: Arm, orientation: Orientation, backend: Backend = "auto") -> StageFunctions:
    """Compile the tracking equations of one sample, once for all arms of the same structure.

    r(q, target), dr/dq and d²(λᵀ r)/dq², see `symbolic.tracking_residual`.

    Args:
        arm: The arm.
        orientation: What the path prescribes.
        backend: "auto", "c" or "vm".

    Returns:
        The functions.

    Raises:
        CompilerError: If `backend` is "c" and no compiler works.

    Source:
        None (exact derivatives by CasADi).
    """
    return _program(ArmStructure.of(arm), orientation, backend)


def stage_expressions(arm: ArmExpressions, orientation: Orientation) -> dict[str, ca.Function]:
    """The tracking equations and their derivatives as SX Functions.

    Args:
        arm: Symbolic kinematics with lengths as parameters.
        orientation: What the path prescribes.

    Returns:
        `residual`, `jacobian` and `hessian`, as in `StageFunctions`.

    Source:
        None (exact derivatives by CasADi).
    """
    tracked = tracking_residual(arm, orientation)
    multipliers = ca.SX.sym("multipliers", orientation.equations)
    jacobian = ca.jacobian(tracked.residual, arm.q)
    hessian, _ = ca.hessian(ca.dot(multipliers, tracked.residual), arm.q)
    inputs = {"q": arm.q, "lengths": arm.lengths, "target": tracked.target}
    return {
        "residual": dense_function("residual", inputs, tracked.residual),
        "jacobian": dense_function("jacobian", inputs, ca.vec(jacobian)),
        "hessian": dense_function("hessian", inputs | {"multipliers": multipliers}, ca.vec(hessian)),
    }


@functools.lru_cache(maxsize=64)
def _program(structure: ArmStructure, orientation: Orientation, backend: Backend) -> StageFunctions:
    started = time.perf_counter()
    functions = stage_expressions(express(structure.arm), orientation)
    source = casadi_library(functions)
    build_time = time.perf_counter() - started
    library = build_or_none(source, backend)
    if library is None:
        return StageFunctions(**functions, backend="vm", build_time=build_time, compile_time=0.0)
    loaded = {name: ca.external(f"armik_{name}", str(library.path)) for name in functions}
    return StageFunctions(**loaded, backend="c", build_time=build_time, compile_time=library.compile_time)
