"""The closed form of Al-Faiz in NumPy: CasADi Functions on arrays, many at once."""

from __future__ import annotations

import functools

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError
from armik_sym.symbolic.alfaiz_closed_form import closed_form_fits, posture_function, search_functions
from armik_sym.symbolic.alfaiz_printed import printed_function
from armik_sym.symbolic.dense_function import evaluate_rows

Array = NDArray[np.float64]


def postures_at(
    arm: Arm,
    position: ArrayLike,
    rotation: ArrayLike,
    phi: ArrayLike,
    sides: tuple[int, int, int] = (1, 1, 1),
) -> tuple[Array, NDArray[np.bool_]]:
    """All joint angles for given poses, φ and branches, by eq. (4)-(47) corrected.

    Args:
        arm: An arm with the rows of `catalog.alfaiz`.
        position: Positions of the hand, shape (n, 3), in [m].
        rotation: Rotations of the hand, shape (n, 3, 3).
        phi: φ of every pose, shape (n,), in [rad].
        sides: Signs ±1 of θ4, cos θ3 and cos θ6.

    Returns:
        Joint angles, shape (n, 7), in [rad], and whether they reach the pose, shape (n,): False if the
        target is out of reach or has no posture with this φ.

    Raises:
        OptionError: If the closed form does not hold for the arm.

    Source:
        Al-Faiz, eq. 4-47, corrected.
    """
    if not closed_form_fits(arm):
        raise OptionError(f"arm {arm.name!r} has other rows than catalog.alfaiz: the closed form needs those")
    p = np.asarray(position, dtype=np.float64).reshape(-1, 3)
    pose = np.hstack([p, np.asarray(rotation, dtype=np.float64).reshape(len(p), 9)])
    values = evaluate("alfaiz_posture", pose, arm.length_values, np.reshape(phi, (-1, 1)), sides)
    return values[:, :7], (values[:, 7] >= -1e-12) & (values[:, 8] <= 1e-9)


def evaluate(name: str, *inputs: ArrayLike) -> Array:
    """One of the Functions of the closed form.

    Args:
        name: Name of the function.
        inputs: Each of shape (n, size), or (size,) for all alike.

    Returns:
        Shape (n, size of the output).

    Source:
        None (packaging).
    """
    return evaluate_rows(_functions()[name], *inputs)


@functools.cache
def _functions() -> dict[str, ca.Function]:
    single = (posture_function(), printed_function())
    return search_functions() | {function.name(): function for function in single}
