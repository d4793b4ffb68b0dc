"""Arms described in TOML files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHConvention, DHLink, JointType
from armik_sym.arm.model import Arm
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.arm.toml_reader import (
    ANGLE_UNITS,
    LENGTH_UNITS,
    check_keys,
    limit_pair,
    number,
    sub_table,
    unit_factor,
)
from armik_sym.errors import ArmFileError, ArmModelError, UnitError, UnknownNameError

_ARM_KEYS = (
    "name", "description", "convention", "angle_unit", "length_unit", "pointing_axis", "up", "outward",
    "base", "tool", "lengths", "joint",
)  # fmt: skip
_JOINT_KEYS = ("name", "type", "theta", "d", "a", "alpha", "sign", "range")


def arm_from_table(path: Path, table: dict[str, Any]) -> Arm:
    """Build an arm from a parsed arm file.

    Args:
        path: The file, for messages.
        table: Its parsed content: `name`, `convention`, `angle_unit`, `length_unit`, one `[[joint]]`
            per DH row with `name`, `type`, `theta`, `d`, `a`, `alpha`, `sign`, `range`, and
            optionally `[lengths]`, `base`, `tool`, `pointing_axis`, `up`, `outward`, `description`.

    Returns:
        The arm, in SI units.

    Raises:
        ArmFileError: If the description is incomplete or contradicts itself.
        UnitError: If a unit is not declared.

    Source:
        None (file format of this package).
    """
    check_keys(path, "the file", table, _ARM_KEYS)
    angle = unit_factor(path, table, "angle_unit", ANGLE_UNITS)
    metre = unit_factor(path, table, "length_unit", LENGTH_UNITS)
    rows = table.get("joint")
    if not isinstance(rows, list) or not rows:
        raise ArmFileError(f"{path}: no [[joint]] rows: an arm needs one for each DH row")
    try:
        links = tuple(_link(path, i, row, angle, metre) for i, row in enumerate(rows, 1))
        convention = _choice(path, "convention", table.get("convention"), [c.value for c in DHConvention])
        limits = [
            _limits(path, link, row, angle, metre)
            for link, row in zip(links, rows, strict=True)
            if link.moves
        ]
        given = sub_table(path, table, "lengths")
        lengths = {key: metre * number(path, f"lengths.{key}", value) for key, value in given.items()}
        return Arm(
            name=table.get("name", path.stem),
            chain=DHChain(
                links,
                DHConvention(convention),
                base=_transform(path, "base", table.get("base"), metre),
                tool=_transform(path, "tool", table.get("tool"), metre),
            ),
            rom=RangeOfMotion(*np.array(limits).reshape(-1, 2).T),
            lengths=lengths,
            pointing_axis=_numbers(path, "pointing_axis", table.get("pointing_axis", [1.0, 0.0, 0.0])),
            description=str(table.get("description", "")),
            up=_direction(path, "up", table),
            outward=_direction(path, "outward", table),
        )
    except ArmFileError:
        raise
    except (ArmModelError, UnknownNameError) as error:
        raise ArmFileError(f"{path}: {error}") from error
    except UnitError as error:
        if str(error).startswith(f"{path}:"):
            raise
        raise UnitError(f"{path}: {error}") from error


def _choice(path: Path, where: str, value: object, valid: list[str]) -> str:
    if value not in valid:
        raise ArmFileError(f"{path}: {where} is {value!r}: valid are {', '.join(valid)}")
    return str(value)


def _link(path: Path, index: int, row: Any, angle: float, metre: float) -> DHLink:
    if not isinstance(row, dict):
        raise ArmFileError(f"{path}: joint {index} is {row!r}, expected a table [[joint]]")
    where = f"joint {index} ({row.get('name', 'no name')})"
    check_keys(path, where, row, _JOINT_KEYS)
    joint = _choice(path, f"{where}: type", row.get("type", "revolute"), [j.value for j in JointType])

    def shift(key: str) -> float | str:
        value = row.get(key, 0.0)
        return value if isinstance(value, str) else metre * number(path, f"{where}: {key}", value)

    return DHLink(
        name=row.get("name", ""),
        theta=angle * number(path, f"{where}: theta", row.get("theta", 0.0)),
        d=shift("d"),
        a=shift("a"),
        alpha=angle * number(path, f"{where}: alpha", row.get("alpha", 0.0)),
        joint=JointType(joint),
        sign=row.get("sign", 1),
    )


def _limits(path: Path, link: DHLink, row: dict[str, Any], angle: float, metre: float) -> tuple[float, float]:
    where = f"joint {link.name!r}: range"
    if "range" not in row:
        raise ArmFileError(f"{path}: {where} is missing: give range = [lower, upper]")
    if link.joint is JointType.PRISMATIC:
        return limit_pair(path, where, row["range"], metre, angle=False)
    return limit_pair(path, where, row["range"], angle)


def _transform(path: Path, where: str, value: Any, metre: float) -> NDArray[np.float64]:
    if value is None:
        return np.eye(4)
    T = _numbers(path, where, value)
    if T.shape == (4, 4):
        T[:3, 3] *= metre
    return T


def _direction(path: Path, key: str, table: dict[str, Any]) -> NDArray[np.float64] | None:
    return _numbers(path, key, table[key]) if key in table else None


def _numbers(path: Path, where: str, value: Any) -> NDArray[np.float64]:
    """A list of numbers, or a list of rows of numbers, as an array."""
    if not isinstance(value, list):
        raise ArmFileError(f"{path}: {where} is {value!r}, expected a list of numbers")
    rows = [
        [number(path, where, x) for x in item] if isinstance(item, list) else number(path, where, item)
        for item in value
    ]
    try:
        return np.array(rows, dtype=np.float64)
    except ValueError:
        raise ArmFileError(f"{path}: {where} has rows of different length: {value!r}") from None
