"""Whether the three wrist angles, taken together, turn the hand the way they should."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import sympy as sp
from sympy import pi

from derivations.alfaiz.chain import Q
from derivations.alfaiz.wrist_rotation import wrist
from derivations.exact_zero import is_exactly_zero
from derivations.random_points import evaluate

_q5, _q6, _q7 = Q[4:]
_ORIENTATIONS = 4_000
_SAME = 1e-6
_SAMPLING = 0.03


def is_second_solution(q5: sp.Expr, q6: sp.Expr, q7: sp.Expr) -> bool:
    """Whether the wrist turns the hand the same way with other angles.

    Args:
        q5: What is put for q5.
        q6: What is put for q6.
        q7: What is put for q7.

    Returns:
        True if the rotation of the wrist is exactly the same for all angles.

    Source:
        Al-Faiz, eq. 38.
    """
    R = sp.Matrix(wrist()[:3, :3])
    other = R.subs({_q5: q5, _q6: q6, _q7: q7}, simultaneous=True)
    return all(is_exactly_zero(a - b) for a, b in zip(R, other, strict=True))


def half_turns_never_cancel() -> bool:
    """Whether a half turn too many in θ5, in θ7 or in both always changes the rotation.

    Returns:
        True if none of the three leaves it as it is, and the second solution of the wrist does.

    Source:
        Al-Faiz, eq. 38.
    """
    wrong = [(pi, 0), (0, pi), (pi, pi)]
    return not any(is_second_solution(_q5 + a, _q6, _q7 + b) for a, b in wrong) and is_second_solution(
        _q5 + pi, pi - _q6, _q7 + pi
    )


def reproduced(formulas: Mapping[sp.Symbol, sp.Expr]) -> tuple[np.ndarray, np.ndarray]:
    """Which orientations the angles found by given formulas return.

    Args:
        formulas: For q5, q6 and q7 the formula in the true angles.

    Returns:
        True angles of random orientations (uniform over all rotations, |q6| < 90°), shape (n, 3), and whether
        the found angles reproduce them, shape (n,).

    Source:
        Al-Faiz, eq. 38; in Euler angles all rotations are equally dense with respect to dq5 d(sin q6) dq7.
    """
    rng = np.random.default_rng(0)
    q5, sine, q7 = rng.uniform([-np.pi, -1, -np.pi], [np.pi, 1, np.pi], (_ORIENTATIONS, 3)).T
    true = np.column_stack([q5, np.arcsin(sine), q7])
    symbols = [_q5, _q6, _q7]
    found = np.column_stack([evaluate(formulas[angle], symbols, true) for angle in symbols])
    off = [evaluate(r, symbols, found) - evaluate(r, symbols, true) for r in wrist()[:3, :3]]
    return true, np.abs(off).max(axis=0) < _SAME


def a_quarter_is_reproduced(formulas: Mapping[sp.Symbol, sp.Expr]) -> bool:
    """Whether given formulas return an orientation if, and only if, |q5| and |q7| are below 90°.

    Args:
        formulas: For q5, q6 and q7 the formula in the true angles.

    Returns:
        True if that is so for all random orientations, and they are a quarter.

    Source:
        Al-Faiz, eq. 40, 44 and 47.
    """
    true, right = reproduced(formulas)
    inside = (np.abs(true[:, [0, 2]]) < np.pi / 2).all(axis=1)
    return bool((right == inside).all()) and abs(right.mean() - 0.25) < _SAMPLING


def singular_at_right_angle(fixed: sp.Matrix) -> bool:
    """Whether θ5 and θ7 become one angle at θ6 = ±90°.

    Args:
        fixed: The entries θ5 and θ7 are found from, column or row.

    Returns:
        True if they all vanish there, and the rotation is unchanged when q5 and q7 turn by the same angle in
        opposite directions (+90°) or in the same (-90°).

    Source:
        Al-Faiz, eq. 38.
    """
    t = sp.Symbol("t", real=True)
    R = sp.Matrix(wrist()[:3, :3])
    for angle, direction in ((pi / 2, -1), (-pi / 2, 1)):
        if any(entry.subs(_q6, angle) != 0 for entry in fixed):
            return False
        at = R.subs(_q6, angle)
        turned = at.subs({_q5: _q5 + t, _q7: _q7 + direction * t}, simultaneous=True)
        if not all(is_exactly_zero(a - b) for a, b in zip(turned, at, strict=True)):
            return False
    return True
