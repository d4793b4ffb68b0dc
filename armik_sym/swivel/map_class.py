"""The swivel map: over time, where the elbow can be while the hand follows its path."""

from __future__ import annotations

import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.errors import OptionError, ShapeError
from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.blocking import Blocking, blocking
from armik_sym.swivel.branch_words import branch_names
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.clearance import Clearance, IntervalEnds, clearance, interval_ends
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.swivel.map_text import blocked_lines, summary
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import SphericalArm

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


class SwivelPath(NamedTuple):
    """A joint trajectory on the map.

    Attributes:
        psi: Swivel angle, without jumps of a turn, shape (n,), in [rad].
        branch: Index into `SwivelMap.branches`, shape (n,).
    """

    psi: Array
    branch: Indices


class BranchBreak(NamedTuple):
    """Where a branch first has no posture.

    Attributes:
        branch: Index into `SwivelMap.branches`.
        sample: The first sample without an interval.
        joint: The joint that misses its range of motion.
        missing: By how much at the least, in [rad].
        shortfall: By how much the hand is out of reach, in [m]; then joint and range do not count.
    """

    branch: int
    sample: int
    joint: int
    missing: float
    shortfall: float


@dataclass(frozen=True, eq=False)
class SwivelMap:
    """For every sample and branch the swivel angles at which every joint is inside its range of motion.

    ψ_k ∈ ∪ [start, end] for each sample k and branch b; drawn over time this is a map, and a trajectory of
    the arm is a path through it from left to right.

    Attributes:
        arm: The arm.
        path: The hand path.
        spherical: The arm as spherical shoulder, hinge elbow and spherical wrist.
        reference: Where the elbow points at ψ = 0, carried along the path, shape (n, 3).
        intervals: The feasible intervals, with the curves of all postures.
        wrist: Angles of the joints after the elbow if they were given, shape (n, dof - 4), in [rad]; None if
            the path's rotation decides them.
        backend: "auto" (compiled C if possible), "c" or "vm", for everything that is asked of the map.

    Source:
        Shimizu et al. (2008), one sample; None (this package) for the map.
    """

    arm: Arm
    path: HandPath
    spherical: SphericalArm
    reference: Array
    intervals: FeasibleIntervals
    wrist: Array | None = None
    backend: Backend = "auto"

    def __len__(self) -> int:
        return len(self.path)

    @property
    def branches(self) -> Indices:
        """Signs of elbow, shoulder and wrist of every branch, shape (b, 3)."""
        return self.intervals.branches

    @cached_property
    def branch_names(self) -> tuple[str, ...]:
        """What the branches are called: the joint angles that tell them apart."""
        rest = np.zeros(0) if self.wrist is None else self.wrist[0]
        return tuple(branch_names(self.spherical, self.branches, rest))

    @cached_property
    def width(self) -> Array:
        """Angle that all intervals of a sample and branch cover together, shape (n, b), in [rad]."""
        total = np.zeros(self.intervals.empty.shape)
        np.add.at(
            total, (self.intervals.sample, self.intervals.branch), self.intervals.end - self.intervals.start
        )
        return total

    @cached_property
    def blocked(self) -> Indices:
        """Samples without any posture on any branch, shape (k,)."""
        return np.flatnonzero(self.intervals.empty.all(axis=1))

    @cached_property
    def single_branch(self) -> Indices:
        """Branches that have a posture at every sample, shape (k,).

        That is necessary for a trajectory on that branch, not enough: bands may be cut apart.
        """
        return np.flatnonzero(~self.intervals.empty.any(axis=0))

    @cached_property
    def breaks(self) -> tuple[BranchBreak, ...]:
        """For each branch that does not have a posture at every sample, where it first has none, and why."""
        found = []
        for branch in np.flatnonzero(self.intervals.empty.any(axis=0)):
            sample = int(np.argmax(self.intervals.empty[:, branch]))
            why = self.why_blocked([sample], int(branch))
            found.append(
                BranchBreak(
                    int(branch), sample, int(why.joint[0]), float(why.missing[0]), float(why.shortfall[0])
                )
            )
        return tuple(found)

    def why_blocked(self, samples: ArrayLike | None = None, branch: int | None = None) -> Blocking:
        """Which joint blocks samples, and how much of its range of motion is missing.

        Args:
            samples: Indices of samples; those without any interval if left out.
            branch: Only this branch; the best one if left out.

        Returns:
            One row per sample.

        Source:
            None (this package).
        """
        return blocking(self.intervals, samples, branch, self.backend)

    def explain_blocked(self) -> tuple[str, ...]:
        """Why samples have no posture: one line per run of samples with the same reason.

        Returns:
            Lines that name samples, times, the limit and how many degrees (or millimetres) are missing;
            empty if every sample has a posture.

        Source:
            None (reporting).
        """
        return tuple(blocked_lines(self))

    def clearance(self, psi: ArrayLike, branch: int, samples: ArrayLike | None = None) -> Clearance:
        """Smallest margin of all joints over samples and swivel angles.

        Args:
            psi: Swivel angles, shape (p,), in [rad].
            branch: Index into `branches`.
            samples: Indices of samples, shape (m,); all if left out.

        Returns:
            Margins in [rad], and the joints that have them, shape (m, p) each.

        Raises:
            OptionError: If there is no such branch.

        Source:
            Definition of the margin.
        """
        self._check_branch(branch)
        rows = np.arange(len(self)) if samples is None else samples
        return clearance(self.intervals, psi, branch, rows, self.backend)

    def interval_ends(self, rows: ArrayLike | None = None) -> IntervalEnds:
        """The joint limits that end intervals.

        Args:
            rows: Rows of `intervals`; all if left out.

        Returns:
            Joints and whether it is their upper limit, at start and end.

        Source:
            None (this package).
        """
        return interval_ends(self.intervals, rows, self.backend)

    def swivel_of(self, motion: Any) -> SwivelPath:
        """Where a joint trajectory runs on the map.

        Args:
            motion: Joint angles, shape (n, dof), in [rad]; or anything that has them as `q`, such as a
                `Solution`, or a `JointMotion`, whose joints are matched by name.

        Returns:
            Swivel angle, counted from the reference of the map, and branch of every sample. Where two
            branches touch (`swivel_of_postures(...).sines` is 0) the branch is either of them.

        Raises:
            ShapeError: If there is not one row per sample, or a joint of the arm is missing.

        Source:
            Definition of the swivel angle (this package).
        """
        q = self._angles(motion)
        at = swivel_of_postures(self.spherical, q, self.reference, self.wrist is not None, self.backend)
        signs = np.column_stack([at.elbow, at.shoulder, at.wrist])
        return SwivelPath(np.unwrap(at.psi), self.intervals.branch_of(signs))

    def postures(self, psi: ArrayLike, branch: ArrayLike, wish: ArrayLike | None = None) -> Array:
        """The joint angles of a path on the map.

        Args:
            psi: Swivel angles, shape (n,) or a number, in [rad].
            branch: Index into `branches`, shape (n,) or a number.
            wish: Postures that decide among angles 2π apart, and how parallel axes share an angle, shape
                (n, dof) or (dof,), in [rad]; the middle of the range of motion if left out.

        Returns:
            Joint angles, shape (n, dof), in [rad].

        Raises:
            ShapeError: If shapes do not fit, or there is no such branch.

        Source:
            Al-Faiz, eq. 13-47, corrected; Shimizu et al. (2008).
        """
        return postures_at(self.intervals.curves, np.arange(len(self)), branch, psi, wish, self.backend).q

    def contains(self, psi: ArrayLike, branch: ArrayLike) -> NDArray[np.bool_]:
        """Whether a path on the map stays inside its bands.

        Args:
            psi: Swivel angles, shape (n,) or a number, in [rad].
            branch: Index into `branches`, shape (n,) or a number.

        Returns:
            Shape (n,).

        Source:
            None (this package).
        """
        at = np.broadcast_to(np.asarray(psi, dtype=np.float64), (len(self),))
        side = np.broadcast_to(np.asarray(branch, dtype=np.int64), (len(self),))
        mine = self.intervals
        rows = np.flatnonzero(mine.branch == side[mine.sample])
        beyond = np.mod(at[mine.sample[rows]] - mine.start[rows], TURN)
        inside = np.zeros(len(self), dtype=np.bool_)
        inside[mine.sample[rows[beyond <= mine.end[rows] - mine.start[rows]]]] = True
        return inside

    def plot(
        self,
        solution: Any = None,
        compare: Mapping[str, Any] | None = None,
        *,
        branch: int | Sequence[int] | None = None,
        title: str | None = None,
        note: str | None = None,
    ) -> Figure:
        """Draw the map: time to the right, swivel angle up, feasible bands tinted by clearance.

        Args:
            solution: A `Solution`, or joint angles as for `swivel_of`, drawn as a strong line.
            compare: More of them by name, drawn as thin lines.
            branch: Branches to draw, a panel each; those the lines run on if left out, or the widest.
            title: What the motion is.
            note: Where the data come from; None takes the note of the path.

        Returns:
            A matplotlib figure; time in [s], angles in [deg].

        Raises:
            ShapeError: If joint angles do not fit.
            OptionError: If there is no such branch.

        Source:
            None (this package).
        """
        from armik_sym.report.swivel_map_figure import swivel_map_figure

        if branch is not None:
            for one in [branch] if isinstance(branch, int) else branch:
                self._check_branch(one)
        return swivel_map_figure(self, solution, compare, branch=branch, title=title, note=note)

    def __str__(self) -> str:
        return summary(self)

    def __repr__(self) -> str:
        return f"SwivelMap(arm {self.arm.name}, {len(self)} samples, {len(self.blocked)} blocked)"

    def _check_branch(self, branch: object) -> None:
        last = len(self.branches) - 1
        whole = isinstance(branch, numbers.Integral) and not isinstance(branch, bool)
        if not whole or not 0 <= int(branch) <= last:  # type: ignore[call-overload]
            names = "; ".join(f"{i}: {name}" for i, name in enumerate(self.branch_names))
            raise OptionError(f"branch is {branch!r}, expected 0 to {last} ({names})")

    def _angles(self, motion: Any) -> Array:
        q = np.asarray(getattr(motion, "q", motion), dtype=np.float64)
        names = getattr(motion, "joint_names", self.arm.joint_names)
        missing = [name for name in self.arm.joint_names if name not in names]
        if missing:
            raise ShapeError(
                f"the motion has no joint {missing[0]!r}: it needs all of arm {self.arm.name!r}: "
                f"{', '.join(self.arm.joint_names)}"
            )
        if q.shape != (len(self), len(names)):
            raise ShapeError(
                f"joint angles {q.shape}: expected ({len(self)}, {len(names)}), one row per sample of the "
                "path and one column per joint"
            )
        return q[:, [tuple(names).index(name) for name in self.arm.joint_names]]
