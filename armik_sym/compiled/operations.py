"""C99 spelling of CasADi's scalar operations."""

from __future__ import annotations

import casadi as ca

# {0} and {1} are the operands; calls carry {f}, the suffix of the floating-point type.
C_OPERATIONS: dict[int, str] = {
    ca.OP_ASSIGN: "{0}",
    ca.OP_ADD: "{0} + {1}",
    ca.OP_SUB: "{0} - {1}",
    ca.OP_MUL: "{0} * {1}",
    ca.OP_DIV: "{0} / {1}",
    ca.OP_NEG: "-{0}",
    ca.OP_SQ: "{0} * {0}",
    ca.OP_TWICE: "{0} + {0}",
    ca.OP_INV: "ONE / {0}",
    ca.OP_SQRT: "sqrt{f}({0})",
    ca.OP_SIN: "sin{f}({0})",
    ca.OP_COS: "cos{f}({0})",
    ca.OP_TAN: "tan{f}({0})",
    ca.OP_ASIN: "asin{f}({0})",
    ca.OP_ACOS: "acos{f}({0})",
    ca.OP_ATAN: "atan{f}({0})",
    ca.OP_ATAN2: "atan2{f}({0}, {1})",
    ca.OP_EXP: "exp{f}({0})",
    ca.OP_LOG: "log{f}({0})",
    ca.OP_POW: "pow{f}({0}, {1})",
    ca.OP_CONSTPOW: "pow{f}({0}, {1})",
    ca.OP_FABS: "fabs{f}({0})",
    ca.OP_FMIN: "fmin{f}({0}, {1})",
    ca.OP_FMAX: "fmax{f}({0}, {1})",
    ca.OP_HYPOT: "hypot{f}({0}, {1})",
    ca.OP_COPYSIGN: "copysign{f}({0}, {1})",
    ca.OP_FLOOR: "floor{f}({0})",
    ca.OP_SIGN: "(real)(({0} > 0) - ({0} < 0))",
    ca.OP_LT: "(real)({0} < {1})",
    ca.OP_LE: "(real)({0} <= {1})",
    ca.OP_EQ: "(real)({0} == {1})",
    ca.OP_NE: "(real)({0} != {1})",
    ca.OP_NOT: "(real)({0} == 0)",
    ca.OP_AND: "(real)({0} != 0 && {1} != 0)",
    ca.OP_OR: "(real)({0} != 0 || {1} != 0)",
    ca.OP_IF_ELSE_ZERO: "({0} != 0) ? {1} : 0",
}
