"""C99 from a CasADi expression: one plain function, arrays in, arrays out.

Written for this package instead of CasADi's own generator: plain arguments in place of pointer
tables, no test per output, constants in the precision asked for, no helper types, and nothing but
straight-line code that a compiler can schedule and that a reviewer of a controller can read.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca

from armik_sym.compiled.c_constant import SUFFIX, Precision, c_constant
from armik_sym.compiled.operations import C_OPERATIONS
from armik_sym.errors import OptionError


@dataclass(frozen=True)
class CSignature:
    """Name and arguments of a generated C function.

    Attributes:
        name: The function's name.
        inputs: Name and number of entries of every input array.
        outputs: Name and number of entries of every output array.
    """

    name: str
    inputs: tuple[tuple[str, int], ...]
    outputs: tuple[tuple[str, int], ...]

    def declaration(self, real: str) -> str:
        """The C declaration without the final semicolon.

        Args:
            real: Name of the number type.

        Returns:
            C source text.

        Source:
            None (C99, 6.7.5.3).
        """
        arguments = [f"const {real} *restrict {name}" for name, _ in self.inputs]
        arguments += [f"{real} *restrict {name}" for name, _ in self.outputs]
        return f"void {self.name}({', '.join(arguments)})"


def signature_of(function: ca.Function, name: str) -> CSignature:
    """Signature of the C function that `c_function` writes.

    Args:
        function: A CasADi Function of SX type.
        name: Name of the C function.

    Returns:
        The signature.

    Source:
        None (bookkeeping).
    """
    inputs = tuple((function.name_in(i), function.numel_in(i)) for i in range(function.n_in()))
    outputs = tuple((function.name_out(i), function.numel_out(i)) for i in range(function.n_out()))
    return CSignature(name, inputs, outputs)


def c_function(
    function: ca.Function,
    name: str,
    precision: Precision = "double",
    constant: Callable[[float, Precision], str] = c_constant,
) -> str:
    """Write a CasADi Function as one C99 function of plain arrays.

    Every operation becomes one `const` variable, in the order in which CasADi evaluates. All outputs
    are written, entry by entry in column-major order (of a dense output).

    Args:
        function: A CasADi Function of SX type with dense inputs and outputs.
        name: Name of the C function; must be a plain identifier.
        precision: "double" or "float".
        constant: Writes a constant; another type than double or float needs its own.

    Returns:
        C source text of the function, using the macro names `real` and `ONE`.

    Raises:
        OptionError: If the Function is no SX function with dense inputs and outputs, or uses an
            operation that has no C99 spelling.

    Source:
        None (C99).
    """
    _check_dense(function)
    signature = signature_of(function, name)
    value_of: dict[int, str] = {}
    used = {input_name: False for input_name, _ in signature.inputs}
    lines: list[str] = []
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        source, target = function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_OUTPUT:
            lines.append(f"  {signature.outputs[target[0]][0]}[{target[1]}] = {value_of[source[0]]};")
        elif operation == ca.OP_INPUT:
            input_name = signature.inputs[source[0]][0]
            used[input_name] = True
            value_of[target[0]] = f"v{k}"
            lines.append(f"  const real v{k} = {input_name}[{source[1]}];")
        elif operation == ca.OP_CONST:
            value_of[target[0]] = constant(function.instruction_constant(k), precision)
        else:
            text = _spell(operation, [value_of[i] for i in source], precision)
            value_of[target[0]] = f"v{k}"
            lines.append(f"  const real v{k} = {text};")
    unused = [f"  (void){input_name};" for input_name, seen in used.items() if not seen]
    return "\n".join([f"{signature.declaration('real')} {{", *unused, *lines, "}", ""])


def _check_dense(function: ca.Function) -> None:
    if not function.is_a("SXFunction"):
        raise OptionError(f"function {function.name()!r} is no SX function: expand() makes it one")
    patterns = {function.name_in(i): function.sparsity_in(i) for i in range(function.n_in())}
    patterns |= {function.name_out(i): function.sparsity_out(i) for i in range(function.n_out())}
    sparse = [key for key, pattern in patterns.items() if not pattern.is_dense()]
    if sparse:
        raise OptionError(f"function {function.name()!r}: {sparse[0]!r} is sparse, densify() it")


def _spell(operation: int, operands: list[str], precision: Precision) -> str:
    template = C_OPERATIONS.get(operation)
    if template is None:
        names = [key for key in dir(ca) if key.startswith("OP_") and getattr(ca, key) == operation]
        raise OptionError(f"CasADi operation {names[0] if names else operation} has no C99 spelling here")
    return template.format(*operands, f=SUFFIX[precision])
