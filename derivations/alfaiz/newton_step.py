"""Al-Faiz, §3.2, eq. (54)-(57): the Newton step and what is minimised."""

from __future__ import annotations

import functools
from collections.abc import Callable

import casadi as ca
import numpy as np
import sympy as sp

from armik_sym.arm.catalog import alfaiz
from armik_sym.symbolic.orientation import vee_of_difference
from derivations.alfaiz.facts import Fact, with_facts
from derivations.alfaiz.target_pose import hand
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero

PAPER = "alfaiz"
_TARGETS = 200
_OFF = 0.01  # [rad], how far the joints are from a posture that solves the target
_LEFT_OVER = 0.1  # share of the residual a Newton step may leave
_SINGULAR = 0.05  # smallest singular value of the Jacobian, in [m] and [1]
_MILLIMETRE = 1e-3

Step = Callable[[np.ndarray, np.ndarray], np.ndarray]


def printed_step(J: np.ndarray, e: np.ndarray) -> np.ndarray:
    """Eq. (55) as printed.

    Args:
        J: Jacobian of the residual.
        e: Residual.

    Returns:
        The change of the joint angles.

    Raises:
        LinAlgError: If J has no inverse.

    Source:
        Al-Faiz, eq. 55.
    """
    return -np.linalg.inv(J) @ e


def corrected_step(J: np.ndarray, e: np.ndarray) -> np.ndarray:
    """Eq. (55) with the pseudo-inverse, the shortest step that solves J δ = -e.

    Args:
        J: Jacobian of the residual.
        e: Residual.

    Returns:
        The change of the joint angles.

    Source:
        Siciliano et al., Robotics (2009), eq. 3.52.
    """
    return -np.linalg.pinv(J) @ e


@functools.cache
def residual() -> ca.Function:
    """Eq. (50) for position and orientation, the latter with (51) and (53) corrected, and its derivative.

    Returns:
        Function (q, P^d, R^d) → e (6, 1), ∂e/∂q (6, 7), geometric Jacobian (6, 7).

    Source:
        Al-Faiz, eq. 50 and 56, through `armik_sym.symbolic`.
    """
    q, p_target, R_target = ca.SX.sym("q", 7), ca.SX.sym("p", 3), ca.SX.sym("R", 3, 3)
    p, R, J = hand()(q)
    RT = R_target @ R.T
    l = vee_of_difference(RT)
    length = ca.norm_2(l)
    e = ca.vertcat(p_target - p, ca.atan2(length, ca.trace(RT) - 1) / length * l)
    return ca.Function("residual", [q, p_target, R_target], [e, ca.jacobian(e, q), J])


def converges(step: Step, geometric: bool = False) -> bool:
    """Whether one step from near the target leaves little of the residual.

    Args:
        step: From Jacobian and residual to the change of the joint angles.
        geometric: Whether it gets the geometric Jacobian instead of ∂e/∂q.

    Returns:
        True if every step from a random posture, no singular one, leaves less than a tenth of the residual;
        False too if a step cannot be computed.

    Source:
        Al-Faiz, eq. 54-56.
    """
    rng = np.random.default_rng(0)
    for solution in alfaiz().rom.random_postures(rng, _TARGETS):
        q = solution + rng.uniform(-_OFF, _OFF, 7)
        p, R, _ = hand()(solution)
        e, J, J_geometric = (np.array(value) for value in residual()(q, p, R))
        if np.linalg.svd(J, compute_uv=False)[-1] < _SINGULAR:
            continue
        try:
            moved = q + step(J_geometric if geometric else J, e.ravel()).ravel()
        except np.linalg.LinAlgError:
            return False
        after = np.array(residual()(moved, p, R)[0])
        if not np.linalg.norm(after) < _LEFT_OVER * np.linalg.norm(e):
            return False
    return True


def check_step(printed: Step, corrected: Step) -> Evidence:
    """A Newton step as printed, or else as corrected, on the arm.

    Args:
        printed: The printed step.
        corrected: The corrected one.

    Returns:
        HOLDS if the printed step converges, else CORRECTED if the corrected one does, else FALSE.

    Source:
        Al-Faiz, eq. 54-56.
    """
    words = (
        "one step leaves less than a tenth of the residual for all of "
        f"{_TARGETS} random targets but those near a singular posture (CasADi)"
    )
    if converges(printed):
        return Evidence(Verdict.HOLDS, words)
    rows, columns = residual().size_out(1)
    counterexample = f"in every posture: ∇e has {rows} rows and {columns} columns, and no inverse"
    verdict = Verdict.CORRECTED if converges(corrected) else Verdict.FALSE
    facts = (
        Fact(
            "with the geometric Jacobian for J the sign must be plus: with the minus it does not converge",
            lambda: (
                converges(lambda J, e: -corrected(J, e), geometric=True)
                and not converges(corrected, geometric=True)
            ),
        ),
    )
    return with_facts(Evidence(verdict, f"Corrected form: {words}", counterexample), facts)


