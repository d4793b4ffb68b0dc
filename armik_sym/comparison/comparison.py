"""A solution beside what was measured."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.display_units import JointUnit, joint_unit
from armik_sym.comparison.difference import Difference, difference_of
from armik_sym.solution import Solution

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Comparison:
    """How far a solution is from the measured motion of the same arm, sample by sample and summarised.

    Two motions can put the hand on the same path: a difference is no error of the solution, it says how far
    its choice is from this person's.

    Attributes:
        solution: The solution.
        time: Time stamps that are compared, shape (k,), in [s].
        joint_names: Joints that were measured, j of them.
        q: Their solved angles, shape (k, j), in [rad].
        measured: Their measured angles, NaN where missing, shape (k, j), in [rad]; of joints that can turn
            round on the turn nearest to the solution.
        swivel: Swivel angle of the solution, without jumps, shape (k,), in [rad]; None where the arm has
            none or not all joints were measured.
        swivel_difference: Solved minus measured, -π to π, NaN where missing or where the elbow is within
            10 mm of the line from shoulder to wrist, shape (k,), in [rad], or None.
        elbow: Elbow of the solution in the base frame, shape (k, 3), in [m], or None.
        measured_elbow: Elbow of the measured posture of this arm, shape (k, 3), in [m], or None.
        notes: What was done to the data and what was left out, one sentence each.

    Source:
        Compare Nguyen 2021, Table 6 and Figs. 9-13.
    """

    solution: Solution
    time: Array
    joint_names: tuple[str, ...]
    q: Array
    measured: Array
    swivel: Array | None
    swivel_difference: Array | None
    elbow: Array | None
    measured_elbow: Array | None
    notes: tuple[str, ...] = ()

    @property
    def joint_difference(self) -> Array:
        """Solved minus measured angle, NaN where missing, shape (k, j), in [rad]."""
        return np.asarray(self.q - self.measured)

    @property
    def elbow_difference(self) -> Array | None:
        """Distance between solved and measured elbow, NaN where missing, shape (k,), in [m], or None."""
        if self.elbow is None or self.measured_elbow is None:
            return None
        return np.asarray(np.linalg.norm(self.elbow - self.measured_elbow, axis=1))

    @cached_property
    def units(self) -> tuple[JointUnit, ...]:
        """Units in which the joints are shown, one each."""
        arm = self.solution.arm
        return tuple(joint_unit(arm, arm.joint_names.index(name)) for name in self.joint_names)

    @cached_property
    def joints(self) -> tuple[Difference, ...]:
        """Summary for each joint, in [rad]."""
        return tuple(difference_of(self.time, column) for column in self.joint_difference.T)

    @cached_property
    def all_joints(self) -> Difference:
        """Summary over all joints that turn and all samples together, in [rad]."""
        turning = [i for i, unit in enumerate(self.units) if unit.si == "rad"]
        together = self.joint_difference[:, turning]
        return difference_of(np.repeat(self.time, len(turning)), together.ravel())

    @cached_property
    def swivel_summary(self) -> Difference | None:
        """Summary of the swivel difference, in [rad], or None."""
        apart = self.swivel_difference
        return None if apart is None else difference_of(self.time, apart)

    @cached_property
    def elbow_summary(self) -> Difference | None:
        """Summary of the distance between the elbows, in [m], or None."""
        apart = self.elbow_difference
        return None if apart is None else difference_of(self.time, apart)

    def __str__(self) -> str:
        from armik_sym.comparison.text import summary

        return summary(self)

    def __repr__(self) -> str:
        return (
            f"Comparison(method {self.solution.method}, {len(self.time)} samples, "
            f"joints {', '.join(self.joint_names)})"
        )

    def plot(self, *, title: str | None = None) -> Figure:
        """Draw solved over measured angles, and their difference below each.

        Args:
            title: What the motion is.

        Returns:
            A matplotlib figure; angles in [deg], elbow in [mm], time in [s].

        Source:
            Compare Nguyen 2021, Figs. 9-13.
        """
        from armik_sym.report.comparison_figure import comparison_figure

        return comparison_figure(self, title=title)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write solved, measured and difference of every sample as CSV, in degrees and millimetres.

        Args:
            path: The file, ending in .csv.

        Returns:
            The path written.

        Raises:
            MotionFileError: If the ending is another one or the file cannot be written.

        Source:
            None (file format of this package).
        """
        from armik_sym.comparison.csv_files import write_samples

        return write_samples(self, Path(path))
