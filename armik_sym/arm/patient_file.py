"""Patients described in TOML files: an arm, with a narrower range of motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from armik_sym.arm.dh import JointType
from armik_sym.arm.model import Arm
from armik_sym.arm.toml_reader import (
    ANGLE_UNITS,
    LENGTH_UNITS,
    check_keys,
    limit_pair,
    number,
    sub_table,
    unit_factor,
)
from armik_sym.errors import ArmFileError, ArmModelError, UnknownNameError

_PATIENT_KEYS = ("patient", "note", "arm", "angle_unit", "length_unit", "lengths", "range_of_motion")

# Degrees written with a few digits must not miss the arm's own limit by a rounding error.
_SAME_LIMIT = 1e-9


def patient_from_table(path: Path, table: dict[str, Any], arm: Arm) -> Arm:
    """Narrow an arm's range of motion to a patient's.

    lower_arm ≤ lower_patient ≤ q ≤ upper_patient ≤ upper_arm.

    Args:
        path: The file, for messages.
        table: Its parsed content: `arm`, `angle_unit`, `[range_of_motion]` with
            `joint = [lower, upper]`, optionally `[lengths]` with `length_unit`, `patient`, `note`.
        arm: The arm the patient file refers to.

    Returns:
        The arm with the patient's range of motion and segment lengths.

    Raises:
        ArmFileError: If a joint is unknown, a limit lies outside the arm's own, lower > upper, or the
            file changes nothing.
        UnitError: If a unit is not declared.

    Source:
        None (file format of this package).
    """
    check_keys(path, "the file", table, _PATIENT_KEYS)
    ranges = sub_table(path, table, "range_of_motion")
    lengths = sub_table(path, table, "lengths")
    if not ranges and not lengths:
        raise ArmFileError(
            f"{path}: neither [range_of_motion] nor [lengths]: a patient file has to say what differs from "
            f"arm {arm.name!r}"
        )
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    for joint, value in ranges.items():
        i = _joint_index(path, arm, joint)
        angle = arm.chain.moving_links[i].joint is JointType.REVOLUTE
        key, units = ("angle_unit", ANGLE_UNITS) if angle else ("length_unit", LENGTH_UNITS)
        factor = unit_factor(path, table, key, units)
        pair = limit_pair(path, f"range_of_motion.{joint}", value, factor, angle=angle)
        lower[i], upper[i] = _inside(path, arm, i, pair, factor, unit=table[key])
    try:
        narrowed = arm.with_rom(lower, upper)
        if lengths:
            metre = unit_factor(path, table, "length_unit", LENGTH_UNITS)
            narrowed = narrowed.with_lengths(
                **{key: metre * number(path, f"lengths.{key}", value) for key, value in lengths.items()}
            )
    except (ArmModelError, UnknownNameError) as error:
        raise ArmFileError(f"{path}: {error}") from error
    patient = f"patient {table['patient']}, {path.name}" if "patient" in table else path.name
    return replace(narrowed, description=f"{arm.description}; narrowed by {patient}")


def _joint_index(path: Path, arm: Arm, joint: str) -> int:
    if joint not in arm.joint_names:
        raise ArmFileError(
            f"{path}: range_of_motion has unknown joint {joint!r}: arm {arm.name!r} has "
            f"{', '.join(arm.joint_names)}"
        )
    return arm.joint_names.index(joint)


def _inside(
    path: Path, arm: Arm, i: int, pair: tuple[float, float], factor: float, unit: str
) -> tuple[float, float]:
    own = (float(arm.rom.lower[i]), float(arm.rom.upper[i]))
    if pair[0] < own[0] - _SAME_LIMIT or pair[1] > own[1] + _SAME_LIMIT:
        raise ArmFileError(
            f"{path}: range_of_motion.{arm.joint_names[i]} is [{pair[0] / factor:g}, {pair[1] / factor:g}] "
            f"{unit}, outside the arm's own [{own[0] / factor:g}, {own[1] / factor:g}] {unit}: a patient "
            "file can only narrow a range of motion"
        )
    return tuple(np.clip(pair, *own).tolist())
