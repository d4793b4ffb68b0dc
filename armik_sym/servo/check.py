"""Can the exoskeleton follow this trajectory?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from armik_sym.errors import OptionError, UnknownNameError
from armik_sym.servo.body import RigidBody, Subject
from armik_sym.servo.controller import Controller
from armik_sym.servo.drive import Drive
from armik_sym.servo.given_number import is_number
from armik_sym.servo.linear import in_series
from armik_sym.servo.margins import LoopMargins, loop_margins
from armik_sym.servo.reference import Reference, Solved, check_motion, reference_of
from armik_sym.servo.retiming import Retimed, drive_limits, retime
from armik_sym.servo.setup import ServoOptions, Setup, make_setup
from armik_sym.servo.slower import limit_factor, smallest_factor
from armik_sym.servo.tracking import Tracking, track
from armik_sym.servo.verdict import JointVerdict, Tolerances, joint_verdicts, loop_reasons

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_RETIMING_PRECISION = 0.05


@dataclass(frozen=True, eq=False)
class ServoCheck:
    """Whether drives can follow a motion, and why not.

    Attributes:
        solution: The motion.
        tracking: The simulated closed loops.
        joints: One verdict per joint.
        tolerances: What was judged by.
        largest: Largest factor `slower_by` looks at.
    """

    solution: Solved
    tracking: Tracking
    joints: tuple[JointVerdict, ...]
    tolerances: Tolerances
    largest: float = 10.0

    @property
    def setup(self) -> Setup:
        """Arm, drives and controllers."""
        return self.tracking.setup

    @cached_property
    def reasons(self) -> tuple[str, ...]:
        """What speaks against the drives, one sentence each; empty if nothing does."""
        said = [reason for joint in self.joints for reason in joint.reasons]
        if self.tracking.hand_peak > self.tolerances.hand:
            when = float(self.tracking.time[int(np.argmax(self.tracking.hand_error))])
            said.append(
                f"the hand is {1000 * self.tracking.hand_peak:.3g} mm off at {when:.3g} s, allowed are "
                f"{1000 * self.tolerances.hand:.3g} mm"
            )
        return tuple(said)

    @property
    def ok(self) -> bool:
        """True if the drives can follow the motion."""
        return not self.reasons

    @cached_property
    def slower_by(self) -> float | None:
        """Smallest factor by which all times must be multiplied until the drives can follow; 1.0 if they can.

        The search begins at the exact factor for speeds and torques (`limit_factor`), and finds the rest by
        simulation to 0.2 %. None if not even `largest` is enough.
        Computed when first asked for, which takes a few simulations.
        """
        if self.ok:
            return 1.0
        start = limit_factor(self.setup, self.tracking.reference)
        # No time helps a loop that is not safe.
        if start is None or any(loop_reasons(joint, self.tolerances) for joint in self.joints):
            return None
        return smallest_factor(lambda factor: self.slowed(factor).ok, start, self.largest)

    def slowed(self, factor: float) -> ServoCheck:
        """The same check of the motion made slower.

        Args:
            factor: By which all times are multiplied.

        Returns:
            The check of q(t/factor).

        Raises:
            OptionError: If the factor is not positive.

        Source:
            None (this package).
        """
        if not (is_number(factor) and factor > 0):
            raise OptionError(f"factor is {factor!r}, expected a positive number")
        reference = reference_of(self.solution, self.setup.rate, factor)
        margins = tuple(joint.margins for joint in self.joints)
        return _judged(self.solution, self.setup, reference, margins, self.tolerances, self.largest)

    def retimed(self, *, ends: str = "uniform", faster: bool = False) -> tuple[Retimed, ServoCheck] | None:
        """The motion as fast as the drives allow along its path, and its check.

        Limits come from the drives (`drive_limits`); if the re-timed motion is not followed well enough, they
        are tightened, speed by 1/f and acceleration by 1/f², until it is.

        Args:
            ends: As of `retime`.
            faster: As of `retime`.

        Returns:
            Motion and check; None if even f = `largest` is not enough.

        Raises:
            RetimingError: If the motion cannot be re-timed at all.

        Source:
            Bobrow, Dubowsky & Gibson 1985; this package.
        """
        speed, acceleration = drive_limits(self.setup, np.asarray(self.solution.q))
        margins = tuple(joint.margins for joint in self.joints)
        tried: dict[float, tuple[Retimed, ServoCheck]] = {}

        def good(f: float) -> bool:
            motion = retime(self.solution, speed / f, acceleration / f**2, ends=ends, faster=faster)
            reference = reference_of(motion, self.setup.rate)
            tried[f] = motion, _judged(motion, self.setup, reference, margins, self.tolerances, self.largest)
            return tried[f][1].ok

        found = smallest_factor(good, 1.0, self.largest, precision=_RETIMING_PRECISION)
        return None if found is None else tried[found]

    def __str__(self) -> str:
        from armik_sym.servo.text import summary

        return summary(self)

    def plot(self, *, title: str | None = None) -> Figure:
        """Wanted and reached angles, tracking errors, torques against limits, in one figure.

        Args:
            title: What the motion is.

        Returns:
            A matplotlib figure; angles in [deg], the hand in [mm], torques in [Nm].

        Source:
            None (reporting).
        """
        from armik_sym.report.servo_figure import servo_figure

        return servo_figure(self, title=title)

    def plot_loops(self) -> Figure:
        """Bode plots and step responses of all loops, in one figure.

        Returns:
            A matplotlib figure.

        Source:
            None (reporting).
        """
        from armik_sym.report.servo_loops_figure import servo_loops_figure

        return servo_loops_figure(self.setup, tuple(joint.margins for joint in self.joints))


def check(
    solution: Solved,
    drive: Drive | str | None = None,
    controller: str | Sequence[Controller] = "cascade",
    *,
    tolerances: Tolerances | None = None,
    subject: Subject | None = None,
    bodies: Sequence[RigidBody] | None = None,
    largest: float = 10.0,
    **options: Any,
) -> ServoCheck:
    """Simulate the drives of an exoskeleton following a motion, and judge them.

    Args:
        solution: A solution, a re-timed one, or anything with `arm`, `time` and `q`.
        drive: The drives, a name or file of them, or None for those of the package.
        controller: "cascade" or "pid", tuned here, or one `Cascade` or `Pid` per joint.
        tolerances: What must be kept.
        subject: The person; None for the mean male subject of the table.
        bodies: What moves, instead of person and device.
        largest: Largest factor `slower_by` looks at.
        **options: Of `ServoOptions`: bandwidth [Hz], phase_margin [rad], feedforward, gravity, rate [Hz].

    Returns:
        The check.

    Raises:
        DriveError: If drive, arm and bodies do not fit.
        TuningError: If a controller cannot be tuned as asked.
        OptionError: If an option has a value that cannot be.
        UnknownNameError: If an option does not exist.
        ShapeError: If the motion has fewer than two samples.
        HandPathError: If an angle is not finite.

    Source:
        Siciliano et al. 2009, §8.3-8.4; this package.
    """
    check_motion(solution)
    if not (is_number(largest) and largest >= 1):
        raise OptionError(f"largest is {largest!r}, expected a factor of at least 1")
    chosen = _options(options, controller)
    given = None if isinstance(controller, str) else controller
    setup = make_setup(
        solution.arm, np.asarray(solution.q), drive=drive, options=chosen, subject=subject, bodies=bodies,
        controllers=given,
    )  # fmt: skip
    margins = tuple(
        loop_margins(in_series(law.sampled(plant.step), plant.sampled()))
        for law, plant in zip(setup.controllers, setup.plants, strict=True)
    )
    need = Tolerances() if tolerances is None else tolerances
    return _judged(solution, setup, reference_of(solution, setup.rate), margins, need, largest)


def _options(options: dict[str, Any], controller: str | Sequence[Controller]) -> ServoOptions:
    valid = ("bandwidth", "phase_margin", "feedforward", "gravity", "rate")
    for name in options:
        if name not in valid:
            raise UnknownNameError("option of the servo", name, valid)
    chosen = ServoOptions(**options)
    return replace(chosen, controller=controller) if isinstance(controller, str) else chosen


def _judged(
    solution: Solved,
    setup: Setup,
    reference: Reference,
    margins: tuple[LoopMargins, ...],
    tolerances: Tolerances,
    largest: float,
) -> ServoCheck:
    tracking = track(setup, reference)
    return ServoCheck(solution, tracking, joint_verdicts(tracking, margins, tolerances), tolerances, largest)
