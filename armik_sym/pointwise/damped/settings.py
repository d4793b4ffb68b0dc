"""The numbers a damped solver runs with, in the form that C and NumPy both read."""

from __future__ import annotations

import ctypes

from armik_sym.pointwise.damped.options import LmOptions, SugiharaOptions
from armik_sym.symbolic import Orientation

LM, SUGIHARA = 0, 1

# Range of LM's damping, in [m²]: smaller changes no step that matters, larger moves no joint by a nanoradian.
_SMALLEST, _LARGEST = 1e-9, 1e9

# A try that gains less than this share of |e|² in that many steps in a row has stalled.
_PROGRESS, _MAX_STALLED = 1e-2, 7


class DampedSettings(ctypes.Structure):
    """The C struct `damped_settings`; fields are explained in compiled/c/damped_pose.h."""

    _fields_ = (
        ("tolerance", ctypes.c_double),
        ("rotation_weight", ctypes.c_double),
        ("damping", ctypes.c_double),
        ("constant_damping", ctypes.c_double),
        ("increase", ctypes.c_double),
        ("decrease", ctypes.c_double),
        ("smallest", ctypes.c_double),
        ("largest", ctypes.c_double),
        ("progress", ctypes.c_double),
        ("method", ctypes.c_int),
        ("printed", ctypes.c_int),
        ("rows", ctypes.c_int),
        ("max_iterations", ctypes.c_int),
        ("max_stalled", ctypes.c_int),
        ("restarts", ctypes.c_int),
    )

    @classmethod
    def of(cls, options: LmOptions | SugiharaOptions, orientation: Orientation) -> DampedSettings:
        """Settings from options.

        Args:
            options: Options of one of the two methods.
            orientation: What is tracked.

        Returns:
            The settings.

        Source:
            None (bookkeeping).
        """
        lm = isinstance(options, LmOptions)
        return cls(
            tolerance=options.tolerance,
            rotation_weight=options.rotation_weight,
            damping=options.damping,
            constant_damping=options.constant_damping if isinstance(options, LmOptions) else 0.0,
            increase=options.increase if isinstance(options, LmOptions) else 1.0,
            decrease=options.decrease if isinstance(options, LmOptions) else 1.0,
            smallest=_SMALLEST,
            largest=_LARGEST,
            progress=_PROGRESS,
            method=LM if lm else SUGIHARA,
            printed=options.residual == "printed",
            rows=3 if orientation is Orientation.NONE else 6,
            max_iterations=options.max_iterations,
            max_stalled=_MAX_STALLED,
            restarts=options.restarts,
        )
