"""One row of a Denavit–Hartenberg table."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from enum import Enum

from armik_sym.arm.names import check_identifier
from armik_sym.errors import ArmModelError


class DHConvention(Enum):
    """Which of the two Denavit–Hartenberg conventions the rows of a table follow.

    With θ, d, a, α of row i:

    - STANDARD (distal):   T = Rz(θ) Tz(d) Tx(a) Rx(α)
    - MODIFIED (proximal): T = Rx(α) Tx(a) Rz(θ) Tz(d), where α and a already belong to link i-1

    Source:
        Denavit & Hartenberg (1955); Craig, Introduction to Robotics (proximal form).
    """

    STANDARD = "standard"
    MODIFIED = "modified"


class JointType(Enum):
    """What a row's joint variable moves: the angle θ, the length d, or nothing."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    FIXED = "fixed"


@dataclass(frozen=True)
class DHLink:
    """One row of a DH table: four parameters, of which the joint variable q moves one.

    Revolute: θ = theta + sign·q. Prismatic: d = d + sign·q. Fixed: nothing moves. So `theta` is the
    offset of a revolute joint and `d` that of a prismatic one.

    Attributes:
        name: The joint's name, a plain identifier; say the movement that increases q.
        theta: Angle about z, in [rad].
        d: Shift along z, in [m], or the name of a segment length.
        a: Shift along x, in [m], or the name of a segment length.
        alpha: Angle about x, in [rad].
        joint: What the joint variable moves.
        sign: +1 or -1: the direction in which q counts.

    Raises:
        ArmModelError: If a name is no plain identifier, a number is not finite or `sign` is not ±1.

    Source:
        Nguyen 2021, Table 4; Al-Faiz, Table 1 (rows of this kind).
    """

    name: str
    theta: float = 0.0
    d: float | str = 0.0
    a: float | str = 0.0
    alpha: float = 0.0
    joint: JointType = JointType.REVOLUTE
    sign: int = 1

    def __post_init__(self) -> None:
        check_identifier(self.name, "joint")
        for key in ("theta", "alpha"):
            self._check_number(key)
        for key in ("d", "a"):
            value = getattr(self, key)
            if isinstance(value, str):
                check_identifier(value, "segment length")
            else:
                self._check_number(key)
        if isinstance(self.sign, bool) or self.sign not in (1, -1):
            raise ArmModelError(f"joint {self.name!r}: sign is {self.sign!r}, expected 1 or -1")
        object.__setattr__(self, "sign", int(self.sign))
        if not isinstance(self.joint, JointType):
            raise ArmModelError(f"joint {self.name!r}: joint is {self.joint!r}, expected a JointType")
        if self.joint is JointType.PRISMATIC and isinstance(self.d, str):
            raise ArmModelError(
                f"joint {self.name!r}: a prismatic joint moves d, so d must be a number, not {self.d!r}"
            )

    def _check_number(self, key: str) -> None:
        value = getattr(self, key)
        numeric = isinstance(value, numbers.Real) and not isinstance(value, bool)
        try:
            number = float(value) if numeric else math.nan
        except OverflowError:
            number = math.nan
        if not math.isfinite(number):
            raise ArmModelError(f"joint {self.name!r}: {key} is {value!r}, expected a finite number")
        object.__setattr__(self, key, number)

    @property
    def moves(self) -> bool:
        """True if the row has a joint variable."""
        return self.joint is not JointType.FIXED

    @property
    def length_names(self) -> tuple[str, ...]:
        """Names of the segment lengths this row refers to."""
        return tuple(value for value in (self.d, self.a) if isinstance(value, str))
