"""The solvers that travel with an emitted library: the loops armik_sym runs itself, for one arm."""

from __future__ import annotations

import casadi as ca

from armik_sym.compiled.c_definitions import (
    aligned,
    enumeration,
    renamed,
    struct_members,
    without_blocks,
    without_structs,
)
from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.emit_functions import EmittedLibrary
from armik_sym.compiled.emit_header import common_values
from armik_sym.compiled.emit_text import fill_template
from armik_sym.compiled.hand_written import loop_text
from armik_sym.pointwise.differential_evolution.options import ProIsadeOptions
from armik_sym.pointwise.emit_solver_interface import declarations, default_values
from armik_sym.pointwise.library import LOOPS

# Structures that the header has to show, by the file that defines them.
_DAMPED = {"bounded_step.h": ("step_workspace",), "damped_pose.h": ("damped_point", "damped_workspace")}
_SETTINGS = {"damped_pose.h": ("damped_settings",), "isade_settings.h": ("isade_settings",)}
_CONSTANTS = (
    "DAMPED_LM", "DAMPED_SUGIHARA", "ISADE_POSITION", "ISADE_COSINES", "ISADE_POSE",
    "ISADE_CLIP", "ISADE_REFLECT", "ISADE_RANDOM", "ISADE_MIDPOINT",
)  # fmt: skip
_NOT_EMITTED = ("damped_path.h",)
_FLOAT_NOTE = "\n * Limits of error and damping are larger ones, that single precision can tell from zero."


def solver_texts(library: EmittedLibrary) -> dict[str, str]:
    """The files `armik_<arm>_solvers.h` and `.c`.

    Args:
        library: The library to emit.

    Returns:
        Text by file name.

    Source:
        Nguyen 2021, §3; Al-Faiz, eq. 58-63; Sugihara (2011), doi:10.1109/TRO.2011.2148230.
    """
    common = common_values(library) | declarations(library)
    stem = f"{library.file_stem}_solvers"
    return {
        f"{stem}.h": fill_template("solvers.h", common | _header_values(library)),
        f"{stem}.c": fill_template("solvers.c", common | _source_values(library, f"{stem}.h")),
    }


def solver_keys(library: EmittedLibrary) -> dict[str, str]:
    """What the other templates say about the solvers that are emitted.

    Args:
        library: The library to emit.

    Returns:
        Text by template key.

    Source:
        None (bookkeeping).
    """
    stem = f"{library.file_stem}_solvers"
    return {
        "SOLVERS_SOURCE": f" {stem}.c",
        "SOLVERS_INCLUDE": f'#include "{stem}.h"\n',
        "SOLVERS_CHECK": fill_template("solver_check.c", common_values(library)),
        "SOLVERS_CALL": "  ok = check_solvers(lower, upper, &inside) && ok;\n",
        "SOLVERS_LINES": f"\n{stem}.h    inverse kinematics: a damped step, Levenberg-Marquardt, Sugihara, "
        f"Pro-ISADE\n{stem}.c    these; needs the two files above",
    }


def _public_names(library: EmittedLibrary) -> dict[str, str]:
    structs = [name for group in (_DAMPED, _SETTINGS) for names in group.values() for name in names]
    names = {name: f"{library.file_stem}_{name}" for name in (*structs, *_CONSTANTS)}
    return names | {"real": "armik_real", "DOF": f"ARMIK_{library.arm.name}_DOF", "SMALL": "6"}


def _header_values(library: EmittedLibrary) -> dict[str, str]:
    names = _public_names(library)
    options = ProIsadeOptions()
    dof, size = library.arm.dof, 4 if library.precision == "float" else 8
    population = options.population_for("pose")
    isade_words, isade_reals = population * (dof + 6) + dof, (population + 7) // 8 * 8 * (2 * dof + 3)
    damped_reals = 2 * (7 * dof + 19) + 48 + 11 * dof

    def struct(file: str, name: str) -> str:
        members = aligned(renamed(struct_members(loop_text(file), name), names))
        return f"typedef struct {names[name]} {{\n{members}}} {names[name]};"

    def constants(file: str, first: str) -> str:
        return renamed(enumeration(loop_text(file), first), names)

    return {
        "ROUNDS": str(4 * dof),
        "POPULATION": str(population),
        "POSITION_POPULATION": str(options.population_for("position")),
        "ISADE_BYTES": str(8 * isade_words + size * isade_reals + 8),
        "DAMPED_BYTES": str(size * damped_reals + 5 * dof + 12),
        "FLOAT_NOTE": _FLOAT_NOTE if library.precision == "float" else "",
        "DAMPED_METHODS": constants("damped_pose.h", "DAMPED_LM"),
        "ISADE_MEASURES": "/* What of the hand's error counts: its position; position and the diagonal of\n"
        " * the rotation; position and rotation. */\n" + constants("isade_settings.h", "ISADE_POSE"),
        "ISADE_REPAIRS": "/* What happens to a coordinate of a mutant outside its bounds. */\n"
        + constants("isade_settings.h", "ISADE_CLIP"),
        "DAMPED_SETTINGS": struct("damped_pose.h", "damped_settings"),
        "ISADE_SETTINGS": struct("isade_settings.h", "isade_settings"),
        "DAMPED_WORKSPACE": "\n\n".join(struct(f, name) for f, group in _DAMPED.items() for name in group),
    }


def _source_values(library: EmittedLibrary, header: str) -> dict[str, str]:
    structs = {file: _DAMPED.get(file, ()) + _SETTINGS.get(file, ()) for file in (*_DAMPED, *_SETTINGS)}
    loops = [
        without_structs(without_blocks(loop_text(file), "EXPORT"), structs.get(file, ()), header)
        for file in LOOPS
        if file not in _NOT_EMITTED
    ]
    names = [name for group in structs.values() for name in group]
    takes = library.takes_lengths
    return default_values(library) | {
        "N_LENGTHS": str(len(library.arm.lengths) if takes else 0),
        "RENAMES": "\n".join(f"#define {name} {library.file_stem}_{name}" for name in names),
        "LENGTHS": ", lengths" if takes else "",
        "LENGTHS_OR_NULL": "lengths" if takes else "NULL",
        "UNUSED_LENGTHS": "" if takes else "  (void)lengths;\n",
        "POSE_FUNCTION": c_function(_pose(library), "pose_values", library.precision),
        "LOOPS": "\n".join(loops),
    }


def _pose(library: EmittedLibrary) -> ca.Function:
    """Position and rotation as one function of the same inputs."""
    position, rotation = library.functions["position"], library.functions["rotation"]
    names = [position.name_in(i) for i in range(position.n_in())]
    inputs = [ca.SX.sym(name, position.numel_in(i)) for i, name in enumerate(names)]
    out = ca.cse(ca.densify(ca.vertcat(position(*inputs), rotation(*inputs))))
    return ca.Function("pose", inputs, [out], names, ["out"])
