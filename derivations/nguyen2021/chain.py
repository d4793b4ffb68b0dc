"""The E-HMCS as derived: the catalogue's chain, as SymPy expressions."""

from __future__ import annotations

import dataclasses
import functools

import casadi as ca
import sympy as sp

from armik_sym.arm import DHChain, DHConvention, DHLink
from armik_sym.arm.catalog import ehmcs
from armik_sym.symbolic import express
from armik_sym.symbolic.link_transform import link_transform
from derivations.from_casadi import to_sympy

Q = sp.symbols("q1:8", real=True)

# Segment lengths of Table 4, in [mm] as the paper prints them.
UPPER_ARM = sp.Rational("286.9")
FOREARM = sp.Integer(336)

_ROW_2 = "row_2"  # name under which row 2's d enters the chain


@functools.cache
def frame(
    index: int,
    convention: DHConvention = DHConvention.STANDARD,
    d2_mm: sp.Expr = sp.S.Zero,
) -> sp.Matrix:
    """Frame after a row of Table 4, lengths in [mm]: T_0^index.

    Args:
        index: Number of the row, 0 for the base.
        convention: How the rows are read.
        d2_mm: Row 2's d, a number or a symbol; the table prints 7, the catalogue uses 0.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Nguyen 2021, Table 4 and eq. 2, through `armik_sym.symbolic`.
    """
    arm = ehmcs()
    rows = list(arm.chain.links)
    rows[1] = dataclasses.replace(rows[1], d=_ROW_2)
    chain = DHChain(tuple(rows), convention)
    arm = dataclasses.replace(arm, chain=chain, lengths={**arm.lengths, _ROW_2: 1.0})
    expressions = express(arm)
    values = {_ROW_2: sp.sympify(d2_mm), "upper_arm": UPPER_ARM, "forearm": FOREARM}
    lengths = [values[name] / 1000 for name in chain.length_names]
    T = to_sympy(expressions.frames[index], [expressions.q, expressions.lengths], [Q, lengths])
    T[:3, 3] *= 1000
    return T


def one_row(link: DHLink, convention: DHConvention, names: tuple[sp.Expr, sp.Expr, sp.Expr]) -> sp.Matrix:
    """The transform of one row, as `armik_sym` builds it.

    Args:
        link: The row; its d and a are called "d" and "a".
        convention: How it is read.
        names: What joint variable, d and a are to be called.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Nguyen 2021, eq. 1, through `armik_sym.symbolic`.
    """
    q, d, a = (ca.SX.sym(name) for name in "qda")
    T = link_transform(link, convention, q, {"d": d, "a": a})
    return to_sympy(T, [q, d, a], [[name] for name in names])
