"""Drives described in TOML files."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from armik_sym.arm.toml_reader import check_keys, load_toml, number, sub_table
from armik_sym.errors import ArmFileError, DriveError, UnknownNameError
from armik_sym.motion.bundled import data_folder
from armik_sym.servo.drive import SEGMENTS, Drive, Gear, JointDrive, Motor

DEFAULT = "light_exoskeleton"
_RPM = math.pi / 30.0
_TOP = ("name", "description", "rate", "delay", "moving_mass", "motor", "gear", "joint")
_MOTOR = (
    "voltage", "resistance", "inductance", "torque_constant", "rotor_inertia", "rated_torque", "peak_torque",
    "top_speed", "friction",
)  # fmt: skip
_GEAR = ("ratio", "efficiency", "inertia", "rated_torque", "peak_torque")
_JOINT = ("name", "motor", "gear", "current_bandwidth", "viscous", "dry")


def drives() -> tuple[str, ...]:
    """Names of the drives that come with the package, in alphabetical order."""
    return tuple(sorted(file.stem for file in (data_folder() / "drives").glob("*.toml")))


def load_drive(path: str | os.PathLike[str] = DEFAULT) -> Drive:
    """Load drives from a TOML file, or those of the package by name.

    Args:
        path: Path of a `.toml` file, or one of `drives()`.

    Returns:
        The drive, in SI units; files give `top_speed` in rpm.

    Raises:
        DriveError: If the file is missing, unreadable, incomplete or contradicts itself; names file, key and
            value.
        UnknownNameError: If it is no file and no such name exists.

    Source:
        None (file format of this package, see `docs/servo.md`).
    """
    target = Path(path)
    if target.suffix.lower() != ".toml":
        if str(path) not in drives():
            raise UnknownNameError("drive", str(path), drives())
        target = data_folder() / "drives" / f"{path}.toml"
    try:
        return _drive(target, load_toml(target))
    except ArmFileError as error:
        raise DriveError(str(error)) from None


def _drive(file: Path, table: dict[str, Any]) -> Drive:
    check_keys(file, "the file", table, _TOP)
    motors = {name: _motor(file, name, values) for name, values in _tables(file, table, "motor").items()}
    gears = {name: _gear(file, name, values) for name, values in _tables(file, table, "gear").items()}
    rows = table.get("joint")
    if not isinstance(rows, list) or not rows:
        raise DriveError(f"{file}: no [[joint]] rows: a drive needs one for each joint")
    joints = tuple(_joint(file, i, row, motors, gears) for i, row in enumerate(rows, 1))
    moving = sub_table(file, table, "moving_mass")
    check_keys(file, "moving_mass", moving, SEGMENTS)
    masses = {key: number(file, f"moving_mass.{key}", value) for key, value in moving.items()}
    try:
        return Drive(
            name=str(table.get("name", file.stem)),
            joints=joints,
            rate=number(file, "rate", table.get("rate", 1000.0)),
            delay=number(file, "delay", table.get("delay", 0.0)),
            moving_mass=masses,
            description=str(table.get("description", "")),
        )
    except DriveError as error:
        raise DriveError(f"{file}: {error}") from None


def _tables(file: Path, table: dict[str, Any], key: str) -> dict[str, dict[str, Any]]:
    found = sub_table(file, table, key)
    for name, values in found.items():
        if not isinstance(values, dict):
            raise DriveError(f"{file}: {key}.{name} is {values!r}, expected a table [{key}.{name}]")
    return found


def _motor(file: Path, name: str, values: dict[str, Any]) -> Motor:
    where = f"motor.{name}"
    given = _numbers(file, where, values, _MOTOR, optional=("inductance", "friction"))
    given["top_speed"] *= _RPM
    motor: Motor = _made(file, where, Motor, {"inductance": 0.0, **given})
    return motor


def _gear(file: Path, name: str, values: dict[str, Any]) -> Gear:
    where = f"gear.{name}"
    gear: Gear = _made(file, where, Gear, _numbers(file, where, values, _GEAR, optional=_GEAR[1:]))
    return gear


def _joint(
    file: Path, i: int, row: object, motors: Mapping[str, Motor], gears: Mapping[str, Gear]
) -> JointDrive:
    where = f"joint {i}"
    if not isinstance(row, dict):
        raise DriveError(f"{file}: {where} is {row!r}, expected a table [[joint]]")
    check_keys(file, where, row, _JOINT)
    name = row.get("name")
    if not isinstance(name, str) or not name:
        raise DriveError(f"{file}: {where}: name is {name!r}, expected the name of a joint")
    motor = _named(file, where, "motor", row, motors)
    gear = _named(file, where, "gear", row, gears)
    rest = {key: value for key, value in row.items() if key not in ("name", "motor", "gear")}
    given = _numbers(file, where, rest, _JOINT[3:], optional=("viscous", "dry"))
    made: JointDrive = _made(file, where, JointDrive, {"name": name, "motor": motor, "gear": gear, **given})
    return made


def _named(file: Path, where: str, kind: str, row: dict[str, Any], known: Mapping[str, Any]) -> Any:
    name = row.get(kind)
    if not isinstance(name, str) or name not in known:
        valid = ", ".join(sorted(known)) or f"none, the file has no [{kind}.NAME]"
        raise DriveError(f"{file}: {where}: {kind} is {name!r}: valid are {valid}")
    return known[name]


def _numbers(
    file: Path, where: str, values: dict[str, Any], keys: tuple[str, ...], optional: tuple[str, ...]
) -> dict[str, float]:
    check_keys(file, where, values, keys)
    for key in keys:
        if key not in values and key not in optional:
            raise DriveError(f"{file}: {where}: {key} is missing, expected a number")
    return {key: number(file, f"{where}.{key}", value) for key, value in values.items()}


def _made(file: Path, where: str, kind: Any, values: dict[str, Any]) -> Any:
    try:
        return kind(**values)
    except DriveError as error:
        raise DriveError(f"{file}: {where}: {error}") from None
