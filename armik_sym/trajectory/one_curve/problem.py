"""The trajectory problem over one curve, as IPOPT takes it: the swivel angle of every sample is the variable.

    minimise   ½ |S q(ψ) - b|²
    subject to -limit ≤ A q ≤ limit if rates are limited, start_k ≤ ψ_k ≤ end_k as bounds of the variables.

Every point of it tracks the path exactly. Nothing is compiled for a length: CasADi calls back for values.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from armik_sym.trajectory.one_curve.objective import CurveObjective, Derivatives

Array = NDArray[np.float64]

_JOINTS = 7

_Evaluate = Callable[[list[Array], list[Array]], None]


class OneCurveProblem:
    """A nonlinear program over ψ with exact sparse derivatives; attributes as of `FullSpaceProblem`.

    Args:
        objective: Objective and joint angles over ψ.
        rows: A for one joint, shape (m, n); it is repeated for every joint. Constraints are ordered row by
            row of A, the joints of a row together.

    Source:
        None (chain rule: dg/dψ = A·q', d²(λᵀg)/dψ² = diag(q''·Aᵀλ)).
    """

    def __init__(self, objective: CurveObjective, rows: sp.csr_array) -> None:
        n, m = objective.n, _JOINTS * rows.shape[0]
        self._objective, self._rows = objective, rows
        self._at: tuple[Array, Derivatives] | None = None
        self._error: BaseException | None = None
        by_column = sp.csc_array(rows)
        by_column.sort_indices()
        indices = (_JOINTS * by_column.indices[:, None] + np.arange(_JOINTS)).ravel()
        self._spread = np.repeat(by_column.data, _JOINTS)
        self._joint = indices % _JOINTS
        self._column = np.repeat(np.arange(n), _JOINTS * np.diff(by_column.indptr))
        constraints = ca.Sparsity(m, n, (_JOINTS * by_column.indptr).tolist(), indices.tolist())
        bands, self._band_order = _five_bands(n)
        x, p, one = ca.Sparsity.dense(n, 1), ca.Sparsity.dense(0, 1), ca.Sparsity.dense(1, 1)
        g = ca.Sparsity.dense(m, 1)
        self._value = self._called("value", [x], [one, g], self._evaluate)
        self.gradient = self._called("grad_f", [x, p], [one, x], self._evaluate_gradient)
        self.jacobian = self._called("jac_g", [x, p], [g, constraints], self._evaluate_jacobian)
        self.hessian = self._called("hess_lag", [x, p, one, g], [bands], self._evaluate_hessian)
        self.x = ca.MX.sym("psi", n)
        self.f, self.g = self._value(self.x)
        self.scale = objective.smoothness.scale

    def raise_error(self) -> None:
        """Raise what went wrong while CasADi called, which C++ cannot carry; IPOPT has long stopped then.

        Raises:
            BaseException: The first error, as it was.

        Source:
            None (packaging).
        """
        if self._error is not None:
            raise self._error

    def _called(self, name: str, inputs: list[Any], outputs: list[Any], evaluate: _Evaluate) -> ca.Function:
        """A Function that keeps the first error; from then on every evaluation fails at once."""

        def guarded(arguments: list[Array], results: list[Array]) -> bool:
            if self._error is None:
                try:
                    evaluate(arguments, results)
                except BaseException as error:  # noqa: BLE001 - carried through C++, see `raise_error`
                    self._error = error
            return self._error is None

        return _Called(name, inputs, outputs, guarded)

    def _derivatives(self, psi: Array) -> Derivatives:
        """Everything at a point; IPOPT asks for all of it at nearly every point, one after the other."""
        if self._at is None or not np.array_equal(self._at[0], psi):
            self._at = (psi.copy(), self._objective.derivatives(psi))
        return self._at[1]

    def _evaluate(self, inputs: list[Array], outputs: list[Array]) -> None:
        at = self._derivatives(inputs[0])
        outputs[0][0] = at.value
        if self._rows.shape[0]:
            outputs[1][:] = (self._rows @ at.q).ravel()

    def _evaluate_gradient(self, inputs: list[Array], outputs: list[Array]) -> None:
        at = self._derivatives(inputs[0])
        outputs[0][0], outputs[1][:] = at.value, at.gradient

    def _evaluate_jacobian(self, inputs: list[Array], outputs: list[Array]) -> None:
        at = self._derivatives(inputs[0])
        outputs[0][:] = (self._rows @ at.q).ravel()
        outputs[1][:] = self._spread * at.slope[self._column, self._joint]

    def _evaluate_hessian(self, inputs: list[Array], outputs: list[Array]) -> None:
        at = self._derivatives(inputs[0])
        bands = inputs[2][0] * at.bands
        if self._rows.shape[0]:
            pull = self._rows.T @ inputs[3].reshape(-1, _JOINTS)
            bands[0] += np.einsum("nj,nj->n", at.curvature, pull)
        outputs[0][:] = bands.ravel()[self._band_order]


class _Called(ca.Callback):
    """A CasADi Function that calls Python with the arrays themselves, nothing copied."""

    def __init__(
        self,
        name: str,
        inputs: list[Any],
        outputs: list[Any],
        evaluate: Callable[[list[Array], list[Array]], bool],
    ) -> None:
        ca.Callback.__init__(self)
        self._in, self._out, self._evaluate = inputs, outputs, evaluate
        self.construct(name, {})

    def get_n_in(self) -> int:
        return len(self._in)

    def get_n_out(self) -> int:
        return len(self._out)

    def get_sparsity_in(self, i: int) -> Any:
        return self._in[i]

    def get_sparsity_out(self, i: int) -> Any:
        return self._out[i]

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(self, arg: Any, res: Any) -> int:
        # What is empty, and outputs nobody asked for, come as None.
        inputs = [_array(a, pattern) for a, pattern in zip(arg, self._in, strict=True)]
        outputs = [_array(r, pattern) for r, pattern in zip(res, self._out, strict=True)]
        return 0 if self._evaluate(inputs, outputs) else 1


def _array(buffer: Any, pattern: Any) -> Array:
    return np.zeros(pattern.nnz()) if buffer is None else np.frombuffer(buffer, dtype=np.float64)


@functools.lru_cache(maxsize=4)
def _five_bands(n: int) -> tuple[Any, NDArray[np.int64]]:
    """Upper triangle with three bands, and where its entries are in an array (3, n) of bands."""
    row = np.concatenate([np.arange(n - i) for i in range(min(3, n))])
    column = np.concatenate([np.arange(i, n) for i in range(min(3, n))])
    order = np.lexsort((row, column))
    pointers = np.concatenate([[0], np.cumsum(np.bincount(column, minlength=n))])
    places = (column - row) * n + row
    return ca.Sparsity(n, n, pointers.tolist(), row[order].tolist()), places[order]
