"""C source of the module that the page runs."""

from __future__ import annotations

from importlib import resources

from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.hand_written import loop_text
from armik_sym.compiled.library_source import PRELUDE
from armik_sym.report.wasm.drawn_points import drawn_function
from armik_sym.swivel.expressions import swivel_functions
from armik_sym.swivel.library import swivel_constants
from armik_sym.symbolic import ArmExpressions

# One posture at a time: no vectors, and of the loops only what a posture needs.
_PLAIN = "#define LANES 1"
_FUNCTIONS = ("swivel_curve", "swivel_sides", "swivel_of")
_LOOPS = ("swivel_arm.h", "swivel_triple.h", "swivel_postures.h")


def module_source(arm: ArmExpressions, swivel: bool) -> str:
    """C source: generated kinematics, the closed form over the swivel angle, and what exports them.

    Args:
        arm: Symbolic kinematics with segment lengths as parameters.
        swivel: Whether the arm has a closed form for poses.

    Returns:
        C99, to be compiled to WebAssembly or to a shared library.

    Source:
        None (packaging).
    """
    dof, lengths = arm.arm.dof, arm.lengths.numel()
    parts = [PRELUDE, _PLAIN, f"#define PAGE_DOF {dof}", f"#define PAGE_LENGTHS {max(1, lengths)}"]
    parts.append("static " + c_function(drawn_function(arm), "armik_drawn"))
    if swivel:
        parts += ["#define PAGE_SWIVEL", *swivel_constants()]
        functions = swivel_functions()
        parts += ["static " + c_function(functions[name], f"armik_{name}") for name in _FUNCTIONS]
        parts += [loop_text(name) for name in _LOOPS]
    return "\n".join([*parts, script_text("page.c")])


def script_text(name: str) -> str:
    """A hand-written file of this folder that goes into the module or the page.

    Args:
        name: File name.

    Returns:
        Its text.

    Source:
        None (packaging).
    """
    return (resources.files("armik_sym.report.wasm") / name).read_text(encoding="ascii")
