"""A solved joint trajectory that judges itself."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import ShapeError
from armik_sym.motion.hand_path import HandPath
from armik_sym.solution.lower_bound import LowerBound
from armik_sym.solution.motion_rates import arc_length, joint_acceleration, joint_speed
from armik_sym.solution.timing import Timing
from armik_sym.solution.tracking_error import tracking_errors
from armik_sym.solution.verdict import Requirements, reasons_against
from armik_sym.symbolic import Orientation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from armik_sym.motion.joint_motion import JointMotion
    from armik_sym.servo import ServoCheck

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Solution:
    """Joint angles over time, and what they are worth.

    Everything but the first group is computed here from the angles, by a plain product of transforms,
    not copied from any solver.

    Attributes:
        arm: The arm.
        path: The hand path asked for.
        q: Joint angles, shape (n, dof), in [rad].
        method: Name of the method.
        orientation: What of the path's orientation was tracked.
        requirements: What `ok` is judged by.
        start: Known posture at the beginning, shape (dof,), in [rad], or None.
        seed: Seed of everything random in the solve.
        timing: Where the time went.
        status: The solver's own word.
        iterations: Iterations of the solver, of all samples together.
        reached: Whether a pointwise method met its own stop criterion at each sample, shape (n,); None for
            methods that solve all samples at once.
        sample_iterations: Iterations or generations a pointwise method spent on each sample, shape (n,), or
            None.
        settings: Options used, for the record.
        cost: Value of the objective the method minimised, in [1/s]; None if it has none.
        alternatives: Other trajectories that were asked for, by increasing cost.
        bound: What no feasible trajectory can cost less than, if that was asked for.

    Raises:
        ShapeError: If `q` does not fit path and arm.
    """

    arm: Arm
    path: HandPath
    q: Array
    method: str
    orientation: Orientation
    requirements: Requirements
    start: Array | None = None
    seed: int = 0
    timing: Timing = field(default_factory=Timing)
    status: str = ""
    iterations: int = 0
    reached: NDArray[np.bool_] | None = None
    sample_iterations: NDArray[np.int64] | None = None
    settings: Mapping[str, object] = field(default_factory=dict)
    cost: float | None = None
    alternatives: tuple[Solution, ...] = ()
    bound: LowerBound | None = None

    def __post_init__(self) -> None:
        q = np.array(self.q, dtype=np.float64)
        if q.shape != (len(self.path), self.arm.dof):
            raise ShapeError(
                f"q has shape {q.shape}, expected ({len(self.path)}, {self.arm.dof}): one row per sample of "
                f"the path, one column per joint of arm {self.arm.name!r}"
            )
        q.flags.writeable = False
        object.__setattr__(self, "q", q)

    @property
    def time(self) -> Array:
        """Time stamps, shape (n,), in [s]."""
        return self.path.time

    @cached_property
    def _errors(self) -> tuple[Array, Array]:
        return tracking_errors(self.arm, self.q, self.path.position, self.path.rotation, self.orientation)

    @property
    def position_error(self) -> Array:
        """Distance from hand to path, shape (n,), in [m]."""
        return self._errors[0]

    @property
    def rotation_error(self) -> Array:
        """Angle between hand and path, shape (n,), in [rad]; 0 where orientation is not tracked."""
        return self._errors[1]

    @cached_property
    def rom_margin(self) -> Array:
        """Smallest distance of each joint to its limits, shape (dof,), in [rad]; negative outside."""
        margin: Array = self.arm.rom.margin(self.q).min(axis=0)
        return margin

    @cached_property
    def max_step(self) -> Array:
        """Largest change of each joint between two samples, shape (dof,), in [rad]."""
        step: Array = np.abs(np.diff(self.q, axis=0)).max(axis=0, initial=0.0)
        return step

    @cached_property
    def max_speed(self) -> Array:
        """Largest speed of each joint, shape (dof,), in [rad/s]."""
        speed: Array = np.abs(joint_speed(self.time, self.q)).max(axis=0, initial=0.0)
        return speed

    @cached_property
    def max_acceleration(self) -> Array:
        """Largest acceleration of each joint, shape (dof,), in [rad/s²]."""
        peak: Array = np.abs(joint_acceleration(self.time, self.q)).max(axis=0, initial=0.0)
        return peak

    @cached_property
    def arc_length(self) -> float:
        """Length of the way through joint space, in [rad]."""
        return arc_length(self.q)

    @cached_property
    def reasons(self) -> tuple[str, ...]:
        """What speaks against the solution, one sentence each; empty if nothing does."""
        return reasons_against(self)

    @property
    def ok(self) -> bool:
        """True if the solution is what was asked for."""
        return not self.reasons

    def __str__(self) -> str:
        from armik_sym.solution.text import summary

        return summary(self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the solution to a file: `.csv` (degrees, units in the header), `.npz` (SI), `.mot` or `.sto`.

        `.mot` and `.sto` are those of OpenSim: rotations in degrees, translations in metres.

        Args:
            path: The file; its ending chooses the format.

        Returns:
            The path written.

        Raises:
            MotionFileError: If the ending is unknown or the file cannot be written.

        Source:
            None (file formats of this package).
        """
        from armik_sym.solution.save import save

        return save(self, Path(path))

    def plot(self) -> Figure:
        """Joint angles with their range of motion, tracking error and speed, in one figure.

        Returns:
            A matplotlib figure; angles in [deg], errors in [mm] and [deg].

        Source:
            Compare Nguyen 2021, Figs. 9-13.
        """
        from armik_sym.report.solution_figure import solution_figure

        return solution_figure(self)

    def report(
        self,
        path: str | os.PathLike[str],
        *,
        measured: JointMotion | None = None,
        others: Mapping[str, Solution] | None = None,
        servo: ServoCheck | bool | None = None,
        title: str | None = None,
        note: str | None = None,
    ) -> Path:
        """Write one HTML file that shows the solution to a therapist and an engineer, without a network.

        Verdict, an arm that can be turned and played, the swivel map, joint angles in their ranges, errors,
        speeds, what the drives make of it, comparisons, and all settings.

        Args:
            path: The file, ending in .html.
            measured: Measured joint angles; joints are matched by name.
            others: Further solutions of the same path, by the name they get in the report.
            servo: What the drives make of it, from `servo.check`; True to check it here with the drives of
                the package.
            title: What the motion is; None for arm and method.
            note: Where the data come from; None takes the note of the path.

        Returns:
            The path written.

        Raises:
            OptionError: If something is of the wrong kind.
            ShapeError: If another solution has other joints or samples.
            DriveError: If `servo` is True and the drives do not fit the arm.
            MotionFileError: If the file cannot be written.

        Source:
            None (this package).
        """
        from armik_sym.report.html import chapter_of, write_report

        chapter = chapter_of(self, measured=measured, others=others, servo=servo, title=title, note=note)
        return write_report(path, [chapter])
