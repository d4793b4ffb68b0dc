"""Al-Faiz, §5, eq. (63): the damped step through a singular value decomposition."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from sympy import cos, sin

from armik_sym.arm.catalog import alfaiz
from derivations.alfaiz.facts import Fact, with_facts
from derivations.alfaiz.levenberg_marquardt import PAPER, printed_step
from derivations.alfaiz.target_pose import hand
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.random_points import largest_difference

_ROUNDING = 1e-9
_POSTURES = 100
_DAMPING = 0.1

_a, _b, _c, _d = sp.symbols("a b c d", real=True)
_s1, _s2 = sp.symbols("s1 s2", positive=True)
_k = sp.Symbol("k", positive=True)  # λ + c


@dataclass(frozen=True)
class SvdStep:
    """A step -B⁻¹ M e through J = U S Vᵀ; for SymPy matrices and NumPy arrays.

    Attributes:
        bracket: B from S, V and λ + c.
        behind: M, what stands before e, from U, S and V.
    """

    bracket: Callable[[Any, Any, Any], Any]
    behind: Callable[[Any, Any, Any], Any]

    def __call__(self, U: Any, S: Any, V: Any, e: Any, k: Any) -> Any:
        """θ_(k+1) - θ_k."""
        return -_inverse(self.bracket(S, V, k)) @ self.behind(U, S, V) @ e


def printed_bracket(S: Any, V: Any, k: Any) -> Any:
    """The bracket of eq. (63) before it is inverted.

    Args:
        S: Singular values, of the shape of J.
        V: Right singular vectors.
        k: λ + c.

    Returns:
        V [SᵀS + k I] Vᵀ.

    Source:
        Al-Faiz, eq. 63.
    """
    n = V.shape[0]
    eye = sp.eye(n) if isinstance(V, sp.MatrixBase) else np.eye(n)
    return V @ (S.T @ S + k * eye) @ V.T


def _inverse(matrix: Any) -> Any:
    return matrix.inv() if isinstance(matrix, sp.MatrixBase) else np.linalg.inv(matrix)


PRINTED = SvdStep(printed_bracket, lambda _U, _S, V: V.T)
CORRECTED = SvdStep(printed_bracket, lambda U, S, V: V @ S.T @ U.T)


def _turn(angle: sp.Symbol, axis: int = 2) -> sp.Matrix:
    """Rotation in the plane across an axis, 3 x 3."""
    R = sp.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = cos(angle)
    R[i, j], R[j, i] = -sin(angle), sin(angle)
    return R


def _decompositions() -> list[tuple[sp.Matrix, sp.Matrix, sp.Matrix]]:
    """U, S, V of every 2 x 2 and every 2 x 3 matrix but for signs of singular vectors."""
    U, V = sp.Matrix(_turn(_a)[:2, :2]), sp.Matrix(_turn(_b)[:2, :2])
    V_3 = sp.Matrix(_turn(_b) * _turn(_c, axis=0) * _turn(_d))
    return [(U, sp.diag(_s1, _s2), V), (U, sp.Matrix([[_s1, 0, 0], [0, _s2, 0]]), V_3)]


def _same(left: sp.Matrix, right: sp.Matrix) -> bool:
    if left.shape != right.shape or not all(is_exactly_zero(a - b) for a, b in zip(left, right, strict=True)):
        return False
    return largest_difference(left, right) < _ROUNDING


def bracket_is_right(step: SvdStep) -> bool:
    """Whether the bracket of a step is JᵀJ + (λ + c) I, for 2 x 2 and 2 x 3 Jacobians.

    Args:
        step: The step.

    Returns:
        True if so, exactly and at 1,000 random points in CasADi.

    Source:
        Al-Faiz, eq. 62-63.
    """
    return all(
        _same(step.bracket(S, V, _k), V * S.T * U.T * U * S * V.T + _k * sp.eye(len(V[0, :])))
        for U, S, V in _decompositions()
    )


def is_step_of_62(step: SvdStep) -> bool:
    """Whether a step is eq. (62) with μ = λ + c, for 2 x 2 and 2 x 3 Jacobians.

    Args:
        step: The step.

    Returns:
        True if its bracket is JᵀJ + μ I and what stands behind it is Jᵀ, exactly and in CasADi.

    Source:
        Al-Faiz, eq. 62-63.
    """
    transposed = all(_same(step.behind(U, S, V), (U * S * V.T).T) for U, S, V in _decompositions())
    return transposed and bracket_is_right(step)


def under_choice_of_signs(step: SvdStep) -> int:
    """What becomes of a step when all singular vectors change sign; J = U S Vᵀ stays the same.

    Args:
        step: The step.

    Returns:
        1 if it stays the same, -1 if it changes sign, 0 otherwise; exactly, for 2 x 2 Jacobians.

    Source:
        None (J = (-U) S (-V)ᵀ).
    """
    U, S, V = _decompositions()[0]
    if not _same(step.bracket(S, V, _k), step.bracket(S, -V, _k)):
        return 0
    before, after = step.behind(U, S, V), step.behind(-U, S, -V)
    return int(_same(after, before)) - int(_same(after, -before))


def fits_the_arm(step: SvdStep) -> bool:
    """Whether a step can be computed for the arm's Jacobian, and is that of eq. (62).

    Args:
        step: The step.

    Returns:
        False if the matrices do not fit each other or the step differs at a random posture.

    Source:
        Al-Faiz, eq. 62-63; Jacobian through CasADi.
    """
    rng = np.random.default_rng(0)
    for q in alfaiz().rom.random_postures(rng, _POSTURES):
        J, e = -np.array(hand()(q)[2]), rng.uniform(-1, 1, 6)
        U, values, Vt = np.linalg.svd(J)
        S = np.zeros(J.shape)
        np.fill_diagonal(S, values)
        try:
            delta = step(U, S, Vt.T, e, _DAMPING)
        except ValueError:
            return False
        right = -np.linalg.solve(J.T @ J + _DAMPING * np.eye(7), J.T @ e)
        if not np.abs(delta - right).max() < _ROUNDING:
            return False
    return True


def check_step(printed: SvdStep, corrected: SvdStep) -> Evidence:
    """A step through the singular value decomposition, as printed or else as corrected.

    Args:
        printed: The printed step.
        corrected: The corrected one.

    Returns:
        HOLDS if the printed step is that of eq. (62), else CORRECTED if the corrected one is, else FALSE.

    Source:
        Al-Faiz, eq. 62-63.
    """
    words = (
        "the step is (62) with μ = λ + c: exactly for J = U S Vᵀ, 2 x 2 and 2 x 3 with any rotations U "
        f"and V, and for the 6 x 7 Jacobian at {_POSTURES} random postures (CasADi)"
    )
    right = {step: is_step_of_62(step) and fits_the_arm(step) for step in (printed, corrected)}
    if right[printed]:
        return Evidence(Verdict.HOLDS, words)
    facts = (
        Fact("the bracket is JᵀJ + (λ + c) I (exact)", lambda: bracket_is_right(printed)),
        Fact(
            "the printed step changes sign with (U, V), the corrected one does not (exact)",
            lambda: (under_choice_of_signs(printed), under_choice_of_signs(corrected)) == (-1, 1),
        ),
        Fact(
            "for the 6 x 7 Jacobian of the arm the printed product Vᵀe, 7 x 7 times 6, does not exist",
            lambda: not fits_the_arm(printed),
        ),
    )
    verdict = Verdict.CORRECTED if right[corrected] else Verdict.FALSE
    return with_facts(Evidence(verdict, f"Corrected form: {words}", _uphill(printed)), facts)


def _uphill(step: SvdStep) -> str:
    """One joint and e = 1 - θ at θ = 0, so that J = -1 = U S Vᵀ with U = -1, S = 1, V = 1; λ + c = 1."""
    one = sp.eye(1)
    theta = step(-one, one, one, one, 1)[0]
    right = printed_step(-one, one, 1, _inverse)[0]
    return (
        "e = 1 - θ at θ = 0, so J = -1 = U S Vᵀ with U = -1, S = V = 1, and λ + c = 1: printed "
        f"θ = {theta}, which takes e from 1 to {1 - theta}; (62) gives θ = {right}"
    )


CLAIMS = (
    Claim(
        PAPER,
        "63",
        "the damped step through singular values",
        Verdict.CORRECTED,
        "The bracket is right: JᵀJ + (λ + c) I, with λ for the μ of (62). Behind it Vᵀ stands where Jᵀ must; "
        "for the arm Vᵀe has no meaning (7 x 7 times 6), and with as many residuals as joints the "
        "step's direction depends on the signs an SVD routine happens to choose.",
        Check(
            lambda: check_step(PRINTED, CORRECTED),
            printed=(
                Formula(
                    r"\theta_{k+1}", r"\theta_k - \left[V [S^T S + (\lambda + c) I] V^T\right]^{-1} V^T e"
                ),
            ),
            corrected=(
                Formula(
                    r"\theta_{k+1}",
                    r"\theta_k - \left[V [S^T S + (\lambda + c) I] V^T\right]^{-1} V S^T U^T e = "
                    r"\theta_k - V [S^T S + (\lambda + c) I]^{-1} S^T U^T e",
                ),
            ),
        ),
        derivation="J = U S Vᵀ put into (62): JᵀJ = V SᵀS Vᵀ, Jᵀ = V Sᵀ Uᵀ, VᵀV = I.",
        correction="Jᵀ = V Sᵀ Uᵀ instead of the last Vᵀ; the inverse is then one of a diagonal matrix",
        fault=Fault.MISPRINT,
    ),
)
