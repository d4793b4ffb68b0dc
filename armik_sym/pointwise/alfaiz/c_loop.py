"""Calling the C loop of the method of Al-Faiz."""

from __future__ import annotations

import ctypes

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.address import address
from armik_sym.compiled.build import Library
from armik_sym.pointwise.alfaiz.found import Found
from armik_sym.pointwise.alfaiz.options import AlfaizOptions

Array = NDArray[np.float64]


class AlfaizSettings(ctypes.Structure):
    """The C struct `alfaiz_settings`; fields are explained in compiled/c/alfaiz_search.h."""

    _fields_ = (
        ("grid", ctypes.c_int),
        ("refinements", ctypes.c_int),
        ("nearest", ctypes.c_int),
        ("near", ctypes.c_double),
        ("tolerance", ctypes.c_double),
    )


class CompiledLoop:
    """The C function `armik_alfaiz_path` for one arm.

    Args:
        library: The shared library.
        arm: The arm.
        options: Options of the method.

    Source:
        Al-Faiz, eq. 4-57.
    """

    def __init__(self, library: Library, arm: Arm, options: AlfaizOptions) -> None:
        self._function = library.handle.armik_alfaiz_path
        self._function.restype = None
        self._settings = AlfaizSettings(
            options.grid, options.refinements, options.prefer == "nearest", options.near, options.tolerance
        )
        self._fixed = (arm.length_values, arm.rom.lower, arm.rom.upper)

    def __call__(self, part: slice, targets: Array, starts: Array | None, chain: bool, found: Found) -> None:
        """Solve samples part.start … part.stop - 1; releases the interpreter lock.

        Args:
            part: The samples.
            targets: Targets of all samples, shape (n, 12).
            starts: One posture (7,) for a chain, else one per sample, shape (n, 7), in [rad]; None if no
                posture is known.
            chain: Whether each sample starts from the posture before.
            found: Where the answers go.

        Source:
            None (packaging).
        """
        first = starts if chain or starts is None else starts[part]
        self._function(
            ctypes.byref(self._settings),
            ctypes.c_ssize_t(part.stop - part.start),
            *(address(array) for array in (targets[part], *self._fixed, first)),
            ctypes.c_int(chain),
            *(address(array[part]) for array in (found.q, found.reached, found.evaluations)),
        )
