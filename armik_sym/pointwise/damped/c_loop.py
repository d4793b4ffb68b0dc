"""Calling the C loop of the damped methods."""

from __future__ import annotations

import ctypes

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.address import address
from armik_sym.compiled.build import Library
from armik_sym.pointwise.damped.found import Found
from armik_sym.pointwise.damped.settings import DampedSettings

Array = NDArray[np.float64]


class CompiledLoop:
    """The C function `armik_damped_path` for one arm.

    Args:
        library: The shared library.
        arm: The arm.
        settings: Numbers of the method.
        seed: Seed of random restarts.

    Source:
        Al-Faiz, eq. 58-63; Sugihara (2011), doi:10.1109/TRO.2011.2148230.
    """

    def __init__(self, library: Library, arm: Arm, settings: DampedSettings, seed: int) -> None:
        self._function = library.handle.armik_damped_path
        self._function.restype = None
        self._settings = settings
        self._seed = ctypes.c_uint64(seed)
        self._fixed = (arm.length_values, arm.rom.lower, arm.rom.upper)

    def __call__(self, part: slice, targets: Array, starts: Array, chain: bool, found: Found) -> None:
        """Solve samples part.start … part.stop - 1; releases the interpreter lock.

        Args:
            part: The samples.
            targets: Targets of all samples, shape (n, 12).
            starts: One posture (dof,) for a chain, else one per sample, shape (n, dof), in [rad].
            chain: Whether each sample starts from the posture before.
            found: Where the answers go.

        Source:
            None (packaging).
        """
        first = starts if chain else starts[part]
        self._function(
            ctypes.byref(self._settings),
            ctypes.c_ssize_t(part.stop - part.start),
            ctypes.c_uint64(part.start),
            self._seed,
            *(address(array) for array in (targets[part], *self._fixed, first)),
            ctypes.c_int(chain),
            *(address(a[part]) for a in (found.q, found.error, found.iterations, found.evaluations)),
        )
