"""Declarations and default settings of the emitted solvers."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping

from armik_sym.compiled.c_constant import Precision, c_constant
from armik_sym.compiled.emit_functions import EmittedLibrary
from armik_sym.pointwise.damped.options import LmOptions, SugiharaOptions
from armik_sym.pointwise.damped.settings import DampedSettings
from armik_sym.pointwise.differential_evolution.compiled_search import isade_settings
from armik_sym.pointwise.differential_evolution.options import ProIsadeOptions
from armik_sym.symbolic import Orientation

_WIDTH = 100

# What 24 bits can tell from zero, for a reach of 1 m: the position of the hand is good to 1e-7 m or so.
_FLOAT_ERROR = 1e-5
_FLOAT_DAMPING = 1e-6


def declarations(library: EmittedLibrary) -> dict[str, str]:
    """The C declarations of the solvers, without the final semicolons, by template key.

    Args:
        library: The library to emit.

    Returns:
        C source text by key.

    Source:
        None (C99, 6.7.5.3).
    """
    prefix = f"{library.file_stem}_"
    dof = library.arm.dof
    position, rotation = _read("position", 3), _read("rotation", 9)
    lengths = [_read("lengths", len(library.arm.lengths))] if library.takes_lengths else []
    limits = [_read("lower", dof), _read("upper", dof)]
    damped, isade = f"{prefix}damped_settings", f"{prefix}isade_settings"
    workspace = f"{prefix}damped_workspace *workspace"
    one_pose = [
        f"const {damped} *settings", position, rotation, *lengths, *limits,
        "uint64_t seed", _written("q", dof), workspace,
    ]  # fmt: skip
    arguments: dict[str, tuple[str, list[str]]] = {
        "lm_defaults": ("void", [f"{damped} *settings"]),
        "sugihara_defaults": ("void", [f"{damped} *settings"]),
        "pro_isade_defaults": ("void", [f"{isade} *settings"]),
        "pose_residual": (
            "armik_real",
            [
                position, rotation, _read("q", dof), *lengths, "armik_real rotation_weight", "int rows",
                _written("residual", 6), _written("jacobian", 6 * dof),
            ],
        ),
        "damped_step": (
            "int",
            [
                "const armik_real *ARMIK_RESTRICT jacobian", "const armik_real *ARMIK_RESTRICT residual",
                "int rows", "armik_real damping", _read("q", dof), *limits, _written("step", dof), workspace,
            ],
        ),
        "lm": ("armik_real", one_pose),
        "sugihara": ("armik_real", one_pose),
        "pro_isade": (
            "armik_real",
            [
                f"const {isade} *settings", position, rotation, *lengths, *limits, "uint64_t seed",
                "uint64_t sample", _written("q", dof), f"{prefix}isade_workspace *workspace",
            ],
        ),
    }  # fmt: skip
    return {
        name.upper(): _wrapped(f"{returns} {prefix}{name}(", parts)
        for name, (returns, parts) in arguments.items()
    }


def default_values(library: EmittedLibrary) -> dict[str, str]:
    """C statements that set every member of the settings to what the Python options default to.

    Single precision gets tolerances and a damping that it can tell from zero.

    Args:
        library: The library to emit.

    Returns:
        C source text by template key.

    Source:
        None (the option classes).
    """
    lm = DampedSettings.of(LmOptions(), Orientation.FULL)
    sugihara = DampedSettings.of(SugiharaOptions(), Orientation.FULL)
    isade = isade_settings(ProIsadeOptions(), "pose")
    precision = library.precision
    if precision == "float":
        size = max(1.0, library.arm.reach)
        for settings in (lm, sugihara):
            settings.tolerance, settings.smallest = _FLOAT_ERROR * size, _FLOAT_DAMPING * size**2
        sugihara.damping, isade.stop = _FLOAT_DAMPING * size**2, _FLOAT_ERROR * size
    chosen: Mapping[str, ctypes.Structure] = {"LM": lm, "SUGIHARA": sugihara, "PRO_ISADE": isade}
    return {f"{name}_VALUES": _assignments(settings, precision) for name, settings in chosen.items()}


def _assignments(settings: ctypes.Structure, precision: Precision) -> str:
    lines = []
    for name, kind in (field[:2] for field in settings._fields_):
        value = getattr(settings, name)
        lines.append(
            f"  settings->{name} = {c_constant(value, precision) if kind is ctypes.c_double else value};"
        )
    return "\n".join(lines)


def _read(name: str, size: int) -> str:
    return f"const armik_real {name}[ARMIK_RESTRICT {size}]"


def _written(name: str, size: int) -> str:
    return f"armik_real {name}[ARMIK_RESTRICT {size}]"


def _wrapped(head: str, arguments: list[str]) -> str:
    """The declaration in one line, or as many arguments per line as fit."""
    lines = [head]
    for i, argument in enumerate(arguments):
        text = argument + (")" if i == len(arguments) - 1 else ",")
        if len(lines[-1]) + 1 + len(text) > _WIDTH:
            lines.append("   ")
        lines[-1] += text if lines[-1].endswith("(") else f" {text}"
    return "\n".join(lines)
