"""An arm as a TOML file that `load_arm` reads."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import DHLink, JointType
from armik_sym.arm.model import Arm
from armik_sym.arm.toml_reader import ANGLE_UNITS, LENGTH_UNITS
from armik_sym.arm.write_arm_file import write_arm_file

_DEGREE, _MILLIMETRE = ANGLE_UNITS["deg"], LENGTH_UNITS["mm"]
# As many decimals as people write, then more, before all digits are spelled out.
_DECIMALS = (3, 6, 9, 12)
# Relative: one number on from the right one.
_ROUNDING = 2.3e-16
_SPACES = re.compile(r"\s+")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def save_arm(arm: Arm, path: str | os.PathLike[str]) -> Path:
    """Write an arm as a TOML file; see `arm_text`.

    Args:
        arm: The arm.
        path: The file; its folder must exist.

    Returns:
        The path written.

    Raises:
        ArmFileError: If the file cannot be written.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    return write_arm_file(path, arm_text(arm))


def arm_text(arm: Arm) -> str:
    """An arm as TOML, in degrees and millimetres; read again, it is the same to rounding.

    Args:
        arm: The arm.

    Returns:
        The text of the file.

    Source:
        None (file format of this package, see `docs/files.md`); TOML 1.0.
    """
    lines = [f"name = {_text(arm.name)}"]
    lines += [f"description = {_text(_SPACES.sub(' ', arm.description))}"] if arm.description else []
    lines += [
        f"convention = {_text(arm.chain.convention.value)}",
        'angle_unit = "deg"',
        'length_unit = "mm"',
        f"pointing_axis = {_numbers(arm.pointing_axis)}",
    ]
    for key, direction in {"up": arm.up, "outward": arm.outward}.items():
        lines += [] if direction is None else [f"{key} = {_numbers(direction)}"]
    for key, T in {"base": arm.chain.base, "tool": arm.chain.tool}.items():
        lines += [] if np.array_equal(T, np.eye(4)) else _transform(key, T)
    lines += _lengths(arm.lengths) if arm.lengths else []
    limits = iter(zip(arm.rom.lower.tolist(), arm.rom.upper.tolist(), strict=True))
    for link in arm.chain.links:
        lines += _joint(link, next(limits) if link.moves else None)
    return "\n".join(lines) + "\n"


def _lengths(lengths: Mapping[str, float]) -> list[str]:
    keys = {name: name if _BARE_KEY.fullmatch(name) else _text(name) for name in lengths}
    return ["", "[lengths]", *(f"{keys[name]} = {_in(_MILLIMETRE, lengths[name])}" for name in lengths)]


def _joint(link: DHLink, limits: tuple[float, float] | None) -> list[str]:
    lines = ["", "[[joint]]", f"name = {_text(link.name)}"]
    lines += [] if link.joint is JointType.REVOLUTE else [f"type = {_text(link.joint.value)}"]
    for key, value, unit in (
        ("theta", link.theta, _DEGREE), ("d", link.d, _MILLIMETRE), ("a", link.a, _MILLIMETRE),
        ("alpha", link.alpha, _DEGREE),
    ):  # fmt: skip
        lines.append(f"{key} = {_text(value) if isinstance(value, str) else _in(unit, value)}")
    lines += [f"sign = {link.sign}"] if link.moves else []
    if limits is not None:
        unit = _MILLIMETRE if link.joint is JointType.PRISMATIC else _DEGREE
        lines.append(f"range = [{', '.join(_in(unit, limit) for limit in limits)}]")
    return lines


def _transform(key: str, T: NDArray[np.float64]) -> list[str]:
    rows = [f"  [{', '.join([*map(_number, row[:3]), _in(_MILLIMETRE, row[3])])}]," for row in T[:3].tolist()]
    return [f"{key} = [", *rows, "  [0, 0, 0, 1],", "]"]


def _in(unit: float, value: float) -> str:
    """A value in SI as a number of units: to rounding the same, with few decimals where these suffice."""
    exact = value / unit
    short = (round(exact, decimals) for decimals in _DECIMALS)
    return _number(
        next((number for number in short if math.isclose(unit * number, value, rel_tol=_ROUNDING)), exact)
    )


def _numbers(values: Iterable[float]) -> str:
    return f"[{', '.join(_number(value) for value in values)}]"


def _number(value: float) -> str:
    number = float(value)
    return repr(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _text(words: str) -> str:
    """A string of TOML: that of JSON, but for one character."""
    known = words.encode("utf-8", "replace").decode("utf-8")
    return json.dumps(known, ensure_ascii=False).replace("\x7f", "\\u007f")
