"""The letters of the paper: what is displayed is made from the expression that is checked.

So the two cannot differ: whoever changes the displayed formula has changed the statement.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import TypeVar

import sympy as sp

from derivations.alfaiz.chain import Q

Form = TypeVar("Form", sp.Expr, sp.Matrix)

_ANGLES = {q: sp.Symbol(f"theta_{i + 1}", real=True) for i, q in enumerate(Q)}
_SHORT = {sp.sin(q): sp.Symbol(f"s_{i + 1}") for i, q in enumerate(Q)} | {
    sp.cos(q): sp.Symbol(f"c_{i + 1}") for i, q in enumerate(Q)
}
_NONE: Mapping[sp.Expr, sp.Symbol] = MappingProxyType({})


def in_angles(form: Form) -> Form:
    """With θ_i for the joint angles.

    Args:
        form: SymPy expression or matrix in the angles of the chain.

    Returns:
        The same in θ_i.

    Source:
        None (names).
    """
    return form.xreplace(_ANGLES)


def in_letters(form: Form, abbreviations: Mapping[sp.Expr, sp.Symbol] = _NONE) -> Form:
    """With c_i for cos θ_i, s_i for sin θ_i, θ_i for other joint angles.

    Args:
        form: SymPy expression or matrix in the angles of the chain.
        abbreviations: Names of longer expressions in the same angles, put in first.

    Returns:
        The same in the paper's letters. An abbreviation that does not occur changes nothing.

    Source:
        None (names).
    """
    for long, name in abbreviations.items():
        form = form.subs(long, name)
    return in_angles(form.xreplace(_SHORT))


def in_words(value: sp.Expr | float) -> str:
    """An exact number in plain text.

    Args:
        value: The number.

    Returns:
        For example π/2.

    Source:
        None (text).
    """
    return re.sub(r"sqrt\((\d+)\)", r"√\1", str(value)).replace("pi", "π").replace("*", "·")
