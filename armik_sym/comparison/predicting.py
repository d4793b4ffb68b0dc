"""What a method says a person does, given the hand path and the first posture only."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.display_units import joint_units
from armik_sym.arm.model import Arm
from armik_sym.arm.start_posture import finite_posture
from armik_sym.comparison.constant_swivel import METHOD, constant_swivel
from armik_sym.compiled.backend import Backend
from armik_sym.errors import UnknownNameError
from armik_sym.motion.hand_path import HandPath
from armik_sym.progress import ProgressCallback
from armik_sym.solution import Solution
from armik_sym.solving import methods, solve

Array = NDArray[np.float64]

# By how much a first posture may be moved into the range of motion without a word, in [rad].
_WORTH_A_WORD = 1e-6


def predictors() -> tuple[str, ...]:
    """Names of the methods `predict` knows: those of `solve`, and "swivel-constant"."""
    return (*methods(), METHOD)


def predict(
    arm: Arm,
    path: HandPath,
    first: ArrayLike,
    method: str = "trajectory",
    *,
    tracking: Literal["soft", "exact"] = "soft",
    seed: int = 0,
    backend: Backend = "auto",
    progress: ProgressCallback | None = None,
    **options: Any,
) -> Solution:
    """Solve a recorded hand path from its first measured posture; nothing else of the arm is told.

    Args:
        arm: The arm fitted to the person.
        path: The recorded hand path.
        first: The first measured posture, shape (dof,), in [rad]; outside the range of motion it is moved to
            the limit, see `first_inside`.
        method: A method of `solve`, or "swivel-constant", see `constant_swivel`.
        tracking: Of method "trajectory": "soft" (default), because recorded paths are noisy and a rigid arm
            can often not follow them exactly; or "exact". The other methods follow every sample as well as
            they can.
        seed: Seed of everything random.
        backend: "auto", "c" or "vm".
        progress: Told what is going on, see `Progress`.
        **options: Further options of the method.

    Returns:
        The solution.

    Raises:
        UnknownNameError: If the method or an option does not exist.
        ShapeError: If `first` does not have shape (dof,).
        HandPathError: If `first` is not finite.

    Source:
        Nguyen 2021, §4.2-5 (solved from the measured beginning, compared with the measured rest).
    """
    if method not in predictors():
        raise UnknownNameError("method", method, predictors())
    if method == METHOD:
        return constant_swivel(arm, path, first, backend=backend, **options)
    if method == "trajectory":
        options = {"tracking": tracking, **options}
    start, _ = first_inside(arm, first)
    return solve(arm, path, method, start=start, seed=seed, backend=backend, progress=progress, **options)


def first_inside(arm: Arm, first: ArrayLike) -> tuple[Array, str]:
    """A first posture inside the range of motion: each joint that is outside stops at its limit.

    Args:
        arm: The arm.
        first: The measured posture, shape (dof,), in [rad].

    Returns:
        The posture, shape (dof,), in [rad], and what was moved, in words; "" if nothing was.

    Raises:
        ShapeError: If `first` does not have shape (dof,).
        HandPathError: If it is not finite.

    Source:
        None (this package).
    """
    posture = finite_posture(arm, first, "first")
    inside = np.clip(posture, arm.rom.lower, arm.rom.upper)
    moved = [
        f"{name.replace('_', ' ')} by {unit.text(abs(by))}"
        for name, unit, by in zip(arm.joint_names, joint_units(arm), posture - inside, strict=True)
        if abs(by) > _WORTH_A_WORD
    ]
    return inside, f"first posture moved into the range of motion: {', '.join(moved)}" if moved else ""
