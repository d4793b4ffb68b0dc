"""The functions of an emitted library, as CasADi Functions with their C declarations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.c_constant import Precision
from armik_sym.compiled.c_source import c_function, signature_of
from armik_sym.symbolic import express
from armik_sym.symbolic.arm_expressions import LengthMode
from armik_sym.symbolic.row_order import row_by_row

Array = NDArray[np.float64]

_WIDTH = 100
_NEXT = ",\n    "


@dataclass(frozen=True, eq=False)
class EmittedLibrary:
    """What is emitted for one arm.

    Attributes:
        arm: The arm.
        precision: Type of the numbers in C.
        takes_lengths: True if the functions have an argument `lengths`.
        functions: CasADi Functions by the last part of their C name.
    """

    arm: Arm
    precision: Precision
    takes_lengths: bool
    functions: dict[str, ca.Function]

    @classmethod
    def of(cls, arm: Arm, precision: Precision, lengths: LengthMode) -> EmittedLibrary:
        """Build the functions to emit.

        An arm without named segment lengths has nothing to pass: its functions never have the argument.

        Args:
            arm: The arm.
            precision: "double" or "float".
            lengths: "baked" or "parameter".

        Returns:
            The library.

        Raises:
            OptionError: If `lengths` is another word.

        Source:
            Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
        """
        symbols = express(arm, lengths)
        takes_lengths = bool(symbols.lengths.numel())
        inputs = {"q": symbols.q, "lengths": symbols.lengths} if takes_lengths else {"q": symbols.q}
        outputs = {
            "position": symbols.position,
            "rotation": row_by_row(symbols.rotation),
            "jacobian": row_by_row(symbols.jacobian),
        }
        lower, upper = limits_in(arm, precision)
        functions = {"limits": _function("limits", {}, {"lower": ca.DM(lower), "upper": ca.DM(upper)})}
        if takes_lengths:
            functions["default_lengths"] = _function(
                "default_lengths", {}, {"lengths": ca.DM(arm.length_values)}
            )
        functions |= {name: _function(name, inputs, {name: value}) for name, value in outputs.items()}
        functions["pose_and_jacobian"] = _function("pose_and_jacobian", inputs, outputs)
        return cls(arm, precision, takes_lengths, functions)

    @property
    def file_stem(self) -> str:
        """`armik_` and the arm's name: the stem of both files and the prefix of every function."""
        return f"armik_{self.arm.name}"

    def declaration(self, name: str) -> str:
        """The C declaration of a function, without the final semicolon.

        Args:
            name: The last part of its C name.

        Returns:
            C source text, arrays with their lengths.

        Source:
            None (C99, 6.7.5.3).
        """
        signature = signature_of(self.functions[name], f"{self.file_stem}_{name}")
        arguments = [f"const armik_real {key}[ARMIK_RESTRICT {n}]" for key, n in signature.inputs]
        arguments += [f"armik_real {key}[ARMIK_RESTRICT {n}]" for key, n in signature.outputs]
        line = f"void {signature.name}({', '.join(arguments)})"
        return line if len(line) <= _WIDTH else f"void {signature.name}(\n    {_NEXT.join(arguments)})"

    def source(self) -> str:
        """The C source of all functions, using the macro names `real` and `ONE`."""
        parts = []
        for name, function in self.functions.items():
            text = c_function(function, f"{self.file_stem}_{name}", self.precision)
            parts.append(f"{self.declaration(name)} {text[text.index('{') :]}")
        return "\n".join(parts)


def limits_in(arm: Arm, precision: Precision) -> tuple[Array, Array]:
    """Range of motion in the precision of the C code, rounded inwards: no limit grows by rounding.

    Args:
        arm: The arm.
        precision: "double" or "float".

    Returns:
        Lower and upper limits, shape (dof,) each, in [rad] (prismatic: [m]).

    Source:
        None (IEEE 754).
    """
    lower, upper = arm.rom.lower, arm.rom.upper
    if precision == "double":
        return lower, upper
    low, high = lower.astype(np.float32), upper.astype(np.float32)
    low = np.where(low < lower, np.nextafter(low, np.float32(np.inf)), low)
    high = np.where(high > upper, np.nextafter(high, np.float32(-np.inf)), high)
    return low.astype(np.float64), high.astype(np.float64)


def _function(name: str, inputs: Mapping[str, ca.SX], outputs: Mapping[str, ca.SX | ca.DM]) -> ca.Function:
    dense = ca.cse([ca.densify(ca.SX(value)) for value in outputs.values()])
    return ca.Function(name, list(inputs.values()), dense, list(inputs), list(outputs))
