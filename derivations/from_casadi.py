"""CasADi expressions as SymPy expressions, exactly.

The derived side of a claim comes from `armik_sym.symbolic`; the exact proof happens in SymPy. This is
the bridge: every operation is carried over one by one, every constant as the rational it is printed as, or
as a right angle if it is the double nearest to one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import casadi as ca
import sympy as sp

_OPERATIONS: dict[int, Callable[..., sp.Expr]] = {
    ca.OP_ASSIGN: lambda a: a,
    ca.OP_ADD: lambda a, b: a + b,
    ca.OP_SUB: lambda a, b: a - b,
    ca.OP_MUL: lambda a, b: a * b,
    ca.OP_DIV: lambda a, b: a / b,
    ca.OP_NEG: lambda a: -a,
    ca.OP_SQ: lambda a: a**2,
    ca.OP_TWICE: lambda a: 2 * a,
    ca.OP_INV: lambda a: 1 / a,
    ca.OP_SQRT: sp.sqrt,
    ca.OP_SIN: sp.sin,
    ca.OP_COS: sp.cos,
    ca.OP_ATAN2: sp.atan2,
    ca.OP_ACOS: sp.acos,
    ca.OP_TAN: sp.tan,
    ca.OP_LT: sp.StrictLessThan,
    ca.OP_NOT: sp.Not,
    ca.OP_IF_ELSE_ZERO: lambda condition, value: sp.Piecewise((value, condition), (0, True)),
}


def to_sympy(expression: ca.SX, inputs: Sequence[ca.SX], names: Sequence[Sequence[sp.Expr]]) -> sp.Matrix:
    """A CasADi expression as a SymPy matrix.

    Args:
        expression: SX of shape (m, n).
        inputs: The SX vectors it depends on.
        names: For every input, the SymPy expressions its entries become.

    Returns:
        SymPy matrix of shape (m, n).

    Raises:
        KeyError: If an operation has no counterpart here.

    Source:
        None (bookkeeping).
    """
    function = ca.Function("f", list(inputs), [ca.densify(expression)])
    memory: dict[int, sp.Expr] = {}
    out = sp.zeros(*expression.shape)
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        source, target = function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_INPUT:
            memory[target[0]] = names[source[0]][source[1]]
        elif operation == ca.OP_CONST:
            memory[target[0]] = _constant(function.instruction_constant(k))
        elif operation == ca.OP_OUTPUT:
            out[target[1] % out.rows, target[1] // out.rows] = memory[source[0]]
        else:
            memory[target[0]] = _OPERATIONS[operation](*(memory[i] for i in source))
    return out


def _constant(value: float) -> sp.Expr:
    right_angles = round(value / (math.pi / 2))
    if right_angles and value == right_angles * (math.pi / 2):
        return right_angles * sp.pi / 2
    return sp.Rational(repr(value))
