"""Proving that a trigonometric expression is zero, over the rationals.

Sines and cosines of every angle become two polynomial variables S and C; the expression is zero as a
function exactly if its remainder modulo S² + C² - 1, one such relation per angle, is the zero polynomial
(the relations form a Gröbner basis, and cos, sin of independent angles satisfy no others).
"""

from __future__ import annotations

import sympy as sp


def is_exactly_zero(expression: sp.Expr) -> bool:
    """Whether an expression in sines and cosines vanishes identically.

    Args:
        expression: SymPy expression, rational in sines, cosines and symbols.

    Returns:
        True if it is proved to be zero, False if it is proved not to be.

    Source:
        Cox, Little & O'Shea, Ideals, Varieties, and Algorithms (normal form modulo a Gröbner basis).
    """
    return remainder(expression) == 0


def remainder(expression: sp.Expr) -> sp.Expr:
    """Normal form of the numerator modulo S² + C² = 1 for every angle.

    Args:
        expression: SymPy expression, rational in sines, cosines and symbols.

    Returns:
        The remainder; zero if and only if the expression is.

    Raises:
        ValueError: If a sine or cosine has an argument that is no sum of symbols and right angles.

    Source:
        Cox, Little & O'Shea, Ideals, Varieties, and Algorithms.
    """
    expanded = sp.expand_trig(sp.sympify(expression))
    numerator, _ = sp.fraction(sp.together(expanded))
    angles = sorted({call.args[0] for call in numerator.atoms(sp.sin, sp.cos)}, key=str)
    result = numerator
    relations = []
    for i, angle in enumerate(angles):
        if not angle.is_Symbol:
            raise ValueError(f"cannot treat the angle {angle}: expected a symbol")
        S, C = sp.symbols(f"S_{i} C_{i}")
        result = result.subs({sp.sin(angle): S, sp.cos(angle): C})
        relations.append((S, S**2 + C**2 - 1))
    result = sp.expand(result)
    for S, relation in relations:
        result = sp.expand(sp.rem(result, relation, S))
    return result
