"""Evaluating both sides of a claim in numbers, through CasADi."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import casadi as ca
import numpy as np
import sympy as sp

_POINTS = 1_000
_DIFFERENT = 1e-6
_NO_ROOTS: Mapping[sp.Symbol, sp.Expr] = MappingProxyType({})

_FUNCTIONS = {
    "sin": ca.sin,
    "cos": ca.cos,
    "tan": ca.tan,
    "cot": lambda x: 1 / ca.tan(x),
    "asin": ca.asin,
    "acos": ca.acos,
    "atan": ca.atan,
    "atan2": ca.atan2,
    "sqrt": ca.sqrt,
    "exp": ca.exp,
    "log": ca.log,
    "Abs": ca.fabs,
    "sign": ca.sign,
    "Min": ca.fmin,
    "Max": ca.fmax,
}


@dataclass(frozen=True)
class Counterexample:
    """Numbers anyone can put into the printed formula.

    Attributes:
        point: Value of every symbol, angles in [rad].
        entry: Row and column of the entry that differs, None for a scalar.
        printed: What the printed formula gives.
        true: What is true.
    """

    point: dict[str, float]
    entry: tuple[int, int] | None
    printed: float
    true: float

    def __str__(self) -> str:
        values = ", ".join(f"{name} = {value:g}" for name, value in self.point.items())
        place = "" if self.entry is None else f" (entry {self.entry[0] + 1}, {self.entry[1] + 1})"
        return f"at {values}: printed {self.printed:.6g}, true {self.true:.6g}{place}"


def largest_difference(
    left: sp.Matrix,
    right: sp.Matrix,
    roots: Mapping[sp.Symbol, sp.Expr] = _NO_ROOTS,
    *,
    relative: bool = False,
) -> float:
    """Largest difference of two matrices at random points, |a - b|.

    Args:
        left: SymPy matrix.
        right: SymPy matrix of the same shape.
        roots: For every symbol that stands for a square root, the expression it is the root of.
        relative: Divide by 1 + |a|.

    Returns:
        The largest difference, NaN if an entry is not a number.

    Source:
        None (random testing).
    """
    symbols, function = _compiled(left, right, roots)
    points = np.random.default_rng(0).uniform(-np.pi, np.pi, (_POINTS, len(symbols)))
    a, b = (np.asarray(side) for side in (function(points.T) if symbols else function(0)))
    return float((np.abs(a - b) / (1 + relative * np.abs(a))).max())


def first_difference(
    printed: sp.Matrix, true: sp.Matrix, roots: Mapping[sp.Symbol, sp.Expr] = _NO_ROOTS
) -> Counterexample | None:
    """The first point of a round grid of numbers at which two matrices differ.

    Args:
        printed: SymPy matrix.
        true: SymPy matrix of the same shape.
        roots: For every symbol that stands for a square root, the expression it is the root of.

    Returns:
        The counterexample, or None if they agree at all points.

    Source:
        None (random testing).
    """
    symbols, function = _compiled(printed, true, roots)
    rng = np.random.default_rng(1)
    for _ in range(_POINTS):
        point = np.round(rng.uniform(0.1, 1.5, len(symbols)), 1)
        a, b = (np.asarray(value).reshape(printed.shape, order="F") for value in function(point))
        if not np.abs(a - b).max() <= _DIFFERENT:
            i, j = np.unravel_index(int(np.argmax(np.abs(a - b))), a.shape)
            named = {str(symbol): float(value) for symbol, value in zip(symbols, point, strict=True)}
            place = None if len(printed) == 1 else (int(i), int(j))
            return Counterexample(named, place, float(a[i, j]), float(b[i, j]))
    return None


def evaluate(expression: sp.Expr, symbols: list[sp.Symbol], points: np.ndarray) -> np.ndarray:
    """A scalar expression at many points, through CasADi.

    Args:
        expression: SymPy expression; of a `Piecewise` the first piece counts, the one for everything but
            exceptional points.
        symbols: Its symbols, in the order of the columns.
        points: Values, shape (n, number of symbols).

    Returns:
        Values, shape (n,).

    Source:
        None (numerical evaluation).
    """
    generic = expression.replace(sp.Piecewise, lambda *pieces: pieces[0][0])
    x = ca.SX.sym("x", len(symbols))
    value = ca.SX(sp.lambdify(symbols, generic, [_FUNCTIONS])(*ca.vertsplit(x)))
    return np.asarray(ca.Function("value", [x], [value])(np.asarray(points, dtype=float).T)).ravel()


def _compiled(
    left: sp.Matrix, right: sp.Matrix, roots: Mapping[sp.Symbol, sp.Expr]
) -> tuple[list[sp.Symbol], ca.Function]:
    as_roots = {W: sp.sqrt(value) for W, value in roots.items()}
    left, right = left.subs(as_roots), right.subs(as_roots)
    symbols = sorted(left.free_symbols | right.free_symbols, key=str)
    x = ca.SX.sym("x", max(len(symbols), 1))
    columns = []
    for matrix in (left, right):
        entries = [sp.lambdify(symbols, matrix[i], [_FUNCTIONS]) for i in _column_major(matrix)]
        values = ca.vertsplit(x)[: len(symbols)]
        columns.append(ca.vertcat(*[ca.SX(entry(*values)) for entry in entries]))
    return symbols, ca.Function("sides", [x], columns)


def _column_major(matrix: sp.Matrix) -> list[int]:
    return [row * matrix.cols + column for column in range(matrix.cols) for row in range(matrix.rows)]
