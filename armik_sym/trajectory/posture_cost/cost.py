"""The cost of single postures: compiled once per structure of arm, nothing at all if not asked for."""

from __future__ import annotations

import functools
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend, build_or_none
from armik_sym.compiled.batch import CompiledFunction, PostureFunction, VirtualMachineFunction
from armik_sym.compiled.build import Library
from armik_sym.compiled.library_source import PRELUDE, batch_library, casadi_library
from armik_sym.compiled.structure import ArmStructure
from armik_sym.errors import ArmModelError, OptionError, ShapeError
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.symbolic import express
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.trajectory.posture_cost.clearance import clearance_of_joints
from armik_sym.trajectory.posture_cost.expressions import cost_functions, upper_arm_frame
from armik_sym.trajectory.posture_cost.preference import elbow_direction, wants_elbow

if TYPE_CHECKING:
    from armik_sym.trajectory.options import TrajectoryOptions

Array = NDArray[np.float64]

# |d²(d·u)/dq_i dq_j| ≤ 1 for the three joints that move the elbow; half of it counts.
_ELBOW_CURVATURE = 1.5


@dataclass(frozen=True, eq=False)
class PostureCost:
    """What a posture costs per second: ℓ(q), see `cost_functions`.

    It adds ∫ ℓ(q) dt ≈ Σ_k d_k·ℓ(q_k) to the objective, with d = `rates.sample_durations`.

    Attributes:
        value: Function (q, lengths, parameters) → ℓ, shape (1, 1).
        gradient: Function (q, lengths, parameters) → dℓ/dq, shape (dof, 1).
        hessian: Function (q, lengths, parameters) → d²ℓ/dq² column by column, shape (dof·dof, 1).
        lengths: Segment lengths of the arm, shape (n_lengths,), in [m].
        parameters: All other numbers, shape (n_parameters,).
        curvature: Upper bound of the largest eigenvalue of d²ℓ/dq² inside the range of motion.
        backend: "c" or "vm".
        build_time: Seconds spent on expressions in this process.
        compile_time: Seconds the C compiler took; 0 if the cache had the library.
    """

    value: ca.Function
    gradient: ca.Function
    hessian: ca.Function
    lengths: Array
    parameters: Array
    curvature: float
    backend: str
    build_time: float
    compile_time: float
    _many: PostureFunction = field(repr=False)

    def evaluate(self, q: ArrayLike) -> Array:
        """ℓ of many postures.

        Args:
            q: Joint angles, shape (n, dof), in [rad].

        Returns:
            Shape (n,), in [1/s²].

        Raises:
            ShapeError: If `q` has another shape.

        Source:
            None (this package).
        """
        postures = np.ascontiguousarray(q, dtype=np.float64)
        dof = self.value.numel_in(0)
        if postures.ndim != 2 or postures.shape[1] != dof:
            raise ShapeError(f"q has shape {postures.shape}, expected (n, {dof})")
        return self._many.many(postures)[:, 0]


def posture_cost(arm: Arm, options: TrajectoryOptions, backend: Backend = "auto") -> PostureCost | None:
    """The clearance and elbow terms of the objective for one arm.

    Args:
        arm: The arm.
        options: Choices: `clearance_weight`, `clearance`, `prefer`, `prefer_weight`.
        backend: "auto", "c" or "vm".

    Returns:
        The cost; None if neither term is asked for, and then nothing is compiled.

    Raises:
        OptionError: If the options do not fit the arm.
        CompilerError: If `backend` is "c" and no compiler works.

    Source:
        None (this package).
    """
    clearance = clearance_of_joints(arm, options.clearance, options.clearance_weight)
    numbers = [clearance.weight, arm.rom.lower, arm.rom.upper, clearance.distance]
    curvature = 3.0 * float(np.max(clearance.weight / clearance.distance**2))
    elbow = options.prefer is not None and wants_elbow(arm, options.prefer)
    if options.prefer is not None and elbow:
        in_upper_arm = _elbow_in_upper_arm(arm)
        numbers += [np.array([options.prefer_weight]), in_upper_arm, elbow_direction(arm, options.prefer)]
        curvature += _ELBOW_CURVATURE * options.prefer_weight
    if curvature == 0:
        return None
    return _program(ArmStructure.of(arm), elbow, backend).bind(arm, np.concatenate(numbers), curvature)


@dataclass(frozen=True, eq=False)
class _Program:
    functions: dict[str, ca.Function]
    batch: ca.Function
    library: Library | None
    build_time: float

    def bind(self, arm: Arm, parameters: Array, curvature: float) -> PostureCost:
        many: PostureFunction = (
            VirtualMachineFunction(self.batch, parameters)
            if self.library is None
            else CompiledFunction(self.library, self.batch, parameters)
        )
        return PostureCost(
            value=self.functions["posture_value"],
            gradient=self.functions["posture_gradient"],
            hessian=self.functions["posture_hessian"],
            lengths=arm.length_values,
            parameters=parameters,
            curvature=curvature,
            backend="vm" if self.library is None else "c",
            build_time=self.build_time,
            compile_time=self.library.compile_time if self.library else 0.0,
            _many=many,
        )


@functools.lru_cache(maxsize=64)
def _program(structure: ArmStructure, elbow: bool, backend: Backend) -> _Program:
    started = time.perf_counter()
    arm = express(structure.arm)
    functions = cost_functions(arm, elbow=elbow)
    batch = _without_lengths(functions["posture_value"], arm.lengths.numel())
    source = casadi_library(functions) + batch_library({batch.name(): batch}).removeprefix(PRELUDE)
    build_time = time.perf_counter() - started
    library = build_or_none(source, backend)
    if library is not None:
        functions = {name: ca.external(f"armik_{name}", str(library.path)) for name in functions}
    return _Program(functions, batch, library, build_time)


def _without_lengths(value: ca.Function, n_lengths: int) -> ca.Function:
    """ℓ as a Function (q, parameters), the form of which there are loops over postures."""
    q, parameters = (ca.SX.sym(value.name_in(i), value.numel_in(i)) for i in (0, 2))
    costs = value(q, ca.SX.zeros(n_lengths), parameters)
    return dense_function("posture_costs", {"q": q, "parameters": parameters}, costs)


def _elbow_in_upper_arm(arm: Arm) -> Array:
    """Unit vector from shoulder to elbow in the frame that is fixed to the upper arm."""
    try:
        spherical = recognise(arm)
    except ArmModelError as error:
        raise OptionError(
            f"prefer asks for a direction of the elbow, but {error}; for this arm only a posture can be "
            f"preferred: {arm.dof} angles in [rad]"
        ) from None
    symbolic = express(arm, lengths="baked")
    frame = symbolic.frames[upper_arm_frame(symbolic)]
    at_zero = ca.Function("at_zero", [symbolic.q], [ca.densify(frame[:3, :3])])(np.zeros(arm.dof))
    return np.asarray(np.array(at_zero, dtype=np.float64).T @ spherical.reference)
