"""Al-Faiz, §5, eq. (58)-(62): least squares and the damped step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import sympy as sp

from derivations.alfaiz.chain import Q
from derivations.alfaiz.facts import Fact, with_facts
from derivations.alfaiz.residuals import TARGET, position, printed_residual
from derivations.alfaiz.target_pose import hand
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.identity import Identity

PAPER = "alfaiz"
_POINTS = 1_000
_JOINTS = Q[:4]  # the position does not depend on the others

# A step from J, e, the damping and the inverse to use; for SymPy and CasADi matrices.
Step = Callable[[Any, Any, Any, Callable[[Any], Any]], Any]


def identity_like(matrix: Any) -> Any:
    """The identity of the size of a square matrix.

    Args:
        matrix: SymPy or CasADi matrix.

    Returns:
        Identity matrix of the same kind.

    Source:
        None (bookkeeping).
    """
    n = matrix.shape[0]
    return sp.eye(n) if isinstance(matrix, sp.MatrixBase) else ca.SX.eye(n)


def printed_step(J: Any, e: Any, mu: Any, inverse: Callable[[Any], Any]) -> Any:
    """Eq. (62) as printed: θ_(k+1) - θ_k.

    Args:
        J: Jacobian of the residual, SymPy or CasADi matrix.
        e: Residual.
        mu: Damping.
        inverse: Inverse of a matrix of that kind.

    Returns:
        The step.

    Source:
        Al-Faiz, eq. 62.
    """
    H = J.T @ J
    return -inverse(H + mu * identity_like(H)) @ J.T @ e


def normal_equations(e: sp.Matrix, factor: int = 1) -> sp.Matrix:
    """Eq. (60)-(61) for a residual: the matrix [H g].

    Args:
        e: Residual, a function of the first four joint angles.
        factor: What both are multiplied with; 1 as printed.

    Returns:
        SymPy matrix of shape (4, 5).

    Source:
        Al-Faiz, eq. 60-61.
    """
    J = e.jacobian(_JOINTS)
    return sp.Matrix(factor * sp.Matrix.hstack(J.T * J, J.T * e))


def second_and_first_derivatives(e: sp.Matrix) -> sp.Matrix:
    """Hessian (at the target) and gradient of E = eᵀe, differentiated without J.

    Args:
        e: Residual, a function of the first four joint angles.

    Returns:
        SymPy matrix of shape (4, 5).

    Source:
        Al-Faiz, eq. 59.
    """
    E = e.dot(e)
    gradient = sp.Matrix([E.diff(q) for q in _JOINTS])
    at_the_target = dict(zip(TARGET, position(), strict=True))
    return sp.Matrix.hstack(gradient.jacobian(_JOINTS).subs(at_the_target, simultaneous=True), gradient)


def check_derivatives(form: Callable[[sp.Matrix, int], sp.Matrix]) -> Evidence:
    """Whether H and g are second and first derivative of E, with the factor 1 or with the factor 2.

    Args:
        form: [H g] for a residual and a factor.

    Returns:
        HOLDS with the factor 1, CORRECTED with the factor 2, else FALSE.

    Source:
        Al-Faiz, eq. 59-61.
    """
    e = printed_residual()
    true = second_and_first_derivatives(e)
    evidence = Identity(form(e, 1), true, form(e, 2)).check()
    what = "; J = ∂e/∂θ of the position residual, H compared where e = 0, g everywhere"
    return replace(evidence, proof=evidence.proof + what, counterexample=_smallest_example(form))


def _smallest_example(form: Callable[[sp.Matrix, int], sp.Matrix]) -> str:
    """One joint: e = 1 - θ1 at θ1 = 0."""
    theta = _JOINTS[0]
    e = sp.Matrix([1 - theta])
    H, g = (entry.subs(theta, 0) for entry in (form(e, 1)[0, 0], form(e, 1)[0, len(_JOINTS)]))
    E = e.dot(e)
    true = [E.diff(theta, n).subs(theta, 0) for n in (1, 2)]
    if [g, H] == true:
        return ""
    slopes = f"E = (1 - θ)² has slope {true[0]} and curvature {true[1]}"
    return f"e = 1 - θ at θ = 0: {slopes}, printed g = {g}, H = {H}"


def is_damped_minimum(step: Step) -> bool:
    """Whether a step is the minimum of |e + J δ|² + μ |δ|², for every 2 x 2 Jacobian.

    Args:
        step: The step.

    Returns:
        True if the derivative with respect to δ vanishes there, exactly.

    Source:
        Al-Faiz, eq. 62.
    """
    J = sp.Matrix(2, 2, sp.symbols("J_11 J_12 J_21 J_22"))
    e, mu = sp.Matrix(sp.symbols("e_1 e_2")), sp.Symbol("mu")
    delta = step(J, e, mu, lambda matrix: matrix.inv())
    slope = J.T * (e + J * delta) + mu * delta
    return all(is_exactly_zero(entry) for entry in slope)


def descent(step: Step, sign_of_J: int = 1) -> np.ndarray:
    """Slope of E along a step, for random postures and targets of the arm, through CasADi.

    Args:
        step: The step.
        sign_of_J: 1 for J = ∂e/∂θ, -1 for J = ∂F/∂θ, the geometric Jacobian.

    Returns:
        ∂E/∂θ · δ, shape (n,); negative if E falls.

    Source:
        Al-Faiz, eq. 58-62.
    """
    q, target = ca.SX.sym("q", 7), ca.SX.sym("p", 3)
    p, _, _ = hand()(q)
    e = target - p
    delta = step(sign_of_J * ca.jacobian(e, q), e, 0.1, lambda matrix: ca.inv(matrix))
    slope = ca.Function("slope", [q, target], [ca.jacobian(ca.dot(e, e), q) @ delta])
    rng = np.random.default_rng(0)
    values = slope(rng.uniform(-np.pi, np.pi, (7, _POINTS)), rng.uniform(-0.5, 0.5, (3, _POINTS)))
    return np.asarray(values).ravel()


def check_step(step: Step) -> Evidence:
    """Whether a damped step is the right one and leads downhill.

    Args:
        step: The step.

    Returns:
        HOLDS if so, else FALSE.

    Source:
        Al-Faiz, eq. 62.
    """
    if not (is_damped_minimum(step) and (descent(step) < 0).all()):
        return Evidence(Verdict.FALSE, "not the damped least-squares step", "it does not lead downhill")
    words = (
        "for every 2 x 2 Jacobian the step is where the derivative of |e + J δ|² + μ |δ|² vanishes (exact); "
        f"it leads downhill at {_POINTS:,} random postures and targets of the arm (CasADi)"
    )
    facts = (
        Fact(
            "with J = ∂F/∂θ, the geometric Jacobian, it leads uphill at all of them",
            lambda: bool((descent(step, -1) > 0).all()),
        ),
    )
    return with_facts(Evidence(Verdict.HOLDS, words), facts)


CLAIMS = (
    Claim(
        PAPER,
        "58-59",
        "error and squared error",
        Verdict.DEFINITION,
        "Target minus current, as in (50). The square of a vector in (59) is to be read as a sum of squares.",
        definition=(
            Formula(r"e(\theta)", r"d_T - F(\theta)"),
            Formula(r"E(\theta)", r"(d_T - F(\theta))^2"),
        ),
    ),
    Claim(
        PAPER,
        "60-61",
        "Hessian and gradient",
        Verdict.CORRECTED,
        "Both are those of E/2; for E of (59) a factor 2 is missing. Harmless in (62), where it cancels, but "
        "a gradient compared with finite differences of E, or handed to another optimiser, is half of "
        "what it should be. H is exact only where e = 0 (or F is linear). J = ∂e/∂θ.",
        Check(
            lambda: check_derivatives(normal_equations),
            printed=(Formula("H", "J^T J"), Formula("g", "J^T e")),
            corrected=(Formula("H", "2 J^T J", r"\approx"), Formula("g", "2 J^T e")),
        ),
        derivation="E = eᵀe of the arm, differentiated: ∇E = 2 Jᵀe, ∇²E = 2 JᵀJ + 2 Σ e_i ∇²e_i.",
        correction="factor 2 in both, or E = eᵀe/2",
        fault=Fault.WORDING,
    ),
    Claim(
        PAPER,
        "62",
        "damped least-squares step",
        Verdict.HOLDS,
        "Right with J = ∂e/∂θ, as the text says (derivatives of the errors); with the geometric Jacobian of "
        "the arm the minus must become a plus. μ = 0 is Gauss-Newton, and for seven joints and six "
        "residuals not possible, as JᵀJ is then singular. The error falls in every iteration only if a step "
        "that fails is undone before μ is raised.",
        Check(
            lambda: check_step(printed_step),
            printed=(Formula(r"\theta_{k+1}", r"\theta_k - [J^T J + \mu I]^{-1} J^T e"),),
        ),
        derivation="Minimise |e + J δ|² + μ |δ|² over δ.",
    ),
)
