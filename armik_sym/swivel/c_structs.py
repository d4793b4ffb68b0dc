"""Arms and curves as the hand-written C sees them."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.evaluate import rows_of, step_of

if TYPE_CHECKING:
    from armik_sym.swivel.closed_form import SwivelCurve

Array = NDArray[np.float64]
_Seven = ctypes.c_double * 7
_Two = ctypes.c_double * 2


class CArm(ctypes.Structure):
    """The C struct `swivel_arm` of compiled/c/swivel_arm.h."""

    _fields_ = (
        ("dof", ctypes.c_int64),
        ("triples", ctypes.c_int64),
        ("lower", _Seven),
        ("upper", _Seven),
        ("offset", _Two),
    )


class CSide(ctypes.Structure):
    """The C struct `swivel_side` of compiled/c/swivel_arm.h."""

    _fields_ = (
        ("parts", ctypes.c_void_p),
        ("elbow", ctypes.c_void_p),
        ("shortfall", ctypes.c_void_p),
        ("rest", ctypes.c_void_p),
        ("parts_step", ctypes.c_ssize_t),
        ("elbow_step", ctypes.c_ssize_t),
        ("shortfall_step", ctypes.c_ssize_t),
        ("rest_step", ctypes.c_ssize_t),
    )


class CCurves:
    """Curves for C, with the arrays they point into kept alive.

    Args:
        curves: Curves of one arm; joints beyond the seventh have no limits that count here.

    Source:
        None (packaging).
    """

    def __init__(self, *curves: SwivelCurve) -> None:
        rom, triples = curves[0].spherical.arm.rom, curves[0].triples
        offsets = [triple.offset for triple in triples]
        self._arm = CArm(
            rom.dof, len(triples), _Seven(*rom.lower[:7]), _Seven(*rom.upper[:7]), _Two(*offsets)
        )
        self._kept: list[Array] = []
        self._sides = (CSide * len(curves))(*(self._side(curve) for curve in curves))
        self.arguments = (ctypes.byref(self._arm), self._sides)

    def _side(self, curve: SwivelCurve) -> CSide:
        rest = curve.rest if curve.rest is None or curve.rest.size else np.zeros((1, 1))
        rows = [
            None if value is None else rows_of(value)
            for value in (curve.parts, curve.elbow[:, None], curve.shortfall[:, None], rest)
        ]
        self._kept += [value for value in rows if value is not None]
        return CSide(
            *(None if value is None else value.ctypes.data for value in rows),
            *(0 if value is None else step_of(value) for value in rows),
        )
