"""Test vectors of an emitted library, computed without the expressions its C comes from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.c_constant import Precision
from armik_sym.compiled.emit_functions import EmittedLibrary, limits_in
from armik_sym.compiled.emit_header import common_values
from armik_sym.compiled.emit_text import fill_template, number_rows

Array = NDArray[np.float64]

_COUNT = 50
_SEED = 20210
_STEP = 0.02
_WEIGHTS = (4 / 5, -1 / 5, 4 / 105, -1 / 280)
_TOLERANCE: dict[Precision, float] = {"double": 1e-12, "float": 5e-6}


def vectors_text(library: EmittedLibrary) -> str:
    """The file `test_vectors.h`: postures and expected position, rotation and Jacobian.

    Args:
        library: The library to emit.

    Returns:
        C source text.

    Source:
        None (test data).
    """
    arm, precision = library.arm, library.precision
    if precision == "float" and library.takes_lengths:
        arm = arm.with_lengths(**{key: float(np.float32(value)) for key, value in arm.lengths.items()})
    q = sample_postures(arm, precision)
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    jacobian = jacobian_by_differences(arm, q)
    arrays = [_array("armik_real test_q", q, precision)]
    if library.takes_lengths:
        numbers = number_rows(arm.length_values[None, :], precision)
        arrays.append(f"static const armik_real test_lengths[{len(arm.lengths)}] =\n{numbers};\n")
    arrays += [
        _array("double test_position", position, "double"),
        _array("double test_rotation", rotation.reshape(len(q), 9), "double"),
        _array("double test_jacobian", jacobian.reshape(len(q), -1), "double"),
    ]
    tolerance = _TOLERANCE[precision] * max(1.0, arm.reach)
    return fill_template(
        "test_vectors.h",
        common_values(library)
        | {"COUNT": str(len(q)), "TOLERANCE": f"{tolerance:.3g}", "ARRAYS": "\n".join(arrays)},
    )


def sample_postures(arm: Arm, precision: Precision) -> Array:
    """Postures inside the range of motion, each exactly representable in the precision of the C code.

    Args:
        arm: The arm.
        precision: "double" or "float".

    Returns:
        Joint angles, shape (50 or more, dof), in [rad] (prismatic: [m]): lower limits, upper limits,
        middle, each joint at its two limits with the others in the middle, then random ones.

    Source:
        None (test data).
    """
    lower, upper = limits_in(arm, precision)
    middle = 0.5 * (lower + upper)
    one_by_one = np.tile(middle, (2 * arm.dof, 1))
    for i in range(arm.dof):
        one_by_one[2 * i, i], one_by_one[2 * i + 1, i] = lower[i], upper[i]
    random = np.random.default_rng(_SEED).uniform(lower, upper, (_COUNT, arm.dof))
    q = np.vstack([lower, upper, middle, one_by_one, random])[: max(_COUNT, 3 + 2 * arm.dof)]
    if precision == "float":
        q = q.astype(np.float32).astype(np.float64)
    return np.clip(q, lower, upper)


def jacobian_by_differences(arm: Arm, q: Array) -> Array:
    """Geometric Jacobian by eighth-order central differences of the pose: [v; ω] = J q̇.

    f'(x) ≈ Σ w_k (f(x + k h) - f(x - k h)) / h with w = 4/5, -1/5, 4/105, -1/280; [ω]× = Ṙ Rᵀ.
    With h = 0.02 both the truncation and the rounding error are near 1e-14.

    Args:
        arm: The arm.
        q: Joint angles, shape (n, dof), in [rad] (prismatic: [m]).

    Returns:
        Shape (n, 6, dof); linear rows in [m/rad], angular rows in [1].

    Source:
        Fornberg (1988), Mathematics of Computation 51, table 1.
    """
    _, R = hand_pose(arm.chain, q, arm.lengths)
    jacobian = np.empty((len(q), 6, arm.dof))
    for i in range(arm.dof):
        dp, dR = np.zeros((len(q), 3)), np.zeros((len(q), 3, 3))
        for k, weight in enumerate(_WEIGHTS, 1):
            shift = np.zeros(arm.dof)
            shift[i] = k * _STEP
            ahead = hand_pose(arm.chain, q + shift, arm.lengths)
            behind = hand_pose(arm.chain, q - shift, arm.lengths)
            dp += weight / _STEP * (ahead[0] - behind[0])
            dR += weight / _STEP * (ahead[1] - behind[1])
        spin = dR @ R.transpose(0, 2, 1)
        jacobian[:, :3, i] = dp
        jacobian[:, 3:, i] = 0.5 * np.stack(
            [spin[:, 2, 1] - spin[:, 1, 2], spin[:, 0, 2] - spin[:, 2, 0], spin[:, 1, 0] - spin[:, 0, 1]], -1
        )
    return jacobian


def _array(declarator: str, rows: Array, precision: Precision) -> str:
    n, k = rows.shape
    return f"static const {declarator}[{n}][{k}] = {{\n{number_rows(rows, precision)}\n}};\n"
