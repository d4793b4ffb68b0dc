"""The arm of Al-Faiz as derived: the catalogue's chain, as SymPy expressions."""

from __future__ import annotations

import functools

import sympy as sp

from armik_sym.arm.catalog import alfaiz
from armik_sym.symbolic import express
from derivations.from_casadi import to_sympy

# Joint angles without the offsets of Table 1.
Q = sp.symbols("q1:8", real=True)

# Upper arm (L4 in Table 1, l4 in the equations) and forearm (L5 in Table 1, l5 in A_5, l3 in the equations).
L4, L3 = sp.symbols("l4 l3", positive=True)

OFFSETS = (sp.Integer(0), sp.pi / 2, sp.Integer(0), sp.Integer(0), sp.Integer(0), -sp.pi / 2, sp.Integer(0))


@functools.cache
def frame(index: int) -> sp.Matrix:
    """Frame after a row of Table 1 (α6 as in A_6): T_0^index.

    Args:
        index: Number of the row, 0 for the base.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, Table 1 and eq. 2-3, through `armik_sym.symbolic`.
    """
    expressions = express(alfaiz())
    return to_sympy(expressions.frames[index], [expressions.q, expressions.lengths], [Q, (L4, L3)])


def between(first: int, last: int) -> sp.Matrix:
    """Product A_first … A_last, the transform from frame first - 1 to frame last.

    Args:
        first: Number of the first matrix, 1 to 7.
        last: Number of the last one.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, eq. 3 and 36.
    """
    T = frame(first - 1)
    R, p = T[:3, :3], T[:3, 3]
    inverse = sp.Matrix(sp.BlockMatrix([[R.T, -R.T * p], [sp.zeros(1, 3), sp.ones(1, 1)]]))
    return sp.Matrix(inverse * frame(last))
