"""How far each joint may turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.errors import ArmModelError


@dataclass(frozen=True, eq=False)
class RangeOfMotion:
    """Lower and upper limit of every joint: lower ≤ q ≤ upper.

    Attributes:
        lower: Lower limits, shape (dof,), in [rad] (prismatic: [m]); read-only.
        upper: Upper limits, shape (dof,), in [rad] (prismatic: [m]); read-only.

    Raises:
        ArmModelError: If shapes differ, a limit is not finite, or a lower limit exceeds its upper one.

    Source:
        Nguyen 2021, Table 2.
    """

    lower: NDArray[np.float64]
    upper: NDArray[np.float64]

    def __post_init__(self) -> None:
        for key in ("lower", "upper"):
            try:
                values = np.array(getattr(self, key), dtype=np.float64)
            except (TypeError, ValueError):
                raise ArmModelError(
                    f"range of motion: {key} is {getattr(self, key)!r}, expected numbers, shape (dof,)"
                ) from None
            if values.ndim != 1 or values.size == 0:
                raise ArmModelError(f"range of motion: {key} has shape {values.shape}, expected (dof,)")
            if not np.all(np.isfinite(values)):
                bad = int(np.flatnonzero(~np.isfinite(values))[0])
                raise ArmModelError(
                    f"range of motion: {key} limit of joint {bad + 1} is {values[bad]}, expected a finite "
                    "angle"
                )
            values.flags.writeable = False
            object.__setattr__(self, key, values)
        if self.lower.shape != self.upper.shape:
            raise ArmModelError(
                f"range of motion: {len(self.lower)} lower limits but {len(self.upper)} upper ones"
            )
        crossed = np.flatnonzero(self.lower > self.upper)
        if crossed.size:
            i = int(crossed[0])
            raise ArmModelError(
                f"range of motion: joint {i + 1} has lower limit {self.lower[i]:g} above upper limit "
                f"{self.upper[i]:g} rad"
            )

    @classmethod
    def from_degrees(cls, lower_deg: ArrayLike, upper_deg: ArrayLike) -> RangeOfMotion:
        """Build a range of motion from degrees: limit = limit_deg · π/180.

        Args:
            lower_deg: Lower limits, shape (dof,), in [deg].
            upper_deg: Upper limits, shape (dof,), in [deg].

        Returns:
            The range of motion, in [rad].

        Raises:
            ArmModelError: As for the class.

        Source:
            Nguyen 2021, Table 2 (printed in degrees).
        """
        return cls(np.deg2rad(np.asarray(lower_deg)), np.deg2rad(np.asarray(upper_deg)))

    @property
    def dof(self) -> int:
        """Number of joints."""
        return len(self.lower)

    @property
    def middle(self) -> NDArray[np.float64]:
        """The posture in the middle of every range, shape (dof,), in [rad]."""
        return 0.5 * (self.lower + self.upper)

    @property
    def width(self) -> NDArray[np.float64]:
        """Upper minus lower limit, shape (dof,), in [rad]."""
        return self.upper - self.lower

    def random_postures(self, rng: np.random.Generator, count: int) -> NDArray[np.float64]:
        """Postures drawn evenly from the range: lower + u·(upper - lower), u in [0, 1).

        Args:
            rng: The random numbers.
            count: How many.

        Returns:
            Postures, shape (count, dof), in [rad].

        Source:
            None (uniform distribution).
        """
        return self.lower + self.width * rng.uniform(0, 1, (count, self.dof))

    def margin(self, q: ArrayLike) -> NDArray[np.float64]:
        """Distance to the nearer limit: min(q - lower, upper - q), negative outside.

        Args:
            q: Joint angles, shape (dof,) or (n, dof), in [rad].

        Returns:
            Margin of every joint, same shape as `q`, in [rad].

        Source:
            None (definition).
        """
        values = np.asarray(q, dtype=np.float64)
        return np.minimum(values - self.lower, self.upper - values)

    def clip(self, q: ArrayLike) -> NDArray[np.float64]:
        """The nearest posture inside: min(max(q, lower), upper).

        Args:
            q: Joint angles, shape (dof,) or (n, dof), in [rad].

        Returns:
            Joint angles inside the range, same shape as `q`, in [rad].

        Source:
            None (definition).
        """
        return np.clip(np.asarray(q, dtype=np.float64), self.lower, self.upper)
