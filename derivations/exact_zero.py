"""Proving that a trigonometric expression is zero, over the rationals.

Sines and cosines of every angle become two polynomial variables S and C; the expression is zero as a
function exactly if its remainder modulo S² + C² - 1, one such relation per angle, is the zero polynomial
(the relations form a Gröbner basis, and cos, sin of independent angles satisfy no others). A square root
becomes one more variable W with the relation W² - (what it is the root of).
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import sympy as sp

_NO_ROOTS: Mapping[sp.Symbol, sp.Expr] = MappingProxyType({})


def is_exactly_zero(expression: sp.Expr, roots: Mapping[sp.Symbol, sp.Expr] = _NO_ROOTS) -> bool:
    """Whether an expression in sines, cosines and tangents vanishes identically.

    Args:
        expression: SymPy expression, rational in sines, cosines, tangents, symbols and roots.
        roots: For every symbol that stands for a square root, the expression it is the root of.

    Returns:
        True if it is proved to be zero. False if the remainder is not zero, which without roots is a
        proof that the expression is not (with roots, if no root is rational in the rest).

    Raises:
        ValueError: As `remainder`.

    Source:
        Cox, Little & O'Shea, Ideals, Varieties, and Algorithms (normal form modulo a Gröbner basis).
    """
    return remainder(expression, roots) == 0


def remainder(expression: sp.Expr, roots: Mapping[sp.Symbol, sp.Expr] = _NO_ROOTS) -> sp.Expr:
    """Normal form of the numerator modulo S² + C² = 1 for every angle and W² = … for every root.

    Args:
        expression: SymPy expression, rational in sines, cosines, tangents, symbols and roots.
        roots: For every symbol that stands for a square root, the expression it is the root of, polynomial
            in sines and cosines.

    Returns:
        The remainder; zero if and only if the expression is.

    Raises:
        ValueError: If an argument of a sine, cosine or tangent is no sum of symbols with rational
            factors and right angles, or if what a root is the root of has a denominator.

    Source:
        Cox, Little & O'Shea, Ideals, Varieties, and Algorithms.
    """
    expression, values = _without_fractions_of_angles(sp.sympify(expression), list(roots.values()))
    numerator, _ = sp.fraction(sp.together(_as_sines(expression)))
    values = [_as_sines(value) for value in values]
    everything = sp.Tuple(numerator, *values)
    angles = sorted({call.args[0] for call in everything.atoms(sp.sin, sp.cos)}, key=str)
    circle = {}
    relations = []
    for i, angle in enumerate(angles):
        if not angle.is_Symbol:
            raise ValueError(f"cannot treat the angle {angle}: expected a symbol")
        S, C = sp.symbols(f"S_{i} C_{i}")
        circle |= {sp.sin(angle): S, sp.cos(angle): C}
        relations.append((S, S**2 + C**2 - 1))
    for W, value in zip(roots, values, strict=True):
        if sp.fraction(sp.together(value))[1].free_symbols:
            raise ValueError(f"the root {W} is of an expression with a denominator: {value}")
        relations.insert(0, (W, W**2 - value.xreplace(circle)))
    return _reduced(numerator.xreplace(circle), relations)


def _reduced(numerator: sp.Expr, relations: list[tuple[sp.Symbol, sp.Expr]]) -> sp.Expr:
    result = sp.expand(numerator)
    for variable, relation in relations:
        result = sp.expand(sp.rem(result, sp.expand(relation), variable))
    return result


def _as_sines(expression: sp.Expr) -> sp.Expr:
    """Sums of angles first, as SymPy writes tan(x - π/4) as a cotangent and sin of it with √2."""
    expanded = sp.expand_trig(expression)
    expanded = expanded.replace(sp.tan, lambda x: sp.sin(x) / sp.cos(x))
    return sp.expand_trig(expanded.replace(sp.cot, lambda x: sp.cos(x) / sp.sin(x)))


def _without_fractions_of_angles(expression: sp.Expr, others: list[sp.Expr]) -> tuple[sp.Expr, list[sp.Expr]]:
    """Half and quarter angles as whole ones: x becomes n·x where x/n occurs."""
    shares: dict[sp.Symbol, int] = {}
    for call in sp.Tuple(expression, *others).atoms(sp.sin, sp.cos, sp.tan, sp.cot):
        for x in call.args[0].free_symbols:
            share = sp.expand(call.args[0]).coeff(x)
            if share.is_Rational:
                shares[x] = int(sp.ilcm(shares.get(x, 1), share.q))
    whole = {x: n * x for x, n in shares.items() if n > 1}
    return expression.subs(whole, simultaneous=True), [
        other.subs(whole, simultaneous=True) for other in others
    ]
