"""The objective over one coordinate per sample with its derivatives, in C or in NumPy.

∂f/∂x_k = q'_k·F_k,   ∂²f/∂x_k∂x_l = K_kl q'_k·q'_l + [k = l] q''_k·F_k,   F = Sᵀ(Sq - b),   K = SᵀS.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from armik_sym.compiled.address import address
from armik_sym.compiled.build import Library
from armik_sym.symbolic.dense_function import evaluate_rows
from armik_sym.trajectory.one_curve.smoothness import Smoothness
from armik_sym.trajectory.one_curve.stage import curve_functions

Array = NDArray[np.float64]

_JOINTS = 7
_ROOM = 48


@dataclass(frozen=True, eq=False)
class Derivatives:
    """Everything at one point.

    Attributes:
        value: The objective.
        q: Joint angles, shape (n, 7), in [rad].
        slope: dq/dx, shape (n, 7).
        curvature: d²q/dx², shape (n, 7).
        gradient: Shape (n,).
        bands: Diagonal and upper bands of the Hessian, shape (3, n): band i at [i, : n - i].
    """

    value: float
    q: Array
    slope: Array
    curvature: Array
    gradient: Array
    bands: Array


class CurveObjective:
    """½ |S q(x) - b|² and its derivatives.

    Args:
        library: The compiled loops; None for NumPy.
        parameters: Parameters of all samples, shape (n, SIZE), as in `one_curve.stage`.
        smoothness: The quadratic objective.
        chart: What the coordinate of each sample is, as in `one_curve.stage`, shape (n,); ψ if left out.

    Source:
        None (chain rule).
    """

    def __init__(
        self,
        library: Library | None,
        parameters: Array,
        smoothness: Smoothness,
        chart: NDArray[np.int32] | None = None,
    ) -> None:
        self.smoothness = smoothness
        self.n = len(parameters)
        self._library = library
        self._parameters = np.ascontiguousarray(parameters)
        self._chart = np.zeros(self.n, dtype=np.int32) if chart is None else chart.astype(np.int32)
        s = smoothness
        self._weights = tuple(np.ascontiguousarray(part) for part in (s.speed, s.bend, s.hold, s.aim))
        if library is None:
            self._S = s.matrix()
            self._K = sp.csr_array(self._S.T @ self._S)
            self._b = np.zeros((self._S.shape[0], _JOINTS))
            self._b[-self.n :] = s.hold[:, None] * s.aim

    def value(self, x: Array) -> tuple[float, Array]:
        """The objective.

        Args:
            x: Coordinates, shape (n,), in [rad].

        Returns:
            Its value, and the joint angles, shape (n, 7), in [rad].

        Source:
            None (definition).
        """
        if self._library is None:
            q = self._rows("angles", x)
            off = self._S @ q - self._b
            return 0.5 * float(np.vdot(off, off)) + self._of_postures(q), q
        q = np.empty((self.n, _JOINTS))
        return self._call("armik_curve_value", x, q) + self._of_postures(q), q

    def derivatives(self, x: Array) -> Derivatives:
        """Objective, gradient and Hessian.

        Args:
            x: Coordinates, shape (n,), in [rad].

        Returns:
            All of them.

        Source:
            None (chain rule).
        """
        n = self.n
        bands = np.zeros((3, n))
        if self._library is not None:
            q, slope, curvature, force = (np.empty((n, _JOINTS)) for _ in range(4))
            gradient = np.empty(n)
            value = self._call("armik_curve_derivatives", x, q, slope, curvature, force, gradient, bands)
            return self._with_postures(Derivatives(value, q, slope, curvature, gradient, bands))
        q, slope, curvature = np.split(self._rows("second", x), 3, axis=1)
        off = self._S @ q - self._b
        force = self._S.T @ off
        for i in range(min(3, n)):
            products = np.einsum("nj,nj->n", slope[: n - i], slope[i:])
            bands[i, : n - i] = self._K.diagonal(i) * products
        bands[0] += np.einsum("nj,nj->n", curvature, force)
        gradient = np.einsum("nj,nj->n", slope, force)
        squares = 0.5 * float(np.vdot(off, off))
        return self._with_postures(Derivatives(squares, q, slope, curvature, gradient, bands))

    def compiled_descent(
        self, x: Array, lower: Array, upper: Array, iterations: int, enough: float
    ) -> tuple[Array, float, int] | None:
        """Newton steps in C, as `descent.descend` makes them.

        Args:
            x: Where to begin, inside the bounds, shape (n,), in [rad].
            lower: Least coordinates, shape (n,), in [rad].
            upper: Largest coordinates, shape (n,), in [rad].
            iterations: Most steps.
            enough: Relative improvement below which a step is the last.

        Returns:
            Coordinates at the end, the objective there, steps taken; None without compiled loops.

        Source:
            Bertsekas (1982), doi:10.1137/0320018 (projected Newton).
        """
        if self._library is None or self.smoothness.posture_cost is not None:
            return None
        function = self._library.handle.armik_curve_descend
        function.restype = ctypes.c_int
        at, value = np.array(x, dtype=np.float64), np.zeros(1)
        bounds = [np.ascontiguousarray(bound, dtype=np.float64) for bound in (lower, upper)]
        arrays: list[NDArray[Any]] = [self._chart, at, self._parameters, *self._weights, *bounds]
        room = np.empty(_ROOM * self.n)
        steps = function(
            ctypes.c_ssize_t(self.n),
            *(address(array) for array in arrays),
            ctypes.c_int(iterations),
            ctypes.c_double(enough),
            address(value),
            address(room),
        )
        return at, float(value[0]), int(steps)

    def _of_postures(self, q: Array) -> float:
        cost, share = self.smoothness.posture_cost, self.smoothness.share
        return 0.0 if cost is None or share is None else float(share @ cost.evaluate(q))

    def _with_postures(self, at: Derivatives) -> Derivatives:
        """What single postures cost, added to all derivatives by the chain rule."""
        cost, share = self.smoothness.posture_cost, self.smoothness.share
        if cost is None or share is None:
            return at
        pull = evaluate_rows(cost.gradient, at.q, cost.lengths, cost.parameters)
        second = evaluate_rows(cost.hessian, at.q, cost.lengths, cost.parameters)
        bend = np.einsum("ni,nij,nj->n", at.slope, second.reshape(-1, _JOINTS, _JOINTS), at.slope)
        bands = at.bands.copy()
        bands[0] += share * (bend + np.einsum("nj,nj->n", at.curvature, pull))
        gradient = at.gradient + share * np.einsum("nj,nj->n", at.slope, pull)
        value = at.value + self._of_postures(at.q)
        return Derivatives(value, at.q, at.slope, at.curvature, gradient, bands)

    def _rows(self, name: str, x: Array) -> Array:
        """A function of every sample in NumPy, chart by chart."""
        parts = {}
        for chart in np.unique(self._chart):
            rows = np.flatnonzero(self._chart == chart)
            function = curve_functions()[f"{name}_{chart}"]
            parts[chart] = rows, evaluate_rows(function, x[rows, None], self._parameters[rows])
        out = np.empty((self.n, next(iter(parts.values()))[1].shape[1]))
        for rows, values in parts.values():
            out[rows] = values
        return out

    def _call(self, name: str, x: Array, *outputs: Array) -> float:
        function = getattr(self._library.handle, name)  # type: ignore[union-attr]
        function.restype = ctypes.c_double
        at = np.ascontiguousarray(x)
        arrays: tuple[NDArray[Any], ...] = (self._chart, at, self._parameters, *self._weights, *outputs)
        return float(function(ctypes.c_ssize_t(self.n), *(address(array) for array in arrays)))
