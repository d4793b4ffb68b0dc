"""One motion of a report, with everything it is put beside."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from armik_sym.comparison import Comparison, compare
from armik_sym.errors import ArmModelError, OptionError, ShapeError
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.servo import ServoCheck, check
from armik_sym.solution import Solution
from armik_sym.swivel.map import swivel_map
from armik_sym.swivel.map_class import SwivelMap
from armik_sym.swivel.spherical_arm import why_not_spherical
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]

MEASURED_NAME = "measured"


@dataclass(frozen=True, eq=False)
class Chapter:
    """One solved motion of a report.

    Attributes:
        solution: The solution the chapter is about.
        title: What the motion is.
        note: Where the data come from.
        measured: What a person did, or None.
        others: The same task solved in other ways, by name.
        checks: What the drives make of the solution ("") and of the others, by name.
        path_known: Whether the hand path was asked for; False if it only follows from the angles.
    """

    solution: Solution
    title: str
    note: str = ""
    measured: JointMotion | None = None
    others: Mapping[str, Solution] = field(default_factory=lambda: MappingProxyType({}))
    checks: Mapping[str, ServoCheck] = field(default_factory=lambda: MappingProxyType({}))
    path_known: bool = True

    @property
    def servo(self) -> ServoCheck | None:
        """What the drives make of the solution, or None if nobody asked."""
        return self.checks.get("")

    @cached_property
    def differences(self) -> Mapping[str, Comparison]:
        """How far the solution ("") and the others are from the measured motion; empty if none was."""
        if self.measured is None:
            return {}
        motions = {"": self.solution, **self.others}
        return {name: compare(each, self.measured) for name, each in motions.items()}

    @cached_property
    def map(self) -> SwivelMap | None:
        """The swivel map of the hand path, or None where there is none."""
        solution = self.solution
        if solution.orientation is not Orientation.FULL or why_not_spherical(solution.arm) is not None:
            return None
        try:
            return swivel_map(solution.arm, solution.path)
        except ArmModelError:
            return None

    @cached_property
    def motions(self) -> dict[str, Array]:
        """Joint angles at the samples of the solution that can be drawn beside it, by name, (n, dof) each."""
        found = {name: other.q for name, other in self.others.items()}
        measured = None if self.measured is None else _on_samples(self.solution, self.measured)
        return found if measured is None else {MEASURED_NAME: measured, **found}


def chapter_of(
    solution: Solution,
    *,
    measured: JointMotion | None = None,
    others: Mapping[str, Solution] | None = None,
    servo: ServoCheck | bool | None = None,
    title: str | None = None,
    note: str | None = None,
    path_known: bool = True,
) -> Chapter:
    """One motion of a report, checked.

    Args:
        solution: The solution.
        measured: Measured joint angles; joints are matched by name.
        others: Further solutions of the same path, by the name they get in the report. The alternatives of
            the solution come by themselves.
        servo: What the drives make of it, from `servo.check`; True to check solution and others here with
            the drives of the package; None or False for none.
        title: What the motion is; None for arm and method.
        note: Where the data come from; None takes the note of the path.
        path_known: Whether the hand path was asked for; False if it only follows from the angles.

    Returns:
        The chapter.

    Raises:
        OptionError: If something is of the wrong kind.
        ShapeError: If another solution has other joints or samples.
        DriveError: If `servo` is True and the drives do not fit the arm.

    Source:
        None (this package).
    """
    if not isinstance(solution, Solution):
        raise OptionError(
            f"solution is a {type(solution).__name__}, expected a Solution: use solve(arm, path)"
        )
    if measured is not None and not isinstance(measured, JointMotion):
        raise OptionError(
            f"measured is a {type(measured).__name__}, expected a JointMotion: use read_motion(FILE)"
        )
    beside = {f"choice {i}": each for i, each in enumerate(solution.alternatives, start=2)} | dict(
        others or {}
    )
    for name, other in beside.items():
        _check_other(solution, name, other)
    return Chapter(
        solution,
        title or f"Arm {solution.arm.name}, method {solution.method}",
        solution.path.note if note is None else note,
        measured,
        beside,
        _checks(solution, beside, servo),
        path_known,
    )


def _check_other(solution: Solution, name: str, other: object) -> None:
    if not isinstance(other, Solution):
        raise OptionError(f"others[{name!r}] is a {type(other).__name__}, expected a Solution")
    if other.arm.joint_names != solution.arm.joint_names:
        raise ShapeError(
            f"others[{name!r}] has the joints {', '.join(other.arm.joint_names)}, expected those of the "
            f"solution: {', '.join(solution.arm.joint_names)}"
        )
    if other.time.shape != solution.time.shape or not np.allclose(other.time, solution.time):
        raise ShapeError(
            f"others[{name!r}] has {len(other.time)} samples at other times than the solution with "
            f"{len(solution.time)}: give it the same path"
        )


def _checks(
    solution: Solution, others: Mapping[str, Solution], servo: ServoCheck | bool | None
) -> dict[str, ServoCheck]:
    if isinstance(servo, ServoCheck):
        return {"": servo}
    if servo not in (None, True, False):
        raise OptionError(f"servo is {servo!r}, expected a ServoCheck, True or None")
    if not servo:
        return {}
    first = check(solution)
    # The same drives and controllers for all: only the motion differs.
    laws = first.setup.controllers
    return {"": first, **{name: check(other, controller=laws) for name, other in others.items()}}


def _on_samples(solution: Solution, measured: JointMotion) -> Array | None:
    """Measured angles at the times of the solution; None if joints or times are missing."""
    names, time = solution.arm.joint_names, solution.time
    if not set(names) <= set(measured.joint_names):
        return None
    inside = measured.time[0] <= time[0] + 1e-9 and measured.time[-1] >= time[-1] - 1e-9
    q = measured.q[:, [measured.joint_names.index(name) for name in names]]
    if not inside or not np.isfinite(q).all():
        return None
    return np.column_stack([np.interp(time, measured.time, column) for column in q.T])
