"""Evaluating both sides of a claim in numbers, through CasADi."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
import sympy as sp

_POINTS = 1_000
_DIFFERENT = 1e-6


@dataclass(frozen=True)
class Counterexample:
    """Numbers anyone can put into the printed formula.

    Attributes:
        point: Value of every symbol, angles in [rad].
        entry: Row and column of the entry that differs.
        printed: What the printed formula gives.
        true: What is true.
    """

    point: dict[str, float]
    entry: tuple[int, int]
    printed: float
    true: float

    def __str__(self) -> str:
        values = ", ".join(f"{name} = {value:g}" for name, value in self.point.items())
        place = "" if self.entry == (0, 0) else f" (entry {self.entry[0] + 1}, {self.entry[1] + 1})"
        return f"at {values}: printed {self.printed:.6g}, true {self.true:.6g}{place}"


def largest_difference(left: sp.Matrix, right: sp.Matrix) -> float:
    """Largest difference of two matrices at random points.

    Args:
        left: SymPy matrix.
        right: SymPy matrix of the same shape.

    Returns:
        The difference.

    Source:
        None (random testing).
    """
    symbols, function = _compiled(left, right)
    points = np.random.default_rng(0).uniform(-np.pi, np.pi, (_POINTS, len(symbols)))
    a, b = function(points.T) if symbols else function()
    return float(np.abs(np.asarray(a) - np.asarray(b)).max())


def first_difference(printed: sp.Matrix, true: sp.Matrix) -> Counterexample | None:
    """The first point of a round grid of numbers at which two matrices differ.

    Args:
        printed: SymPy matrix.
        true: SymPy matrix of the same shape.

    Returns:
        The counterexample, or None if they agree at all points.

    Source:
        None (random testing).
    """
    symbols, function = _compiled(printed, true)
    rng = np.random.default_rng(1)
    for _ in range(_POINTS):
        point = np.round(rng.uniform(0.1, 1.5, len(symbols)), 1)
        a, b = (np.asarray(value).reshape(printed.shape, order="F") for value in function(point))
        if np.abs(a - b).max() > _DIFFERENT:
            i, j = np.unravel_index(int(np.argmax(np.abs(a - b))), a.shape)
            named = {str(symbol): float(value) for symbol, value in zip(symbols, point, strict=True)}
            return Counterexample(named, (int(i), int(j)), float(a[i, j]), float(b[i, j]))
    return None


def _compiled(left: sp.Matrix, right: sp.Matrix) -> tuple[list[sp.Symbol], ca.Function]:
    symbols = sorted(left.free_symbols | right.free_symbols, key=str)
    x = ca.SX.sym("x", len(symbols))
    translate = {
        "sin": ca.sin,
        "cos": ca.cos,
        "tan": ca.tan,
        "sqrt": ca.sqrt,
        "atan": ca.atan,
        "Abs": ca.fabs,
    }
    columns = []
    for matrix in (left, right):
        entries = [sp.lambdify(symbols, matrix[i], [translate]) for i in _column_major(matrix)]
        columns.append(ca.vertcat(*[ca.SX(entry(*ca.vertsplit(x))) for entry in entries]))
    return symbols, ca.Function("sides", [x], columns)


def _column_major(matrix: sp.Matrix) -> list[int]:
    return [row * matrix.cols + column for column in range(matrix.cols) for row in range(matrix.rows)]
