"""One entry point for C code that leaves Python: kinematics, and the solvers if asked for."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

from armik_sym.arm.model import Arm
from armik_sym.compiled.c_constant import check_precision
from armik_sym.compiled.emit import write_library
from armik_sym.compiled.emit_functions import EmittedLibrary
from armik_sym.pointwise.emit_solvers import solver_keys, solver_texts


def emit_c(
    arm: Arm,
    out_dir: str | os.PathLike[str],
    precision: Literal["double", "float"] = "double",
    lengths: Literal["baked", "parameter"] = "baked",
    solvers: bool = False,
) -> Path:
    """Write a C99 library with position, rotation and Jacobian of an arm, and a test that checks it.

    T_base_hand(q) = base · Π T_i(q_i) · tool; [v; ω] = J(q) q̇.

    The folder gets `armik_<arm>.h` (documented), `armik_<arm>.c` (straight-line code: no heap, no
    globals, no recursion), `main.c` with `test_vectors.h` (a test against values computed from the DH
    table without these expressions), `CMakeLists.txt` and `README.txt`. With `solvers` also
    `armik_<arm>_solvers.h` and `.c`: Levenberg-Marquardt, Sugihara's method, Pro-ISADE and single damped
    steps that stay inside the range of motion, with bounded loops and memory the caller provides. Files
    emitted earlier are replaced, files of other origin are not.

    Args:
        arm: The arm; its name becomes part of file and function names.
        out_dir: The folder to write to, created if need be.
        precision: "double" or "float", the type of all numbers in C.
        lengths: "baked" puts the arm's segment lengths [m] into the code, "parameter" makes them an
            argument of every function.
        solvers: Whether the inverse kinematics are emitted too.

    Returns:
        The folder.

    Raises:
        OptionError: If an option is unknown, or the folder cannot be written to or holds a file of
            another origin under one of the names.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3; Siciliano et al., Robotics (2009), eq. 3.30. Solvers: Nguyen 2021,
        §3; Al-Faiz, eq. 58-63; Sugihara (2011), doi:10.1109/TRO.2011.2148230.
    """
    library = EmittedLibrary.of(arm, check_precision(precision), lengths)
    if solvers:
        return write_library(library, out_dir, solver_keys(library), solver_texts(library))
    return write_library(library, out_dir)