def after_one_step(component: Callable[[float], float]) -> float:
    """Distance to a target that was 10 mm away, after one step with the geometric Jacobian.

    Args:
        component: What is made of each coordinate of P^d - P.

    Returns:
        The distance after the step q + J_v⁺ e, in [mm].

    Source:
        Al-Faiz, eq. 55 and 57.
    """
    q = np.array([0.3, 0.5, -0.4, 1.0, 0.2, 0.4, -0.6])
    p, _, J = (np.array(value) for value in hand()(q))
    off = np.array([-10.0, 0.0, 0.0]) * _MILLIMETRE
    e = np.array([component(x) for x in off])
    reached = np.array(hand()(q + np.linalg.pinv(J[:3]) @ e)[0])
    return float(np.linalg.norm(p + off[:, None] - reached) / _MILLIMETRE)


def check_minimised(component: Callable[[sp.Expr], sp.Expr]) -> Evidence:
    """What can be said about eq. (57) although `a` is not defined.

    Args:
        component: What stands for each coordinate of P^d - P, as printed the absolute value.

    Returns:
        NOT_CHECKABLE if the sum of squares is that of P^d - P, and the absolute value changes no step that
        uses its own derivative; else FALSE.

    Source:
        Al-Faiz, eq. 57.
    """
    x = sp.Symbol("x", real=True)
    same = all(sp.simplify((component(s) ** 2 - s**2).subs(x, s)) == 0 for s in (x, -x))
    if not (same and _signs_cancel(component)):
        return Evidence(Verdict.FALSE, "not the sum of squares of the position error")
    facts = (
        Fact(
            "JᵀJ and Jᵀe are the same with and without absolute values, whatever the signs (exact)",
            lambda: _signs_cancel(component),
        ),
        Fact(
            "at zero the derivative of |x| jumps from -1 to 1",
            lambda: {sp.limit(component(x) / x, x, 0, side) for side in "+-"} == {sp.Integer(1), -1},
        ),
        Fact(
            "with the geometric Jacobian a target 10 mm towards -x at "
            "q = (0.3, 0.5, -0.4, 1, 0.2, 0.4, -0.6) is 20 mm away after one step, and below 1 mm "
            "without absolute values (CasADi)",
            lambda: abs(after_one_step(abs) - 20) < 1 and after_one_step(float) < 1,
        ),
    )
    return with_facts(Evidence(Verdict.NOT_CHECKABLE, "the fourth entry, a, is not defined"), facts)


def _signs_cancel(component: Callable[[sp.Expr], sp.Expr]) -> bool:
    """One coordinate: its derivative times itself, and its derivative squared, for either sign."""
    t = sp.Symbol("t", positive=True)
    for sign in (1, -1):
        value = component(sign * t)
        slope = sign * sp.diff(value, t)
        if not is_exactly_zero(slope * value - sign * t) or not is_exactly_zero(slope**2 - 1):
            return False
    return True


CLAIMS = (
    Claim(
        PAPER,
        "54",
        "the equation to solve",
        Verdict.DEFINITION,
        "All residuals are to be zero.",
        definition=(Formula(r"e(\theta)", "0"),),
    ),
    Claim(
        PAPER,
        "55-56",
        "Newton step",
        Verdict.CORRECTED,
        "Right for as many joints as residuals. The arm has seven joints and six residuals (and one unknown "
        "if φ alone is varied), so ∇e has no inverse; the pseudo-inverse takes its place. J must be "
        "the derivative of e = target - current; with the geometric Jacobian the step needs a plus.",
        Check(
            lambda: check_step(printed_step, corrected_step),
            printed=(
                Formula(r"q^{k+1}", r"q^k - J^{-1} e(\theta^k)"),
                Formula("J", r"\nabla e(\theta^k)"),
            ),
            corrected=(Formula(r"q^{k+1}", r"q^k - J^{+} e(\theta^k)"),),
        ),
        derivation="e(q + δ) ≈ e + J δ = 0. With more joints than residuals many δ solve this, J⁺ gives the "
        "shortest. J from CasADi, differentiating (50) with (51) and (53) corrected.",
        correction="J⁺ instead of J⁻¹",
        fault=Fault.MODEL,
    ),
    Claim(
        PAPER,
        "57",
        "what is minimised",
        Verdict.NOT_CHECKABLE,
        "A vector has no minimum; its length must be meant. Its fourth entry a is never defined, presumably "
        "an orientation error. The absolute values change nothing in the sum of squares, and harm: "
        "their derivative jumps where the error is zero, the very point that is sought, which spoils finite "
        "differences; and a geometric Jacobian has the wrong sign for every negative component. Omit them.",
        Check(
            lambda: check_minimised(sp.Abs),
            printed=(
                Formula(
                    r"e(\theta_1, \dots, \theta_7)",
                    r"\begin{bmatrix} |P_x^d - dx| \\ |P_y^d - dy| \\ |P_z^d - dz| \\ a \end{bmatrix}",
                ),
            ),
        ),
        derivation="d|x|/dx · |x| = x and (d|x|/dx)² = 1 for every x ≠ 0, so a least-squares step that "
        "differentiates the absolute values correctly is the step without them.",
    ),
)
