"""Nguyen 2021, eq. (8): the transcription."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp
from sympy import cos, pi, sin, sqrt, tan

from derivations.nguyen2021.chain import Q

q1, q2, q3 = Q[:3]

_t1, _t2, _t3, _u = tan(q1 / 2), tan(q2 / 2), tan(q3 / 2), tan(q2 / 2 - pi / 4)


@dataclass(frozen=True, eq=False)
class Conversion:
    """Eq. (8) in one reading, q'k = -2 atan(x_k).

    Attributes:
        x1: Argument of the arc tangent of q'1.
        x2: That of q'2.
        x3: That of q'3.
    """

    x1: sp.Expr
    x2: sp.Expr
    x3: sp.Expr

    def angles(self) -> sp.Matrix:
        """The angles q'1, q'2, q'3, column."""
        return sp.Matrix([-2 * sp.atan(x) for x in (self.x1, self.x2, self.x3)])


def under_root_1(exponent: int) -> sp.Expr:
    """What stands under the root of q'1.

    Args:
        exponent: Power of tan(q1/2) in the product 4·tan(q1/2)·tan(q2/2 - π/4); 2 is printed.

    Returns:
        SymPy expression.

    Source:
        Nguyen 2021, eq. 8.
    """
    total = _t1**2 + _u**2 + _t1**2 * _u**2 + 1
    product = 4 * _t1**exponent * _u
    return (total - product) * (total + product)


def root_2() -> sp.Expr:
    """The root that occurs in q'2 and q'3.

    Returns:
        SymPy expression.

    Source:
        Nguyen 2021, eq. 8.
    """
    return sqrt(-(cos(q2) ** 2 * sin(q1) ** 2 - 1) / (cos(q1 / 2) ** 4 * (sin(q2) + 1) ** 2))


def conversion(root_1: sp.Expr, root_2: sp.Expr) -> Conversion:
    """Eq. (8) around its two roots; of "q2/2 - pi + ((" in the stored text the reading "q2/2 - pi/4) + ((".

    Args:
        root_1: The root in q'1, with its sign.
        root_2: The root in q'2 and q'3.

    Returns:
        The three arguments.

    Source:
        Nguyen 2021, eq. 8.
    """
    t1, t2, t3, u, V = _t1, _t2, _t3, _u, root_2
    x1 = (2 * u - 2 * t1**2 * u + root_1) / (t1**2 - u**2 - t1**2 * u**2 + 1)
    x2 = (cos(q1) + 1) * (sin(q2) + 1) * V / (2 * (cos(q2) * sin(q1) + 1))
    above = (
        2 * t3
        + V
        + t3**2 * V
        - 2 * t1**2 * t3
        + sin(q2) * V
        + 2 * t1 * sin(q2)
        + t3**2 * sin(q2) * V
        - 2 * t1 * t3**2 * sin(q2)
    )
    below = (
        t1**2
        - t2**2
        + t3**2
        + t1**2 * t2**2
        - t1**2 * t3**2
        + t2**2 * t3**2
        + 8 * t1 * t2 * t3
        - t1**2 * t2**2 * t3**2
        - 1
    )
    x3 = (t2 + 1) ** 2 * above / ((sin(q2) + 1) * below)
    return Conversion(x1, x2, x3)
