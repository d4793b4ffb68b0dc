"""The search of Al-Faiz in NumPy: what compiled/c/alfaiz_search.h does, decision by decision."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.kinematics import compile as compile_kinematics
from armik_sym.pointwise.alfaiz.found import Found
from armik_sym.pointwise.alfaiz.options import AlfaizOptions
from armik_sym.pointwise.alfaiz.pose_search import ROUNDING, PoseSearch

Array = NDArray[np.float64]

_FARTHEST = 1e6
_OUTSIDE = 10_000.0


class NumpyLoop:
    """Solves samples without compiled code.

    Args:
        arm: The arm.
        options: Options of the method.

    Source:
        Al-Faiz, eq. 4-57, corrected.
    """

    def __init__(self, arm: Arm, options: AlfaizOptions) -> None:
        self._arm = arm
        self._options = options
        self._kinematics = compile_kinematics(arm, "vm")

    def __call__(self, part: slice, targets: Array, starts: Array | None, chain: bool, found: Found) -> None:
        """Solve samples part.start … part.stop - 1.

        Args:
            part: The samples.
            targets: Targets of all samples, shape (n, 12).
            starts: One posture (7,) for a chain, else one per sample, shape (n, 7), in [rad]; None if no
                posture is known.
            chain: Whether each sample starts from the posture before.
            found: Where the answers go.

        Source:
            None (packaging).
        """
        rom = self._arm.rom
        before = starts
        for i in range(part.start, part.stop):
            if starts is not None and not chain:
                before = starts[i]
            q, margin, evaluations = rom.middle if before is None else before, -_OUTSIDE, 0
            if np.all(np.abs(targets[i]) <= _FARTHEST):
                known = before if self._options.prefer == "nearest" else None
                q, margin, evaluations = self._solve(targets[i], known)
            q = rom.clip(q)
            found.q[i], found.evaluations[i] = q, evaluations
            found.reached[i] = margin >= -ROUNDING and arrived(
                self._kinematics.position(q),
                self._kinematics.rotation(q),
                targets[i],
                self._options.tolerance,
            )
            if chain:
                before = found.q[i]

    def _solve(self, target: Array, previous: Array | None) -> tuple[Array, float, int]:
        """The best posture of both sides of the elbow, its margin and how many were looked at."""
        q, margin, cost, evaluations = np.zeros(7), -_OUTSIDE, 0.0, 0
        for follow in (True, False) if previous is not None else (False,):
            for side in (1.0, -1.0):
                search = PoseSearch(self._arm, target, side, previous)
                bent_inside = search.elbow_margin >= -ROUNDING
                if follow:
                    best = search.follow_from_before(self._options.near) if bent_inside else None
                elif not bent_inside and margin > -_OUTSIDE and search.elbow_margin < margin:
                    best = None
                else:
                    best = search.everywhere(self._options.grid, self._options.refinements)
                evaluations += search.evaluations
                if best is None:
                    continue
                least = min(best.margin, search.elbow_margin)
                if least < -ROUNDING:
                    new_cost = _OUTSIDE - least
                else:
                    new_cost = -least if previous is None else best.cost
                if margin == -_OUTSIDE or new_cost < cost:
                    q, margin, cost = best.q, least, new_cost
            if margin > -_OUTSIDE:
                break
        return q, margin, evaluations


def arrived(position: Array, rotation: Array, target: Array, tolerance: float) -> bool:
    """Whether the hand is where it should be; |R - R*| (Frobenius) = 2·√2·sin(angle/2).

    Args:
        position: Position of the hand, shape (3,), in [m].
        rotation: Its rotation, shape (3, 3).
        target: Position and rotation row by row, shape (12,).
        tolerance: For the position, in [m], and the rotation, in [rad].

    Returns:
        True if both are within the tolerance.

    Source:
        None (geometry).
    """
    shift = float(np.linalg.norm(position - target[:3]))
    turn = float(np.linalg.norm(rotation.ravel() - target[3:])) / np.sqrt(8)
    return bool(shift <= tolerance and 2 * np.arcsin(min(1.0, turn)) <= tolerance)
