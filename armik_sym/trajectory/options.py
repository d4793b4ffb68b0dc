"""What a user can choose about a whole-trajectory solve."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike

from armik_sym.errors import OptionError
from armik_sym.trajectory.posture_cost.clearance import check_clearance
from armik_sym.trajectory.posture_cost.preference import check_preference

_CLEARANCE = math.radians(10.0)
_WEIGHTS = ("speed_weight", "acceleration_weight", "posture_weight", "clearance_weight", "prefer_weight")


@dataclass(frozen=True)
class TrajectoryOptions:
    """Choices for `solve(..., method="trajectory")`.

    The objective is ∫ speed_weight·|q̇|² + acceleration_weight·|q̈|² + posture_weight·|q - preferred|²
    + clearance_weight·Σ_j φ(m_j/clearance_j) + prefer_weight·(1 - d·u) dt, with soft tracking plus
    ∫ |position error|²/position_sigma² + |rotation error|²/rotation_sigma² dt, halved, and with differences
    between samples in place of derivatives. Here m_j is the distance of joint j from its nearest limit,
    φ(x) = (1 - x)³ for x < 1 and 0 beyond, u the unit vector from shoulder to elbow and d the direction
    preferred for it.

    Attributes:
        orientation: "full", "pointing" (fingers only) or "none"; None takes "full" if the path has
            rotations, otherwise "none".
        tracking: "exact" (every sample is an equation) or "soft" (weighted least squares, for noisy or
            unreachable paths).
        max_speed: Largest joint speed, one number or one per joint, in [rad/s]; the default lies well
            above daily activities. None: no limit.
        max_acceleration: Largest joint acceleration, likewise, in [rad/s²]; None: no limit.
        speed_weight: Weight of squared joint speed, in [1].
        acceleration_weight: Weight of squared joint acceleration, in [s²]; 0.01 s² makes a motion of
            1 rad/s and one of 10 rad/s² cost the same.
        posture_weight: Weight of the distance from mid-range, or from the posture preferred, in [1/s²];
            small, it settles what path and smoothness leave open and keeps away from limits.
        clearance_weight: What a joint at its limit costs, in [1/s²]: as much as a joint that turns at
            √clearance_weight rad/s. 0 (default): no such term. Try 1 to 10.
        clearance: Distance from a limit at which that cost begins, one number or one per joint, in [rad].
            One number is for the joints that turn; joints that slide count only if every joint has its own
            number, theirs in [m]. 0: never. Where half the range h_j is less, it is taken instead, and the
            weight of this joint is multiplied by (h_j/clearance_j)².
        prefer: What to draw the arm to where path and smoothness leave freedom. A posture, shape (dof,), in
            [rad], takes the place of mid-range in the posture term; raise `posture_weight` to draw harder.
            "elbow_low", "elbow_high", "elbow_out" (away from the body) or "elbow_in", or a vector of
            shape (3,) in the base frame of any length: the direction from the shoulder in which the elbow
            should be, for arms with spherical shoulder and hinge elbow. The words need an arm that says
            where up and outward are. None (default): mid-range, no direction.
        prefer_weight: Half of what an elbow costs that points the opposite way, in [1/s²]; at right angles
            to the direction preferred it costs as much as a joint that turns at √prefer_weight rad/s. Only
            where `prefer` is about the elbow.
        position_sigma: Soft tracking: position error that costs one unit, in [m].
        rotation_sigma: Soft tracking: rotation error that costs one unit, in [rad].
        position_tolerance: Position error up to which the solution calls itself ok, in [m]; None means
            1e-9 m for exact tracking, 10 mm for soft.
        rotation_tolerance: The same for the rotation error, in [rad]; None means 1e-9 rad for exact
            tracking, 5° for soft.
        start_tolerance: Difference between a given start posture and the first posture, joint by joint, up
            to which the solution calls itself ok, in [rad].
        search: "auto" (the swivel map where it fits, otherwise full space), "swivel" (insist on the map) or
            "full-space".
        n_best: How many genuinely different trajectories are wanted at most, the best first: others in
            other corridors of the swivel map or other branches. The others are `Solution.alternatives`.
        certify: Also compute a lower bound that no trajectory can beat, to about 1 %; takes a second or a
            few, and tells how far the solution can be from the best one: `Solution.bound`.
        max_iterations: IPOPT iterations per attempt.
        ipopt_output: Let IPOPT print its iterations.

    Source:
        None (this package); compare the travel term of Nguyen 2021, eq. 16.
    """

    orientation: Literal["full", "pointing", "none"] | None = None
    tracking: Literal["exact", "soft"] = "exact"
    max_speed: float | ArrayLike | None = 10.0
    max_acceleration: float | ArrayLike | None = None
    speed_weight: float = 1.0
    acceleration_weight: float = 0.01
    posture_weight: float = 1e-3
    clearance_weight: float = 0.0
    clearance: float | ArrayLike = _CLEARANCE
    prefer: str | ArrayLike | None = None
    prefer_weight: float = 5.0
    position_sigma: float = 1e-3
    rotation_sigma: float = 0.01
    position_tolerance: float | None = None
    rotation_tolerance: float | None = None
    start_tolerance: float = math.radians(1.0)
    search: Literal["auto", "swivel", "full-space"] = "auto"
    n_best: int = 1
    certify: bool = False
    max_iterations: int = 300
    ipopt_output: bool = False

    def __post_init__(self) -> None:
        if self.tracking not in ("exact", "soft"):
            raise OptionError(f"tracking is {self.tracking!r}: valid are exact, soft")
        if self.search not in ("auto", "swivel", "full-space"):
            raise OptionError(f"search is {self.search!r}: valid are auto, swivel, full-space")
        for name in _WEIGHTS:
            _check(name, getattr(self, name), zero=True)
        check_clearance(self.clearance)
        check_preference(self.prefer)
        for name in ("position_sigma", "rotation_sigma", "start_tolerance"):
            _check(name, getattr(self, name), zero=False)
        for name in ("max_iterations", "n_best"):
            _check_count(name, getattr(self, name))
            object.__setattr__(self, name, int(getattr(self, name)))  # 2.0 is a count, too
        for name in ("position_tolerance", "rotation_tolerance"):
            if getattr(self, name) is not None:
                _check(name, getattr(self, name), zero=False)

    @property
    def position_tolerance_or_default(self) -> float:
        """Position error up to which a solution is ok, in [m]."""
        default = 1e-9 if self.tracking == "exact" else 0.01
        return default if self.position_tolerance is None else self.position_tolerance

    @property
    def rotation_tolerance_or_default(self) -> float:
        """Rotation error up to which a solution is ok, in [rad]."""
        default = 1e-9 if self.tracking == "exact" else math.radians(5.0)
        return default if self.rotation_tolerance is None else self.rotation_tolerance


def _check(name: str, value: float, *, zero: bool) -> None:
    if not (_is_finite(value) and (value >= 0 if zero else value > 0)):
        raise OptionError(f"{name} is {value!r}, expected a finite number {'≥' if zero else '>'} 0")


def _check_count(name: str, value: float) -> None:
    if not (_is_finite(value) and value >= 1 and value == int(value)):
        raise OptionError(f"{name} is {value!r}, expected a whole number ≥ 1")


def _is_finite(value: object) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool) and math.isfinite(value)
