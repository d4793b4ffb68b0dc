"""Matrices entry by entry, row by row: the order of NumPy and C (CasADi stores column by column)."""

from __future__ import annotations

import casadi as ca


def row_by_row(matrix: ca.SX) -> ca.SX:
    """Entries of a matrix row by row.

    Args:
        matrix: SX of shape (m, n).

    Returns:
        SX of shape (m·n, 1).

    Source:
        None (bookkeeping).
    """
    return ca.vec(ca.densify(matrix).T)


def row_major(entries: ca.SX) -> ca.SX:
    """A 3 x 3 matrix from its entries row by row.

    Args:
        entries: SX of shape (9, 1).

    Returns:
        SX of shape (3, 3).

    Source:
        None (bookkeeping).
    """
    return ca.reshape(entries, 3, 3).T
