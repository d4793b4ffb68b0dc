"""The method as printed: minimise the error (57) of the printed posture over φ."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.kinematics import compile as compile_kinematics
from armik_sym.pointwise.alfaiz.closed_form import evaluate
from armik_sym.pointwise.alfaiz.found import Found
from armik_sym.pointwise.alfaiz.numpy_loop import arrived
from armik_sym.pointwise.alfaiz.options import AlfaizOptions

Array = NDArray[np.float64]

_TURN = 2 * np.pi
_ZOOM = 16


class PrintedLoop:
    """Solves samples by the printed equations, every sample by itself.

    The error is sqrt(|p* - p|² + a²), p in metres; `a` of eq. (57) is not explained in the paper and is taken
    as the angle between the rotations, in radians. φ comes from a grid, then from closer ones around the
    best. Angles are put into the range of motion at the end: the paper knows none.

    Args:
        arm: The arm.
        options: Options of the method.

    Source:
        Al-Faiz, eq. 6, 20-22, 35, 40, 44, 47 and 57.
    """

    def __init__(self, arm: Arm, options: AlfaizOptions) -> None:
        self._arm = arm
        self._options = options
        self._kinematics = compile_kinematics(arm)

    def __call__(self, part: slice, targets: Array, starts: Array | None, chain: bool, found: Found) -> None:
        """Solve samples part.start … part.stop - 1.

        Args:
            part: The samples.
            targets: Targets of all samples, shape (n, 12).
            starts: Not used, but for samples without any posture.
            chain: Whether samples are those of a path.
            found: Where the answers go.

        Source:
            None (packaging).
        """
        rom = self._arm.rom
        for i in range(part.start, part.stop):
            with np.errstate(all="ignore"):  # targets may be infinite, or overflow
                q, _, found.evaluations[i] = self.best(targets[i])
            if not np.isfinite(q).all():
                if i > part.start and chain:
                    q = found.q[i - 1]
                else:
                    q = rom.middle if starts is None else starts if chain else starts[i]
            q = rom.clip(q + _TURN * np.round((rom.middle - q) / _TURN))
            found.q[i] = q
            position, rotation = self._kinematics.position(q), self._kinematics.rotation(q)
            with np.errstate(all="ignore"):
                found.reached[i] = arrived(position, rotation, targets[i], self._options.tolerance)

    def best(self, target: Array) -> tuple[Array, float, int]:
        """The φ with the least error.

        Args:
            target: Position and rotation row by row, shape (12,).

        Returns:
            Joint angles of the printed equations, shape (7,), in [rad], NaN if they have no value for any φ;
            the error; and how many φ were tried.

        Source:
            Al-Faiz, eq. 57.
        """
        spacing = _TURN / self._options.grid
        phi = np.arange(self._options.grid) * spacing - np.pi
        tried, middle, best, least = 0, 0.0, np.full(7, np.nan), np.inf
        for _ in range(self._options.refinements + 1):
            q = evaluate("alfaiz_printed", target, self._arm.length_values, phi[:, None])
            tried += len(phi)
            errors = self._errors(q, target)
            k = int(np.argmin(errors))
            if errors[k] < least:
                middle, best, least = phi[k], q[k], float(errors[k])
            spacing /= _ZOOM // 2
            phi = middle + spacing * (np.arange(_ZOOM) - 0.5 * (_ZOOM - 1))
        return best, least, tried

    def _errors(self, q: Array, target: Array) -> Array:
        """Error (57) of postures; infinite where the equations have no value."""
        good = np.isfinite(q).all(axis=1)
        errors = np.full(len(q), np.inf)
        if good.any():
            position, rotation = self._kinematics.position(q[good]), self._kinematics.rotation(q[good])
            shift = np.linalg.norm(position - target[:3], axis=1)
            turn = np.linalg.norm(rotation.reshape(-1, 9) - target[3:], axis=1) / np.sqrt(8)
            errors[good] = np.hypot(shift, 2 * np.arcsin(np.minimum(turn, 1.0)))
        return errors
