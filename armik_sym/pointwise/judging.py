"""What every pointwise method is judged by."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike

from armik_sym.errors import OptionError


@dataclass(frozen=True, kw_only=True)
class Judging:
    """Choices all pointwise methods share.

    Attributes:
        orientation: "full" or "none"; None takes "full" if the path has rotations, otherwise "none".
        position_tolerance: Position error up to which a solution calls itself ok, in [m].
        rotation_tolerance: Rotation error up to which a solution calls itself ok, in [rad].
        max_speed: Largest joint speed of a solution that calls itself ok, one number or one per joint, in
            [rad/s]; None: any. The methods themselves know no speed.
        start_tolerance: Difference between a given start posture and the first posture, joint by joint, up
            to which the solution calls itself ok, in [rad].

    Raises:
        OptionError: If a value makes no sense.

    Source:
        None (this package).
    """

    orientation: Literal["full", "none"] | None = None
    position_tolerance: float = 1e-6
    rotation_tolerance: float = 1e-5
    max_speed: float | ArrayLike | None = 10.0
    start_tolerance: float = math.radians(1.0)

    def __post_init__(self) -> None:
        for name in ("position_tolerance", "rotation_tolerance", "start_tolerance"):
            positive_number(name, getattr(self, name))
        if self.orientation not in (None, "full", "none"):
            raise OptionError(f"orientation is {self.orientation!r}: valid are full, none")


def positive_number(name: str, value: object) -> None:
    """Refuse what is no finite number above 0.

    Args:
        name: Name of the option.
        value: Its value.

    Raises:
        OptionError: If it is none.

    Source:
        None (input check).
    """
    number = isinstance(value, numbers.Real) and not isinstance(value, bool)
    if not number or not 0 < float(value) < math.inf:  # type: ignore[arg-type]
        raise OptionError(f"{name} is {value!r}, expected a finite number > 0")


def whole_number(name: str, value: object, least: int, why: str = "") -> None:
    """Refuse what is no whole number from a least one on.

    Args:
        name: Name of the option.
        value: Its value.
        least: The least valid number.
        why: Why it has to be that large, for the message.

    Raises:
        OptionError: If it is none.

    Source:
        None (input check).
    """
    whole = isinstance(value, numbers.Integral) and not isinstance(value, bool)
    if not whole or int(value) < least:  # type: ignore[call-overload]
        reason = f" ({why})" if why else ""
        raise OptionError(f"{name} is {value!r}, expected a whole number ≥ {least}{reason}")
