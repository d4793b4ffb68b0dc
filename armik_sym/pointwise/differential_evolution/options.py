"""What a user can choose about ISADE and Pro-ISADE."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Literal, get_args

from armik_sym.errors import OptionError
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.judging import Judging, positive_number, whole_number
from armik_sym.symbolic import Orientation

Measure = Literal["position", "cosines", "pose"]
Repair = Literal["clip", "reflect", "random", "midpoint"]
Sign = Literal["printed", "original"]
RotationMeasure = Literal["chordal", "cosines"]

SMALLEST_POPULATION = 5

# One sample takes seconds then, the first one three times as many: no search is interrupted.
LARGEST_WORK = 10_000_000


@dataclass(frozen=True, kw_only=True)
class IsadeOptions(Judging):
    """Choices for `solve(..., method="isade")`.

    What the paper leaves open was chosen by `python benchmarks/isade.py --choose`. From one sample to the
    next nothing keeps the posture near the one before (a = 0), so joints may jump; Pro-ISADE bounds that.

    Give `start`, the posture at the beginning: without it the search sets out from the middle of the range
    of motion, at another posture with the same hand, and some paths then run into a limit of the range or
    miss the first sample (1 of 150 runs of Pro-ISADE on the measured tasks each; with `start`, none).

    Attributes:
        stop: Weighted hand error b·‖error‖ below which a sample is reached, in [m]; Table 5: 1e-5 mm.
        iter_max: Largest number of generations per sample, at the first sample twice; Table 5: 150 (the
            text of §4.2 says 600).
        population: Number of individuals NP, at least 5; not in the paper. None: 50 for the position
            alone, 150 for position and rotation.
        sign: Scale factor of eq. (14): "printed" F = (F_i - F_mean)/2, or "original" F = (F_i + F_mean)/2,
            which falls with the generations as the text asks, and needs three times as many.
        alpha: Gain of the sigmoid, eq. (12); not in the paper.
        f_min: Lower end of F_mean, eq. (13); not in the paper.
        f_max: Upper end of F_mean, eq. (13); not in the paper.
        n_iter: Exponent of eq. (13); not in the paper.
        tau: Odds with which an individual draws a new crossover rate, eq. (15); paper: 0.1.
        repair: What happens to a coordinate of a mutant outside its bounds: "clip" to the bound, "reflect"
            at it, "random" inside, or "midpoint" of bound and base vector; not in the paper.
        travel_weight: a of eq. (16) at the first sample, in [m/rad]; not in the paper. The travel term is
            an exact penalty: the hand error vanishes at the best posture if a is below b times the
            smallest singular value of the Jacobian, mostly 0.05 m/rad and more.
        hand_weight: b of eq. (16); not in the paper.
        rotation_measure: With orientation "full": "chordal", all of the rotation, |R - R*|_F/√2, or
            "cosines", the three direction cosines of eq. (16), read as the diagonal of R (which leave
            several orientations open; Pro-ISADE then misses a fifth of the samples of playing ball).
        rotation_weight: Length that weighs like one radian (chordal) or like 1 (cosines), in [m].
        stall: A search whose costs differ by less than this many times the best has contracted around a
            posture that is not good enough: another one begins, within the same iter_max generations. Not
            in the paper; 0: never, as published. Larger values give up earlier, and now and then too early.

    Raises:
        OptionError: If a value makes no sense.

    Source:
        Nguyen 2021, §3, §4.2, eq. 9-16, Table 5.
    """

    stop: float = 1e-8
    iter_max: int = 150
    population: int | None = None
    sign: Sign = "printed"
    alpha: float = 4.0
    f_min: float = 0.3
    f_max: float = 0.6
    n_iter: float = 1.0
    tau: float = 0.1
    repair: Repair = "clip"
    travel_weight: float = 0.03
    hand_weight: float = 1.0
    rotation_measure: RotationMeasure = "chordal"
    rotation_weight: float = 0.3
    stall: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("stop", "n_iter", "hand_weight", "rotation_weight"):
            positive_number(name, getattr(self, name))
        for name, low, high in (
            ("alpha", 0, 600),
            ("f_min", 0, 2),
            ("f_max", 0, 2),
            ("tau", 0, 1),
            ("travel_weight", 0, math.inf),
            ("stall", 0, math.inf),
        ):
            _between(name, getattr(self, name), low, high)
        if self.f_min > self.f_max:
            raise OptionError(
                f"f_min is {self.f_min!r}, above f_max = {self.f_max!r}: expected f_min ≤ f_max"
            )
        whole_number("iter_max", self.iter_max, 1)
        if self.population is not None:
            reason = "the mutations take four individuals besides the current one"
            whole_number("population", self.population, SMALLEST_POPULATION, reason)
        for name, largest in (("iter_max", 10**6), ("population", 10**5)):
            if (getattr(self, name) or 0) > largest:
                raise OptionError(f"{name} is {getattr(self, name)!r}, expected at most {largest}")
        if self.work_for("pose") > LARGEST_WORK:
            raise OptionError(
                f"iter_max is {self.iter_max!r} with population {self.population_for('pose')!r}: expected "
                f"population · iter_max · (1 + population/1000) ≤ {LARGEST_WORK}, or a sample takes minutes"
            )
        for name, valid in (("sign", Sign), ("repair", Repair), ("rotation_measure", RotationMeasure)):
            if getattr(self, name) not in get_args(valid):
                raise OptionError(
                    f"{name} is {getattr(self, name)!r}: valid are {', '.join(get_args(valid))}"
                )

    @property
    def half_window(self) -> float:
        """Half width of the search window around the previous posture, in [rad]; here infinite."""
        return math.inf

    @property
    def window_moves(self) -> bool:
        """Whether the window moves to the best posture after a stall; without a window, no matter."""
        return False

    @property
    def method(self) -> str:
        """Name of the method."""
        return "isade"

    def measure_for(self, targets: HandTargets) -> Measure:
        """What of the hand error counts for these targets.

        Args:
            targets: What has to be reached.

        Returns:
            "position", "cosines" or "pose".

        Source:
            Nguyen 2021, eq. 16.
        """
        if targets.orientation is Orientation.NONE:
            return "position"
        return "cosines" if self.rotation_measure == "cosines" else "pose"

    def population_for(self, measure: Measure) -> int:
        """Number of individuals.

        Args:
            measure: What of the hand error counts.

        Returns:
            The number.

        Source:
            None (benchmarks/isade.py).
        """
        return self.population or (50 if measure == "position" else 150)

    def work_for(self, measure: Measure) -> int:
        """Most cost evaluations of a sample, with what ranking them costs, which is quadratic in NP.

        Args:
            measure: What of the hand error counts.

        Returns:
            NP·iter_max·(1 + NP/1000), rounded up.

        Source:
            None (measured).
        """
        population = self.population_for(measure)
        return -(-population * self.iter_max * (1000 + population) // 1000)


@dataclass(frozen=True, kw_only=True)
class ProIsadeOptions(IsadeOptions):
    """Choices for `solve(..., method="pro-isade")`: those of ISADE and the search window.

    The window bounds the step from sample to sample and nothing more. With the position alone, any posture
    in it that reaches the point is as good as any other: the redundant joints wander, by steps up to the
    window. On the measured tasks with five joints, the rotation of the upper arm and the pronation (which
    does not move the wrist at all) travel 3 to 200 times as far as measured, the elbow as far as measured,
    and the mean joint error is 5° to 24°.

    Give `start` as for ISADE, and see there for `stall`, which is not in the paper either.

    Attributes:
        window: Half width of the window around the previous optimum, in [rad] (prismatic joints: [m]);
            Table 5: π/100. Never left, so no joint moves farther between two samples.
        moving_window: After a stall, look in a window around the best posture so far instead: a path that
            moves faster than a window per sample is then followed in several windows. Not in the paper.

    Source:
        Nguyen 2021, §3.3, §4.2, Table 5.
    """

    window: float = math.pi / 100
    moving_window: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        positive_number("window", self.window)
        if not isinstance(self.moving_window, bool):
            raise OptionError(f"moving_window is {self.moving_window!r}, expected True or False")

    @property
    def half_window(self) -> float:
        """Half width of the search window around the previous posture, in [rad]."""
        return self.window

    @property
    def window_moves(self) -> bool:
        """Whether the window moves to the best posture after a stall."""
        return self.moving_window

    @property
    def method(self) -> str:
        """Name of the method."""
        return "pro-isade"


def _between(name: str, value: object, low: float, high: float) -> None:
    number = isinstance(value, numbers.Real) and not isinstance(value, bool)
    if not number or not (low <= float(value) <= high and math.isfinite(float(value))):  # type: ignore[arg-type]
        limits = f"a finite number ≥ {low}" if math.isinf(high) else f"a number between {low} and {high}"
        raise OptionError(f"{name} is {value!r}, expected {limits}")
