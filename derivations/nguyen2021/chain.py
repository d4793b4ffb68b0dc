"""The E-HMCS as derived: the catalogue's chain, as SymPy expressions."""

from __future__ import annotations

import dataclasses
import functools

import sympy as sp

from armik_sym.arm import DHChain, DHConvention
from armik_sym.arm.catalog import ehmcs
from armik_sym.symbolic import express
from derivations.from_casadi import to_sympy

Q = sp.symbols("q1:8", real=True)

# Segment lengths of Table 4, in [mm] as the paper prints them.
UPPER_ARM = sp.Rational("286.9")
FOREARM = sp.Integer(336)


@functools.cache
def frame(index: int, convention: DHConvention = DHConvention.STANDARD, d2_mm: int = 0) -> sp.Matrix:
    """Frame after a row of Table 4, lengths in [mm]: T_0^index.

    Args:
        index: Number of the row, 0 for the base.
        convention: How the rows are read.
        d2_mm: Row 2's d; the table prints 7, the catalogue uses 0.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Nguyen 2021, Table 4 and eq. 2, through `armik_sym.symbolic`.
    """
    arm = ehmcs()
    rows = list(arm.chain.links)
    rows[1] = dataclasses.replace(rows[1], d=d2_mm / 1000)
    arm = dataclasses.replace(arm, chain=DHChain(tuple(rows), convention))
    expressions = express(arm)
    lengths = (UPPER_ARM / 1000, FOREARM / 1000)
    T = to_sympy(expressions.frames[index], [expressions.q, expressions.lengths], [Q, lengths])
    T[:3, 3] *= 1000
    return T
