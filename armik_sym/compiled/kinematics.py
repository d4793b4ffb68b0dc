"""Compiled kinematics of an arm: postures in, positions, rotations and Jacobians out."""

from __future__ import annotations

import functools
import math
import time
from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend, build_or_none
from armik_sym.compiled.batch import CompiledFunction, PostureFunction, VirtualMachineFunction
from armik_sym.compiled.build import Library
from armik_sym.compiled.kinematic_functions import kinematic_functions
from armik_sym.compiled.library_source import batch_library
from armik_sym.compiled.structure import ArmStructure
from armik_sym.errors import ShapeError
from armik_sym.symbolic import express

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Program:
    functions: dict[str, ca.Function]
    library: Library | None
    build_time: float

    def bind(self, lengths: Array) -> dict[str, PostureFunction]:
        if self.library is None:
            return {name: VirtualMachineFunction(f, lengths) for name, f in self.functions.items()}
        return {name: CompiledFunction(self.library, f, lengths) for name, f in self.functions.items()}


class Kinematics:
    """Forward kinematics and Jacobians of one arm, for one posture or many at once.

    T_base_hand(q) = base · Π T_i(q_i) · tool; [v; ω] = J(q) q̇.

    Attributes:
        arm: The arm.
        backend: "c" (generated C) or "vm" (CasADi's virtual machine).
        build_time: Seconds spent building expressions for this kind of arm in this process.
        compile_time: Seconds the C compiler took; 0 if the cache had the library.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """

    def __init__(self, arm: Arm, program: _Program) -> None:
        self.arm = arm
        self.backend = "vm" if program.library is None else "c"
        self.build_time = program.build_time
        self.compile_time = program.library.compile_time if program.library else 0.0
        self._functions = program.bind(arm.length_values)
        self._dof = arm.dof

    def __repr__(self) -> str:
        return f"Kinematics(arm={self.arm.name!r}, backend={self.backend!r})"

    def position(self, q: ArrayLike, out: Array | None = None) -> Array:
        """Position of the hand: p(q).

        Args:
            q: Joint angles, shape (dof,) or (n, dof), in [rad].
            out: Where the answer goes, of its shape; a new array if left out.

        Returns:
            Shape (3,) or (n, 3), in [m].

        Raises:
            ShapeError: If the last axis of `q` is not dof long, or `out` does not fit.

        Source:
            Nguyen 2021, eq. 3 (for `catalog.ehmcs`).
        """
        return self._evaluate("position", q, (3,), out)

    def rotation(self, q: ArrayLike, out: Array | None = None) -> Array:
        """Rotation of the hand frame to the base: R(q).

        Args:
            q: Joint angles, shape (dof,) or (n, dof), in [rad].
            out: Where the answer goes, of its shape; a new array if left out.

        Returns:
            Shape (3, 3) or (n, 3, 3).

        Raises:
            ShapeError: If the last axis of `q` is not dof long, or `out` does not fit.

        Source:
            Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
        """
        return self._evaluate("rotation", q, (3, 3), out)

    def jacobian(self, q: ArrayLike, out: Array | None = None) -> Array:
        """Geometric Jacobian in the base frame: [v; ω] = J(q) q̇.

        Args:
            q: Joint angles, shape (dof,) or (n, dof), in [rad].
            out: Where the answer goes, of its shape; a new array if left out.

        Returns:
            Shape (6, dof) or (n, 6, dof); linear rows in [m/rad], then angular rows in [1].

        Raises:
            ShapeError: If the last axis of `q` is not dof long, or `out` does not fit.

        Source:
            Siciliano et al., Robotics (2009), eq. 3.30.
        """
        return self._evaluate("jacobian", q, (6, self._dof), out)

    def pose_and_jacobian(self, q: ArrayLike, out: Array | None = None) -> tuple[Array, Array, Array]:
        """Position, rotation and Jacobian together, for little more than the Jacobian alone.

        Args:
            q: Joint angles, shape (dof,) or (n, dof), in [rad].
            out: Where all numbers go, shape (…, 12 + 6·dof); a new array if left out.

        Returns:
            Position (…, 3) in [m], rotation (…, 3, 3), geometric Jacobian (…, 6, dof); views of
            one array.

        Raises:
            ShapeError: If the last axis of `q` is not dof long, or `out` does not fit.

        Source:
            Nguyen 2021, eq. 2; Siciliano et al., Robotics (2009), eq. 3.30.
        """
        flat = self._evaluate("pose_and_jacobian", q, (12 + 6 * self._dof,), out)
        lead = flat.shape[:-1]
        rotation = flat[..., 3:12].reshape((*lead, 3, 3))
        return flat[..., :3], rotation, flat[..., 12:].reshape((*lead, 6, self._dof))

    def _evaluate(self, name: str, q: ArrayLike, shape: tuple[int, ...], out: Array | None) -> Array:
        postures = np.ascontiguousarray(q, dtype=np.float64)
        if postures.ndim not in (1, 2) or postures.shape[-1] != self._dof:
            raise ShapeError(
                f"q has shape {np.shape(q)}, expected ({self._dof},) or (n, {self._dof}) for arm "
                f"{self.arm.name!r}"
            )
        function = self._functions[name]
        if out is not None:
            _check_out(out, (*postures.shape[:-1], *shape))
            if np.may_share_memory(out, postures):
                postures = postures.copy()
            function.many(postures.reshape(-1, self._dof), out.reshape(-1, math.prod(shape)))
            return out
        if postures.ndim == 1:
            return function.one(postures).reshape(shape)
        return function.many(postures).reshape((len(postures), *shape))


def _check_out(out: object, shape: tuple[int, ...]) -> None:
    if not isinstance(out, np.ndarray) or out.shape != shape or out.dtype != np.float64:
        found = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise ShapeError(f"out is {found}, expected a float64 array of shape {shape}")
    if not (out.flags.c_contiguous and out.flags.writeable and out.flags.aligned):
        raise ShapeError("out must be C-contiguous, aligned and writeable")


def compile(arm: Arm, backend: Backend = "auto") -> Kinematics:
    """Compile the kinematics of an arm, once for all arms of the same structure.

    Expressions become C, C becomes a shared library in a private per-user cache. Segment lengths are
    arguments of the compiled code: arms that differ only in lengths or range of motion share it.

    Args:
        arm: The arm.
        backend: "auto" (C if a compiler works, otherwise CasADi's virtual machine and one warning),
            "c" (C or an error) or "vm".

    Returns:
        Callable kinematics.

    Raises:
        CompilerError: If `backend` is "c" and no compiler works; carries the compiler's output.
        OptionError: If `backend` is another word.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    return Kinematics(arm, _program(ArmStructure.of(arm), backend))


@functools.lru_cache(maxsize=64)
def _program(structure: ArmStructure, backend: Backend) -> _Program:
    started = time.perf_counter()
    functions = kinematic_functions(express(structure.arm))
    source = batch_library(functions)
    build_time = time.perf_counter() - started
    return _Program(functions, build_or_none(source, backend), build_time)
