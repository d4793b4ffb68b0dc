"""Arguments as people type them, turned into what the library takes."""

from __future__ import annotations

import ast
import math
from typing import TYPE_CHECKING, Any, cast

from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.compiled.backend import Backend

_BACKENDS = ("auto", "c", "vm")


def backend_name(text: str) -> Backend:
    """Check the name of a backend.

    Args:
        text: What was typed.

    Returns:
        "auto", "c" or "vm".

    Raises:
        OptionError: If it is another word.

    Source:
        None (command line).
    """
    if text not in _BACKENDS:
        raise OptionError(f"--backend is {text!r}: valid are {', '.join(_BACKENDS)}")
    return cast("Backend", text)


def posture(text: str, arm: Arm) -> list[float]:
    """A posture typed in degrees, separated by commas.

    Args:
        text: What was typed.
        arm: The arm.

    Returns:
        Joint angles, shape (dof,), in [rad].

    Raises:
        OptionError: If it is not one finite number per joint.

    Source:
        None (command line).
    """
    from armik_sym.arm.display_units import joint_unit

    cells = [cell.strip() for cell in text.split(",")]
    expected = (
        f"expected {arm.dof} angles in degrees (prismatic joints in mm), separated by commas: "
        f"{','.join(arm.joint_names)}"
    )
    if len(cells) != arm.dof:
        raise OptionError(f"--start has {len(cells)} angles, {expected}")
    angles: list[float] = []
    for cell in cells:
        try:
            value = float(cell)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise OptionError(f"--start holds {cell!r}, {expected}")
        angles.append(value / joint_unit(arm, len(angles)).factor)
    return angles


def settings(pairs: list[str]) -> dict[str, Any]:
    """Further options of a method, typed as NAME=VALUE.

    Args:
        pairs: What was typed; a value that is no number, list, True, False or None is a word.

    Returns:
        Options by name.

    Raises:
        OptionError: If one is not NAME=VALUE.

    Source:
        None (command line).
    """
    chosen: dict[str, Any] = {}
    for pair in pairs:
        name, sign, value = pair.partition("=")
        if not sign or not name.strip().isidentifier():
            raise OptionError(f"--set {pair!r}: expected NAME=VALUE, for example --set window=0.05")
        try:
            chosen[name.strip()] = ast.literal_eval(value.strip())
        except (ValueError, SyntaxError):
            chosen[name.strip()] = value.strip()
    return chosen


def only_for_trajectory(method: str, typed: dict[str, object]) -> None:
    """Refuse options that only the trajectory method has.

    Args:
        method: The method.
        typed: Options by their name on the command line, None where they were not given.

    Raises:
        OptionError: If one is given with another method.

    Source:
        None (command line).
    """
    given = [name for name, value in typed.items() if value is not None]
    if method != "trajectory" and given:
        raise OptionError(f"{given[0]} belongs to --method trajectory, {method} has no such option")


def rate(name: str, degrees: float | None) -> dict[str, float]:
    """A joint speed or acceleration limit as an option of the solver, if one was typed.

    Args:
        name: Name of the option.
        degrees: The limit, in [deg/s] or [deg/s²], or None.

    Returns:
        The option in [rad/s] or [rad/s²], or nothing.

    Raises:
        OptionError: If the limit is not positive.

    Source:
        None (command line).
    """
    if degrees is None:
        return {}
    if not degrees > 0:
        raise OptionError(f"--{name.replace('_', '-')} is {degrees:g}, expected a positive number")
    return {name: math.radians(degrees)}
