"""Which branch and swivel angle a posture belongs to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.errors import ShapeError
from armik_sym.swivel.closed_form import checked_reference
from armik_sym.swivel.evaluate import evaluate
from armik_sym.swivel.geometry import pose_geometry, position_geometry
from armik_sym.swivel.spherical_arm import SphericalArm

Array = NDArray[np.float64]
Signs = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SwivelAndBranch:
    """Where postures are on their curves.

    Attributes:
        psi: Swivel angle, shape (n,), in [rad].
        elbow: Side of the elbow, ±1, shape (n,).
        shoulder: Branch of the shoulder, ±1, shape (n,).
        wrist: Branch of the wrist, ±1, shape (n,); 1 without one.
        sines: Sines whose signs the branches are, shape (n, 3): elbow, shoulder, wrist. Where one is 0, two
            branches touch.
        reference_sine: As in `SwivelCurve`, shape (n,).
    """

    psi: Array
    elbow: Signs
    shoulder: Signs
    wrist: Signs
    sines: Array
    reference_sine: Array


def swivel_of_postures(
    spherical: SphericalArm,
    q: ArrayLike,
    reference: ArrayLike | None = None,
    position_only: bool = False,
    backend: Backend = "auto",
) -> SwivelAndBranch:
    """Swivel angle and branches of postures.

    Args:
        spherical: The arm.
        q: Postures, shape (n, dof), in [rad].
        reference: As in `pose_curve`.
        position_only: Whether the elbow turns about the line to the hand, as in `position_curve`, instead of
            the line to the wrist.
        backend: "auto", "c" or "vm".

    Returns:
        Swivel angles and branches.

    Raises:
        ShapeError: If `q` does not have shape (n, dof).
        OptionError: If the arm has no spherical wrist and not only positions are asked for.

    Source:
        Definition of the swivel angle (this package).
    """
    angles = np.asarray(q, dtype=np.float64)
    if angles.ndim != 2 or angles.shape[1] != spherical.arm.dof:
        raise ShapeError(f"q {angles.shape}: expected (n, {spherical.arm.dof})")
    n = len(angles)
    geometry = position_geometry(spherical, angles[:, 4:]) if position_only else pose_geometry(spherical)
    r = checked_reference(spherical, reference, n)
    values = evaluate("swivel_of", angles[:, :4], spherical.shoulder.offset, geometry, r, backend=backend)
    wrist = np.ones(n)
    if not position_only and spherical.wrist is not None:
        wrist = np.sin(angles[:, 5] + spherical.wrist.offset)
    sines = np.column_stack([values[:, 1], values[:, 2], wrist])
    signs = np.where(sines < 0, -1, 1)
    return SwivelAndBranch(values[:, 0], signs[:, 0], signs[:, 1], signs[:, 2], sines, values[:, 3])
