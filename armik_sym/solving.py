"""One entry point for all methods."""

from __future__ import annotations

import dataclasses
import numbers
from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike

from armik_sym.arm import catalog
from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.errors import OptionError, UnknownNameError
from armik_sym.motion.hand_path import HandPath
from armik_sym.pointwise.methods import METHODS
from armik_sym.progress import ProgressCallback
from armik_sym.solution import Solution
from armik_sym.trajectory import TrajectoryOptions, solve_trajectory

# Every method: its options, and the function that solves with them.
_METHODS: dict[str, tuple[type[Any], Callable[..., Solution]]] = {
    "trajectory": (TrajectoryOptions, solve_trajectory),
    **METHODS,
}


def methods() -> tuple[str, ...]:
    """Names of the methods `solve` knows."""
    return tuple(_METHODS)


def solve(
    arm: Arm,
    path: HandPath,
    method: str = "trajectory",
    *,
    start: ArrayLike | None = None,
    seed: int = 0,
    backend: Backend = "auto",
    progress: ProgressCallback | None = None,
    **options: Any,
) -> Solution:
    """Solve the inverse kinematics of a hand path.

    Find q_1 … q_n with hand(q_k) = sample k, lower ≤ q_k ≤ upper, and as little motion as possible.

    Args:
        arm: The arm.
        path: The hand path, n samples.
        method: "trajectory" (all samples at once, IPOPT), or one pose after another: "pro-isade", "isade"
            (Nguyen 2021), "lm", "sugihara", "alfaiz" (Al-Faiz).
        start: Known posture at the beginning, shape (dof,), in [rad]; if it does not put the hand on the
            path, the solution begins near it and says how far away.
        seed: Seed of everything random.
        backend: "auto" (compiled C if possible), "c" or "vm".
        progress: Told what is going on, see `Progress`.
        **options: Options of the method: `trajectory.TrajectoryOptions`; in `pointwise` `ProIsadeOptions`,
            `IsadeOptions`, `LmOptions`, `SugiharaOptions`, `AlfaizOptions`.

    Returns:
        The solution; `solution.ok` and `solution.reasons` say what it is worth.

    Raises:
        UnknownNameError: If the method or an option does not exist; lists those that do.
        UnreachablePathError: If samples cannot be reached; names them and the distance. Methods that take one
            pose after another go on instead, and the solution says which samples they missed.
        SolverError: If the solver found no answer that can be trusted.
        LimitError: If `start` lies outside the range of motion or limits contradict the path.
        OptionError: If an option has a value the method cannot work with, or arm or path is none.

    Source:
        Nguyen 2021, §3.3 (the task, Pro-ISADE); Al-Faiz (lm, sugihara, alfaiz); this package (trajectory).
    """
    _check_types(arm, path, seed)
    if method not in _METHODS:
        raise UnknownNameError("method", method, _METHODS)
    option_type, run = _METHODS[method]
    valid = [field.name for field in dataclasses.fields(option_type)]
    for name in options:
        if name not in valid:
            raise UnknownNameError(f"option of method {method!r}", name, valid)
    chosen = option_type(**options)
    return run(arm, path, chosen, start=start, seed=seed, backend=backend, progress=progress)


def _check_types(arm: object, path: object, seed: object) -> None:
    if not isinstance(arm, Arm):
        raise OptionError(
            f"arm is {arm!r}, expected an Arm: use load_arm(NAME or FILE), or one of the catalogue: "
            f"{', '.join(catalog.names())}"
        )
    if not isinstance(path, HandPath):
        raise OptionError(f"path is a {type(path).__name__}, expected a HandPath: use read_path(FILE)")
    whole = isinstance(seed, numbers.Integral) and not isinstance(seed, bool)
    if not whole or int(seed) < 0:  # type: ignore[call-overload]
        raise OptionError(f"seed is {seed!r}, expected a whole number ≥ 0")
