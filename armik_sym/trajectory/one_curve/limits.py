"""What a trajectory has to keep besides its intervals: speed, acceleration, the range of joints that turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.solution.motion_rates import joint_acceleration, joint_speed
from armik_sym.trajectory.rates import MARGIN, acceleration_matrix, drawn_in, speed_matrix

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Rounding of a joint angle, in [rad]: what is outside by less is put back inside in the end.
_ROUNDED = 1e-12
# Once a limit is exceeded somewhere, it is watched wherever more than this share of it is used.
_WATCHED = 0.8


@dataclass(frozen=True, eq=False)
class Limits:
    """Limits on a whole trajectory.

    Attributes:
        max_speed: Shape (dof,), in [rad/s].
        max_acceleration: Shape (dof,), in [rad/s²].
        rom: Range of motion.
        wide: Joints whose range is a full turn or more: the intervals do not keep them in, shape (dof,).
    """

    max_speed: Array
    max_acceleration: Array
    rom: RangeOfMotion
    wide: Mask

    def broken(self, time: Array, q: Array) -> tuple[str, ...]:
        """Which kinds of limits a trajectory exceeds.

        Args:
            time: Time stamps, shape (n,), in [s].
            q: Joint angles, shape (n, dof), in [rad].

        Returns:
            Of "speed", "acceleration", "range".

        Source:
            None (definition).
        """
        return tuple(kind for kind, use in self._use(time, q).items() if (use > 1.0).any())

    def to_watch(self, time: Array, q: Array, watched: Mapping[str, Mask]) -> dict[str, Mask]:
        """Where limits are to be constraints: where they are exceeded or nearly used up, and where they were.

        Args:
            time: Time stamps, shape (n,), in [s].
            q: Joint angles, shape (n, dof), in [rad].
            watched: Where they have been so far.

        Returns:
            For every kind that is exceeded or was watched, a mask over its rows.

        Source:
            None (lazy constraints).
        """
        found: dict[str, Mask] = {}
        for kind, use in self._use(time, q).items():
            if (use > 1.0).any() or kind in watched:
                near: Mask = np.asarray((use > _WATCHED).any(axis=1))
                found[kind] = np.logical_or(near, watched[kind]) if kind in watched else near
        return found

    def rows(self, time: Array, watched: Mapping[str, Mask]) -> tuple[sp.csr_array, Array, Array]:
        """Rows for one joint and their bounds for all joints.

        Args:
            time: Time stamps, shape (n,), in [s].
            watched: Where limits are constraints, as of `to_watch`.

        Returns:
            Matrix (m, n), lower and upper bounds, shape (m·dof,).

        Source:
            None (direct transcription).
        """
        n = len(time)
        matrices, lower, upper = [sp.csr_array((0, n))], [np.zeros(0)], [np.zeros(0)]
        for kind, mask in watched.items():
            matrix, low, high = self._kind(kind, time)
            chosen = np.flatnonzero(mask)
            matrices.append(matrix[chosen])
            lower.append(np.tile(low, len(chosen)))
            upper.append(np.tile(high, len(chosen)))
        return sp.csr_array(sp.vstack(matrices)), np.concatenate(lower), np.concatenate(upper)

    def _kind(self, kind: str, time: Array) -> tuple[sp.csr_array, Array, Array]:
        if kind == "range":
            low = np.where(self.wide, self.rom.lower + MARGIN, -np.inf)
            high = np.where(self.wide, self.rom.upper - MARGIN, np.inf)
            return sp.csr_array(sp.eye_array(len(time))), low, high
        limit = self.max_speed if kind == "speed" else self.max_acceleration
        inside = drawn_in(limit)
        matrix = speed_matrix(time) if kind == "speed" else acceleration_matrix(time)
        return matrix, -inside, inside

    def _use(self, time: Array, q: Array) -> dict[str, Array]:
        """Which share of every limit is used, one row per constraint row; above 1 it is exceeded."""
        use = {"speed": np.abs(joint_speed(time, q)) / self.max_speed}
        if np.isfinite(self.max_acceleration).any():
            use["acceleration"] = np.abs(joint_acceleration(time, q)) / self.max_acceleration
        if self.wide.any():
            away = (np.abs(q - self.rom.middle) - _ROUNDED) / np.maximum(0.5 * self.rom.width, 1e-300)
            use["range"] = np.where(self.wide, away, 0.0)
        return use
