"""How many solutions the inverse problem can have at most: counted with Gröbner bases, exactly.

Sines and cosines of the unknown angles are six unknowns with six or more polynomial equations. The number of
monomials no leading monomial divides is the number of complex solutions, counted with multiplicity.
"""

from __future__ import annotations

import functools
import itertools

import sympy as sp
from sympy import cos, sin

from derivations.alfaiz.chain import L3, L4, Q, frame

_S, _C = sp.symbols("s1:8"), sp.symbols("c1:8")
_HALF_TANGENTS = (("1/3", "2/5", "-3/7"), ("-5/4", "3/2", "1/6"), ("4", "-2/9", "7/3"))


def _algebraic(expression: sp.Matrix) -> sp.Matrix:
    angles = {sin(q): s for q, s in zip(Q, _S, strict=True)}
    return expression.subs({**angles, **{cos(q): c for q, c in zip(Q, _C, strict=True)}})


def _count(equations: list[sp.Expr], joints: tuple[int, ...], domain: sp.Domain) -> int:
    """Number of monomials outside the ideal of leading monomials."""
    unknowns = [_S[i] for i in joints] + [_C[i] for i in joints]
    circles = [_S[i] ** 2 + _C[i] ** 2 - 1 for i in joints]
    everything = [sp.expand(equation) for equation in equations] + circles
    basis = sp.groebner([e for e in everything if e != 0], *unknowns, order="grevlex", domain=domain)
    leading = [sp.Poly(g, *unknowns).monoms(order="grevlex")[0] for g in basis.exprs]
    bounds = [min((m[i] for m in leading if sum(m) == m[i] > 0), default=0) for i in range(len(unknowns))]
    if not all(bounds):
        raise ValueError("infinitely many solutions, or none")
    return sum(
        not any(all(a >= b for a, b in zip(monomial, m, strict=True)) for m in leading)
        for monomial in itertools.product(*(range(bound) for bound in bounds))
    )


@functools.cache
def shoulder_and_elbow_count() -> int:
    """Solutions for θ2, θ3, θ4 once φ and thereby θ1 are given, for independent k1, k2, dy, l3 and l4.

    Returns:
        Number of complex solutions of the position equations for a target in general position.

    Raises:
        ValueError: If there are infinitely many, or none.

    Source:
        Cox, Little & O'Shea, Ideals, Varieties, and Algorithms, ch. 5 (finiteness theorem).
    """
    k1, k2, dy = sp.symbols("k1 k2 dy")
    p = _algebraic(frame(5)[:3, 3].subs(Q[0], 0))
    return _count([p[0] + k2, p[1] - dy, p[2] - k1], (1, 2, 3), sp.QQ.frac_field(k1, k2, dy, L3, L4))


@functools.cache
def wrist_counts() -> tuple[int, ...]:
    """Solutions for θ5, θ6, θ7 for several rotations with rational entries.

    Returns:
        Number of complex solutions for each.

    Raises:
        ValueError: If there are infinitely many, or none.

    Source:
        Cox, Little & O'Shea, Ideals, Varieties, and Algorithms, ch. 5 (finiteness theorem).
    """
    resting = dict.fromkeys(Q[:4], 0)
    R = _algebraic(sp.expand((frame(4).subs(resting).T * frame(7).subs(resting))[:3, :3]))
    counts = []
    for tangents in _HALF_TANGENTS:
        values: dict[sp.Symbol, sp.Rational] = {}
        for i, t in zip((4, 5, 6), map(sp.Rational, tangents), strict=True):
            values |= {_S[i]: 2 * t / (1 + t**2), _C[i]: (1 - t**2) / (1 + t**2)}
        counts.append(_count(list(R - R.subs(values)), (4, 5, 6), sp.QQ))
    return tuple(counts)
