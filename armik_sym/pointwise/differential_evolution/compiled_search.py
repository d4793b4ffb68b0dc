"""The searches of ISADE in C: settings, workspace and the call through ctypes."""

from __future__ import annotations

import ctypes
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.build import Library
from armik_sym.pointwise.differential_evolution.options import IsadeOptions, Measure, Repair

Array = NDArray[np.float64]


_WHOLE = ("population", "iter_max", "measure", "repair", "moving_window")
_REAL = (
    "alpha", "f_min", "f_max", "n_iter", "sign", "tau", "travel_weight", "hand_weight", "rotation_weight",
    "stop", "stall", "window",
)  # fmt: skip


class IsadeSettings(ctypes.Structure):
    """`struct isade_settings` of `compiled/c/isade_settings.h`."""

    _fields_ = (
        *((name, ctypes.c_int) for name in _WHOLE),
        *((name, ctypes.c_double) for name in _REAL),
    )


def isade_settings(options: IsadeOptions, measure: Measure) -> IsadeSettings:
    """Options in the form C reads.

    Args:
        options: The options.
        measure: What of the hand error counts.

    Returns:
        The structure.

    Source:
        None (bookkeeping).
    """
    settings = IsadeSettings()
    for name in _REAL:
        if name not in ("sign", "window"):
            setattr(settings, name, getattr(options, name))
    settings.population = options.population_for(measure)
    settings.iter_max = options.iter_max
    settings.measure = get_args(Measure).index(measure)
    settings.repair = get_args(Repair).index(options.repair)
    settings.sign = -1.0 if options.sign == "printed" else 1.0
    settings.window = options.half_window
    settings.moving_window = options.window_moves
    return settings


class CompiledSearch:
    """ISADE in C for blocks of samples; one instance per thread.

    Args:
        library: Library with `armik_isade_path`.
        arm: The arm.
        options: The options.
        measure: What of the hand error counts.

    Source:
        Nguyen 2021, §3.
    """

    def __init__(self, library: Library, arm: Arm, options: IsadeOptions, measure: Measure) -> None:
        handle = library.handle
        self._settings = isade_settings(options, measure)
        self._fixed = tuple(
            np.ascontiguousarray(x, dtype=np.float64)
            for x in (arm.length_values, arm.rom.lower, arm.rom.upper)
        )
        size = [handle.armik_isade_reals, handle.armik_isade_words]
        for function in size:
            function.argtypes, function.restype = [ctypes.c_int], ctypes.c_ssize_t
        self._reals = np.zeros(size[0](self._settings.population))
        self._words = np.zeros(size[1](self._settings.population), dtype=np.uint64)
        self._path = handle.armik_isade_path
        self._path.restype = None
        self._path.argtypes = [
            ctypes.c_void_p,
            ctypes.c_uint64,
            ctypes.c_ssize_t,
            ctypes.c_ssize_t,
            *[ctypes.c_void_p] * 11,
        ]

    def samples(
        self, first: int, targets: Array, previous: Array, seed: int
    ) -> tuple[Array, Array, NDArray[np.intc], NDArray[np.intc]]:
        """Search for a block of samples; releases the interpreter lock.

        Args:
            first: Index of the first sample of the block in its path.
            targets: Position and rotation row by row, shape (n, 12), C-contiguous.
            previous: Posture of the sample before, or q_0 of eq. (16), shape (dof,), in [rad];
                overwritten by that of the last sample.
            seed: Seed of everything random; taken modulo 2⁶⁴.

        Returns:
            Postures (n, dof) in [rad], weighted hand errors (n,) in [m], generations (n,), cost
            evaluations (n,).

        Source:
            Nguyen 2021, §3.3.
        """
        n = len(targets)
        q, error = np.empty((n, len(previous))), np.empty(n)
        generations, evaluations = np.zeros(n, dtype=np.intc), np.zeros(n, dtype=np.intc)
        arrays = (
            targets, *self._fixed, previous, self._reals, self._words, q, error, generations, evaluations
        )  # fmt: skip
        self._path(
            ctypes.addressof(self._settings),
            seed & (2**64 - 1),
            first,
            n,
            *(array.ctypes.data for array in arrays),
        )
        return q, error, generations, evaluations
