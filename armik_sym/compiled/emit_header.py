"""The header of an emitted library: everything a controller's programmer has to know."""

from __future__ import annotations

import math

from armik_sym._version import __version__
from armik_sym.arm.dh import DHLink, JointType
from armik_sym.compiled.emit_functions import EmittedLibrary
from armik_sym.compiled.emit_text import comment_text, fill_template

_UNIT = {JointType.REVOLUTE: "rad", JointType.PRISMATIC: "m"}


def common_values(library: EmittedLibrary) -> dict[str, str]:
    """What every template may name: the arm, the version, the precision and how lengths are passed.

    Args:
        library: The library to emit.

    Returns:
        Text by template key.

    Source:
        None (bookkeeping).
    """
    return {
        "ARM": library.arm.name,
        "VERSION": __version__,
        "PRECISION": library.precision,
        "REAL": library.precision,
        "DESCRIPTION": comment_text(library.arm.description) or "No description.",
        "LENGTH_MODE": "as arguments" if library.takes_lengths else "baked in",
        "LENGTHS_ARGUMENT": ", test_lengths" if library.takes_lengths else "",
        "ONE": "1.0f" if library.precision == "float" else "1.0",
    }


def header_text(library: EmittedLibrary) -> str:
    """The documented header.

    Args:
        library: The library to emit.

    Returns:
        C source text.

    Source:
        None (C99).
    """
    arm = library.arm
    this, other = ("FLOAT", "DOUBLE") if library.precision == "float" else ("DOUBLE", "FLOAT")
    declarations = {
        f"{name.upper()}_DECLARATION": library.declaration(name)
        for name in library.functions
        if name != "default_lengths"
    }
    lengths_declaration = ""
    if library.takes_lengths:
        lengths_declaration = (
            f"/* The lengths of this arm, in [m], to start from. */\n"
            f"{library.declaration('default_lengths')};\n\n"
        )
    return fill_template(
        "header.h",
        common_values(library)
        | declarations
        | {
            "CONVENTION": arm.chain.convention.value,
            "DOF": str(arm.dof),
            "THIS_REAL": this,
            "OTHER_REAL": other,
            "JOINTS": _joint_table(library),
            "LENGTHS": _length_table(library),
            "INDICES": _indices(library),
            "LENGTHS_DECLARATION": lengths_declaration,
        },
    )


def _joint_table(library: EmittedLibrary) -> str:
    arm = library.arm
    width = max(len(name) for name in arm.joint_names)
    return "\n".join(
        f" *   q[{i}]  {link.name:<{width}}  {_range(link, arm.rom.lower[i], arm.rom.upper[i])}"
        for i, link in enumerate(arm.chain.moving_links)
    )


def _range(link: DHLink, lower: float, upper: float) -> str:
    text = f"[{_UNIT[link.joint]}]  {lower:.6g} to {upper:.6g}"
    if link.joint is JointType.REVOLUTE:
        text += f"  ({math.degrees(lower):.6g} to {math.degrees(upper):.6g} deg)"
    return text


def _length_table(library: EmittedLibrary) -> str:
    lengths = library.arm.lengths
    if not lengths:
        return " * This arm has no named segment lengths."
    if library.takes_lengths:
        head = " * Order of the entries of lengths, in [m] (in brackets: the arm's own):"
        rows = [f" *   lengths[{i}]  {name}  ({value!r})" for i, (name, value) in enumerate(lengths.items())]
    else:
        head = " * Segment lengths in the code, in [m]:"
        rows = [f" *   {name} = {value!r}" for name, value in lengths.items()]
    return "\n".join([head, " *", *rows])


def _indices(library: EmittedLibrary) -> str:
    arm = library.arm
    kinds = {"joint": arm.joint_names}
    if library.takes_lengths:
        kinds["length"] = tuple(arm.lengths)
    blocks = []
    for kind, names in kinds.items():
        rows = ",\n".join(f"  armik_{arm.name}_{kind}_{name} = {i}" for i, name in enumerate(names))
        blocks.append(f"enum armik_{arm.name}_{kind} {{\n{rows}\n}};")
    return "\n".join(blocks)
