"""What a user can choose about Levenberg-Marquardt and Sugihara's method."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Literal

from armik_sym.errors import OptionError
from armik_sym.pointwise.judging import Judging, positive_number, whole_number

# More would overflow the counters of the C loop.
_MOST = 1_000_000


@dataclass(frozen=True, kw_only=True)
class LmOptions(Judging):
    """Choices for `solve(..., method="lm")`.

    θ_(k+1) = θ_k + [JᵀJ + (μ + c) I]⁻¹ Jᵀe with e = [p* - p; L·axis-angle] and J = ∂F/∂θ; a step that does
    not make |e| smaller is undone. Defaults by experiment, see `benchmarks/one_pose.py`.

    Attributes:
        tolerance: A sample counts as reached where |e| is smaller, in [m].
        max_iterations: Steps tried per start posture.
        restarts: Further start postures per sample, random ones inside the range of motion; the paper has
            none. A sample reached from one of them may lie far from the posture before.
        rotation_weight: Length L at which a turn of 1 rad counts like a shift, in [m].
        damping: First μ, in [m²].
        increase: μ is multiplied with it after a step that does not help; above 1.
        decrease: μ is multiplied with it after a step that helps; between 0 and 1.
        constant_damping: c of eq. 63, in [m²], against singularities; makes convergence linear.
        residual: "corrected", or "printed" for eq. 51-53 as printed: from a cold start they find no pose at
            all, and where the hand is turned away by 180° they call it reached.

    Raises:
        OptionError: If a value makes no sense.

    Source:
        Al-Faiz, eq. 58-63; Marquardt (1963), doi:10.1137/0111030, for the factor 10.
    """

    tolerance: float = 1e-9
    max_iterations: int = 100
    restarts: int = 0
    rotation_weight: float = 0.3
    damping: float = 0.1
    increase: float = 10.0
    decrease: float = 0.1
    constant_damping: float = 0.0
    residual: Literal["corrected", "printed"] = "corrected"

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_common(self)
        if not (_is_number(self.increase) and 1 < self.increase < math.inf):
            raise OptionError(f"increase is {self.increase!r}, expected a finite number > 1")
        if not (_is_number(self.decrease) and 0 < self.decrease < 1):
            raise OptionError(f"decrease is {self.decrease!r}, expected a number between 0 and 1")
        if not (_is_number(self.constant_damping) and 0 <= self.constant_damping < math.inf):
            raise OptionError(
                f"constant_damping is {self.constant_damping!r}, expected a finite number ≥ 0, in m²"
            )


@dataclass(frozen=True, kw_only=True)
class SugiharaOptions(Judging):
    """Choices for `solve(..., method="sugihara")`.

    θ_(k+1) = θ_k + [JᵀJ + (½|e|² + w) I]⁻¹ Jᵀe with e = [p* - p; L·axis-angle] and J = ∂F/∂θ. Every step is
    taken, as in the original; the best posture on the way is the answer.

    Attributes:
        tolerance: A sample counts as reached where |e| is smaller, in [m].
        max_iterations: Steps per start posture.
        restarts: Further start postures per sample, random ones inside the range of motion; the paper has
            none. A sample reached from one of them may lie far from the posture before.
        rotation_weight: Length L at which a turn of 1 rad counts like a shift, in [m]; its square is the
            weight of rotations in W_E.
        damping: w, in [m²]. About 1e-3 of the squared link length, 1e-4 m² for an arm, is what the method
            is often used with; it takes a third more steps and finds 1 % fewer poses from a cold start.
        residual: "corrected", or "printed" for Al-Faiz, eq. 51-53 as printed, see `LmOptions`.

    Raises:
        OptionError: If a value makes no sense.

    Source:
        Sugihara (2011), doi:10.1109/TRO.2011.2148230.
    """

    tolerance: float = 1e-9
    max_iterations: int = 100
    restarts: int = 0
    rotation_weight: float = 0.3
    damping: float = 1e-8
    residual: Literal["corrected", "printed"] = "corrected"

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_common(self)


def _check_common(options: LmOptions | SugiharaOptions) -> None:
    for name in ("tolerance", "rotation_weight", "damping"):
        positive_number(name, getattr(options, name))
    for name, least in (("max_iterations", 1), ("restarts", 0)):
        value = getattr(options, name)
        whole_number(name, value, least)
        if value > _MOST:
            raise OptionError(f"{name} is {value!r}, expected at most {_MOST:,}")
    if options.residual not in ("corrected", "printed"):
        raise OptionError(f"residual is {options.residual!r}: valid are corrected, printed")


def _is_number(value: object) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)
