"""`armik emit-c`: the kinematics of an arm as C code for a robot controller."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, cast

import typer

from armik_sym.cli.console import say


def emit_c(
    arm: Annotated[str, typer.Option(help="Arm: a name (ehmcs, human, alfaiz) or a TOML file.")],
    out: Annotated[Path, typer.Option(help="Folder for the C files.")],
    precision: Annotated[str, typer.Option(help="double or float.")] = "double",
    lengths: Annotated[
        str, typer.Option(help="baked (constants in the code) or parameter (argument of every function).")
    ] = "baked",
    solvers: Annotated[
        bool,
        typer.Option(
            "--solvers",
            help="Also inverse kinematics: damped step, Levenberg-Marquardt, Sugihara, Pro-ISADE.",
        ),
    ] = False,
) -> None:
    """Write an arm as a C library with its own test."""
    import armik_sym as ak

    folder = ak.emit_c(
        ak.load_arm(arm),
        out,
        precision=cast("Literal['double', 'float']", precision),
        lengths=cast("Literal['baked', 'parameter']", lengths),
        solvers=solvers,
    )
    files = sorted(path.name for path in folder.iterdir() if path.is_file())
    say(f"{folder}: {', '.join(files)}")
    say(f"How to build and test it: {folder / 'README.txt'}")
