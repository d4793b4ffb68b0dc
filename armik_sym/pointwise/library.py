"""The shared library of the pointwise methods: generated kinematics and the hand-written loops."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend, build_or_none
from armik_sym.compiled.build import Library
from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.hand_written import loop_text
from armik_sym.compiled.lanes import fits_lanes, lanes_function, lanes_header
from armik_sym.compiled.library_source import PRELUDE
from armik_sym.compiled.structure import ArmStructure
from armik_sym.symbolic import express
from armik_sym.symbolic.alfaiz_closed_form import closed_form_fits, search_functions
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.symbolic.row_order import row_by_row

# The hand-written C, in the order in which one file needs the other.
LOOPS = (
    "random_stream.h", "real_math.h",
    "isade_settings.h", "isade_cost.h", "isade_generation.h", "isade.h",
    "small_cholesky.h", "pose_residual.h", "bounded_step.h", "damped_pose.h", "damped_path.h",
)  # fmt: skip
ALFAIZ_LOOPS = ("lanes_atan2.h", "alfaiz_curve.h", "alfaiz_search.h")


@dataclass(frozen=True, eq=False)
class PointwiseLibrary:
    """Compiled loops of one kind of arm.

    Attributes:
        library: The loaded library, or None where NumPy has to serve.
    """

    library: Library | None

    @property
    def compile_time(self) -> float:
        """Seconds the C compiler took; 0 if the cache had the library."""
        return self.library.compile_time if self.library else 0.0


def pointwise_library(arm: Arm, backend: Backend = "auto") -> PointwiseLibrary:
    """Compile the loops of all pointwise methods, once for all arms of the same structure.

    Args:
        arm: The arm.
        backend: "auto", "c" or "vm" (no library: the NumPy implementations serve).

    Returns:
        The library.

    Raises:
        CompilerError: If `backend` is "c" and no compiler works.

    Source:
        None (packaging).
    """
    return _library(ArmStructure.of(arm), backend)


def pointwise_source(functions: Mapping[str, ca.Function], dof: int, loops: tuple[str, ...] = LOOPS) -> str:
    """C source: generated functions of (q, lengths), plain and in lanes, then the hand-written loops.

    Function `f` becomes `armik_f(q, lengths, out)` and, where vector units can be used (`LANES > 1`),
    `armik_f_lanes` on arrays of `lanes`.

    Args:
        functions: CasADi Functions (q, lengths) → vector, by name.
        dof: Number of joints, the macro DOF.
        loops: Names of the hand-written files.

    Returns:
        C source.

    Source:
        None (packaging).
    """
    n_lengths = next(iter(functions.values())).numel_in(1)
    parts = [PRELUDE, lanes_header(), f"#define DOF {dof}\n#define N_LENGTHS {n_lengths}\n"]
    for name, function in functions.items():
        parts.append("static inline " + c_function(function, f"armik_{name}"))
        if fits_lanes(function):
            parts.append(lanes_function(function, f"armik_{name}"))
            parts.append(f"#define HAS_LANES_OF_{name}\n")
    return "\n".join([*parts, *(loop_text(name) for name in loops)])


def pointwise_functions(arm: Arm) -> dict[str, ca.Function]:
    """The kinematics the loops call, as CasADi Functions of (q, lengths).

    `position` p (3); `pose` p and R row by row (12); `pose_and_jacobian` also J row by row (12 + 6·dof).

    Args:
        arm: The arm.

    Returns:
        Functions by name.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    symbols = express(arm)
    pose = ca.vertcat(symbols.position, row_by_row(symbols.rotation))
    quantities = {
        "position": symbols.position,
        "pose": pose,
        "pose_and_jacobian": ca.vertcat(pose, row_by_row(symbols.jacobian)),
    }
    inputs = {"q": symbols.q, "lengths": symbols.lengths}
    return {name: dense_function(name, inputs, value) for name, value in quantities.items()}


def library_source(arm: Arm) -> str:
    """C source of the library of an arm: all loops that fit it.

    Args:
        arm: The arm.

    Returns:
        C source.

    Source:
        None (packaging).
    """
    functions, loops = pointwise_functions(arm), LOOPS
    if closed_form_fits(arm):
        return pointwise_source(functions | search_functions(), arm.dof, (*loops, *ALFAIZ_LOOPS))
    return pointwise_source(functions, arm.dof, loops)


@functools.lru_cache(maxsize=64)
def _library(structure: ArmStructure, backend: Backend) -> PointwiseLibrary:
    return PointwiseLibrary(build_or_none(library_source(structure.arm), backend))
