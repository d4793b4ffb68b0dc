"""Judging a joint trajectory: is it what was asked for, and if not, why not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from armik_sym.arm.display_units import joint_units

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
        start_tolerance: Largest difference between a start posture and sample 0, in [rad].
    """

    position_tolerance: float
    rotation_tolerance: float
    max_speed: np.ndarray[tuple[int, ...], np.dtype[np.float64]]
    max_acceleration: np.ndarray[tuple[int, ...], np.dtype[np.float64]]
    start_tolerance: float = np.inf


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
    checks = (_unreached, _tracking, _start, _range_of_motion, _rates)
    return tuple(reason for check in checks for reason in check(solution))


def _unreached(solution: Solution) -> Iterator[str]:
    if solution.reached is None or solution.reached.all():
        return
    short = np.flatnonzero(~solution.reached)
    k = int(short[0])
    yield (
        f"{len(short)} of {len(solution.q)} samples ended before the method's stop criterion was met "
        f"(first: sample {k}, position error {1000 * solution.position_error[k]:.3g} mm)"
    )


def _tracking(solution: Solution) -> Iterator[str]:
    need = solution.requirements
    k = int(np.argmax(solution.position_error))
    if solution.position_error[k] > need.position_tolerance:
        yield (
            f"position error {1000 * solution.position_error[k]:.3g} mm at sample {k} "
            f"(allowed {1000 * need.position_tolerance:.3g} mm)"
        )
    k = int(np.argmax(solution.rotation_error))
    if solution.rotation_error[k] > need.rotation_tolerance:
        yield (
            f"rotation error {np.rad2deg(solution.rotation_error[k]):.3g}° at sample {k} "
            f"(allowed {np.rad2deg(need.rotation_tolerance):.3g}°)"
        )


def _start(solution: Solution) -> Iterator[str]:
    if solution.start is None:
        return
    gap, allowed = np.abs(solution.q[0] - solution.start), solution.requirements.start_tolerance
    j = int(np.argmax(gap))
    if gap[j] > allowed:
        unit = joint_units(solution.arm)[j]
        yield (
            "the start posture does not put the hand on the path: the posture at sample 0 differs from "
            f"it by {unit.text(gap[j])} in {solution.arm.joint_names[j]} (allowed {unit.text(allowed)})"
        )


def _range_of_motion(solution: Solution) -> Iterator[str]:
    names, units = solution.arm.joint_names, joint_units(solution.arm)
    for i in np.flatnonzero(solution.rom_margin < 0).tolist():
        yield f"{names[i]} leaves its range of motion by {units[i].text(-solution.rom_margin[i])}"


def _rates(solution: Solution) -> Iterator[str]:
    need, names, units = solution.requirements, solution.arm.joint_names, joint_units(solution.arm)
    for i in np.flatnonzero(solution.max_speed > need.max_speed).tolist():
        yield (
            f"{names[i]} moves at {units[i].text(solution.max_speed[i], 4, '/s')} "
            f"(allowed {units[i].text(need.max_speed[i], 4, '/s')})"
        )
    for i in np.flatnonzero(solution.max_acceleration > need.max_acceleration).tolist():
        yield (
            f"{names[i]} accelerates at {units[i].text(solution.max_acceleration[i], 4, '/s²')} "
            f"(allowed {units[i].text(need.max_acceleration[i], 4, '/s²')})"
        )
