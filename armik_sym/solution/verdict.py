"""Judging a joint trajectory: is it what was asked for, and if not, why not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from armik_sym.solution.solution import Solution


@dataclass(frozen=True, eq=False)
class Requirements:
    """What a solution has to satisfy.

    Attributes:
        position_tolerance: Largest position error, in [m].
        rotation_tolerance: Largest rotation error, in [rad].
        max_speed: Largest joint speed, shape (dof,), in [rad/s].
        max_acceleration: Largest joint acceleration, shape (dof,), in [rad/s²].
    """

    position_tolerance: float
    rotation_tolerance: float
    max_speed: np.ndarray[tuple[int, ...], np.dtype[np.float64]]
    max_acceleration: np.ndarray[tuple[int, ...], np.dtype[np.float64]]


def reasons_against(solution: Solution) -> tuple[str, ...]:
    """Everything that speaks against a solution; empty if it is what was asked for.

    Finite angles; lower ≤ q ≤ upper with no tolerance; errors, speeds and accelerations within the
    requirements.

    Args:
        solution: The solution.

    Returns:
        One sentence per reason, with sample or joint, value and limit.

    Source:
        None (this package).
    """
    if not np.all(np.isfinite(solution.q)):
        k = int(np.flatnonzero(~np.isfinite(solution.q).all(axis=1))[0])
        return (f"sample {k} has joint angles that are not finite",)
    need = solution.requirements
    reasons = []
    k = int(np.argmax(solution.position_error))
    if solution.position_error[k] > need.position_tolerance:
        reasons.append(
            f"position error {1000 * solution.position_error[k]:.3g} mm at sample {k} "
            f"(allowed {1000 * need.position_tolerance:.3g} mm)"
        )
    k = int(np.argmax(solution.rotation_error))
    if solution.rotation_error[k] > need.rotation_tolerance:
        reasons.append(
            f"rotation error {np.rad2deg(solution.rotation_error[k]):.3g}° at sample {k} "
            f"(allowed {np.rad2deg(need.rotation_tolerance):.3g}°)"
        )
    names = solution.arm.joint_names
    for i in np.flatnonzero(solution.rom_margin < 0):
        reasons.append(f"{names[i]} leaves its range of motion by {-np.rad2deg(solution.rom_margin[i]):.3g}°")
    for i in np.flatnonzero(solution.max_speed > need.max_speed):
        reasons.append(
            f"{names[i]} moves at {np.rad2deg(solution.max_speed[i]):.4g}°/s "
            f"(allowed {np.rad2deg(need.max_speed[i]):.4g}°/s)"
        )
    for i in np.flatnonzero(solution.max_acceleration > need.max_acceleration):
        reasons.append(
            f"{names[i]} accelerates at {np.rad2deg(solution.max_acceleration[i]):.4g}°/s² "
            f"(allowed {np.rad2deg(need.max_acceleration[i]):.4g}°/s²)"
        )
    return tuple(reasons)
