"""`compare`: a solution beside what was measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.display_units import joint_unit
from armik_sym.arm.model import Arm
from armik_sym.comparison.comparison import Comparison
from armik_sym.comparison.elbow import NEAR_LINE, elbow_position, swivels
from armik_sym.comparison.measured import measured_of
from armik_sym.comparison.sampling import align
from armik_sym.compiled.backend import Backend
from armik_sym.errors import ArmModelError, OptionError
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.solution import Solution
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.equivalent_angles import without_turns
from armik_sym.swivel.spherical_arm import recognise

Array = NDArray[np.float64]

# Ranges of motion are often written in degrees: a full turn up to rounding.
_ROUNDING = 1e-9
# By how much a measured angle may leave the range of motion without a word, in [rad].
_WORTH_A_WORD = 1e-6


def compare(
    solution: Solution,
    measured: JointMotion | ArrayLike,
    *,
    longest_hole: float | None = None,
    backend: Backend = "auto",
) -> Comparison:
    """How far a solution is from the measured motion of the same arm.

    d = q_solved - q_measured for every joint, without whole turns for joints that can turn round (range of
    motion of 360° and more); the difference of the swivel angles; |elbow_solved - elbow_measured| by forward
    kinematics. Each with mean and maximum of |d|, and RMS.

    Args:
        solution: The solution.
        measured: Measured motion of the same arm, joints matched by name; or angles at the time stamps of the
            solution, shape (n, dof), in [rad], NaN where missing. Other time stamps are met by linear
            interpolation, never beyond the time both have in common; the result says so.
        longest_hole: Measured samples farther apart than this are not interpolated between, in [s]; None
            (default): 3.5 times their median step.
        backend: "auto", "c" or "vm", for the swivel angles.

    Returns:
        The comparison; print it, plot it, save it.

    Raises:
        OptionError: If one of the two is something else, or `longest_hole` is not positive.
        UnknownNameError: If no measured joint belongs to the arm.
        ShapeError: If the array does not fit the solution.
        HandPathError: If the two have no time in common, or no measured value is a number.

    Source:
        Compare Nguyen 2021, Table 6 ("Aver. Joints Err.") and Figs. 9-13.
    """
    if not isinstance(solution, Solution):
        raise OptionError(
            f"solution is a {type(solution).__name__}, expected a Solution: use solve(arm, path)"
        )
    arm, given = solution.arm, measured_of(solution, measured)
    circular = _circular(arm)[given.joints]
    rows, q_measured, resampled = align(solution.time, given.time, given.q, circular, longest_hole)
    q = solution.q[rows][:, given.joints]
    apart = q - q_measured
    turned_back = q - np.where(circular, without_turns(apart), apart)
    notes = [
        *resampled,
        *given.notes,
        *_about_samples(q, q_measured),
        *_outside(arm, given.joints, circular, q_measured),
    ]
    swivel = swivel_apart = elbow = measured_elbow = None
    why = _why_no_elbow(arm, len(given.joints))
    if why is None:
        elbow, measured_elbow = elbow_position(arm, q), elbow_position(arm, q_measured)
        swivel, swivel_apart, near = swivels(arm, q, q_measured, backend)
        if near.any():
            notes.append(
                f"swivel not compared at {near.sum()} samples with the elbow within "
                f"{1000 * NEAR_LINE:.0f} mm of the line from shoulder to wrist"
            )
    elif len(given.joints) == arm.dof:
        notes.append(f"no swivel and elbow: {why}")
    names = tuple(arm.joint_names[i] for i in given.joints)
    return Comparison(
        solution=solution,
        time=solution.time[rows],
        joint_names=names,
        q=q,
        measured=turned_back,
        swivel=swivel,
        swivel_difference=swivel_apart,
        elbow=elbow,
        measured_elbow=measured_elbow,
        notes=tuple(notes),
    )


def _circular(arm: Arm) -> NDArray[np.bool_]:
    """Joints that can turn round."""
    return np.asarray(arm.rotates & (arm.rom.upper - arm.rom.lower >= TURN - _ROUNDING))


def _why_no_elbow(arm: Arm, measured: int) -> str | None:
    if measured < arm.dof:
        return "not all joints were measured"
    try:
        recognise(arm)
    except ArmModelError as error:
        return str(error)
    return None


def _about_samples(q: Array, measured: Array) -> list[str]:
    notes = []
    missing = int(np.isnan(measured).any(axis=1).sum())
    if missing:
        notes.append(f"measured angles are missing at {missing} of {len(measured)} samples")
    lost = int((~np.isfinite(q)).any(axis=1).sum())
    if lost:
        notes.append(f"solved angles are not finite at {lost} of {len(q)} samples")
    return notes


def _outside(arm: Arm, joints: NDArray[np.int64], circular: NDArray[np.bool_], measured: Array) -> list[str]:
    """Where the person left the range of motion of the arm: there no solution can be where they were."""
    notes = []
    lower, upper = arm.rom.lower[joints], arm.rom.upper[joints]
    beyond = np.where(circular, 0.0, np.maximum(measured - upper, lower - measured))
    for column, joint in enumerate(joints):
        over = beyond[:, column]
        out = over > _WORTH_A_WORD
        if out.any():
            words = arm.joint_names[joint].replace("_", " ")
            largest = joint_unit(arm, int(joint)).text(float(np.nanmax(over)))
            notes.append(
                f"measured {words} is outside the range of motion of the arm at {out.sum()} samples, by up "
                f"to {largest}"
            )
    return notes
