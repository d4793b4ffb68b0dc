"""Al-Faiz, §3.2, eq. (48)-(50): what the optimisation drives to zero."""

from __future__ import annotations

import sympy as sp

from derivations.alfaiz.chain import Q, frame
from derivations.alfaiz.facts import Fact, with_facts
from derivations.alfaiz.log_derivative import (
    POSTURES,
    distance_from_minus_geometric,
    inverse_right_jacobian,
    is_derivative,
    is_derivative_of_the_arm,
    leaves_the_residual,
)
from derivations.alfaiz.target_pose import geometric_jacobian
from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.random_points import first_difference, largest_difference

PAPER = "alfaiz"
_ROUNDING = 1e-9

# The target position P^d.
TARGET = sp.Matrix(sp.symbols("P_x P_y P_z", real=True))


def position() -> sp.Matrix:
    """P(θ), the position of the hand.

    Returns:
        SymPy matrix of shape (3, 1).

    Source:
        Al-Faiz, eq. 3, through the chain.
    """
    return sp.Matrix(frame(7)[:3, 3])


def printed_residual() -> sp.Matrix:
    """First line of eq. (50): target minus current position.

    Returns:
        SymPy matrix of shape (3, 1).

    Source:
        Al-Faiz, eq. 50.
    """
    return TARGET - position()


def check_sign(residual: sp.Matrix) -> Evidence:
    """Whether a residual counts from the hand to the target: its derivative is minus the geometric Jacobian.

    Args:
        residual: Position residual, SymPy matrix of shape (3, 1).

    Returns:
        The verdict DEFINITION if so, else FALSE.

    Source:
        Al-Faiz, eq. 50.
    """
    derivative = residual.jacobian(Q)
    expected = -sp.Matrix(geometric_jacobian()[:3, :])
    exact = all(is_exactly_zero(a - b) for a, b in zip(derivative, expected, strict=True))
    if exact and largest_difference(derivative, expected) < _ROUNDING:
        words = (
            "∂e/∂θ = -J for the position, J the geometric Jacobian: 21 entries reduced to zero over the "
            "rationals, and agreeing at 1,000 random points in CasADi"
        )
        return Evidence(Verdict.DEFINITION, words)
    found = first_difference(derivative, expected)
    return Evidence(Verdict.FALSE, "the derivative is not minus the geometric Jacobian", str(found))


_ORIENTATION = (
    Fact(
        "∂c/∂θ = -J_r⁻¹(c) J_ω for the orientation, for every axis, angle and ω (exact), and on the arm at "
        f"{POSTURES} random postures and targets (CasADi); the inverse left Jacobian in its place fails",
        lambda: (
            is_derivative_of_the_arm(inverse_right_jacobian)
            and not is_derivative(lambda c, delta: inverse_right_jacobian(c, delta).T)
        ),
    ),
    Fact(
        "60° off the target, about x at q = (0.3, 0.5, -0.4, 1, 0.2, 0.4, -0.6), ∂c/∂θ and -J_ω differ by up "
        "to "
        "0.52, 1° off by less than 0.01 (CasADi)",
        lambda: (
            round(distance_from_minus_geometric(60), 2) == 0.52 and distance_from_minus_geometric(1) < 0.01
        ),
    ),
    Fact(
        "J_r⁻¹(c) c = J_r⁻ᵀ(c) c = c (exact)",
        lambda: leaves_the_residual(inverse_right_jacobian),
    ),
)

CLAIMS = (
    Claim(
        PAPER,
        "48-49",
        "the constraints",
        Verdict.DEFINITION,
        "Position and rotation of the hand shall be those of the target. The rotation counts for three "
        "conditions, not nine; eq. (50) makes three numbers of it.",
        definition=(Formula(r"p(\theta)", "p^d"), Formula(r"R(\theta)", "R^d")),
    ),
    Claim(
        PAPER,
        "50",
        "the residual",
        Verdict.DEFINITION,
        "Target minus current, in the base frame. Its derivative is minus the geometric Jacobian for the "
        "position; for the orientation, with (51) and (53) corrected, it is -J_r⁻¹(c) J_ω, equal to -J_ω "
        "only "
        "at c = 0. So whoever puts the geometric Jacobian into (55) or (62) steps away from the target. With "
        "a "
        "plus, (55) and the gradient (61) are the same for both, as J_r⁻¹(c) c = c; JᵀJ in (60), (62) is "
        "not.",
        Check(
            lambda: with_facts(check_sign(printed_residual()), _ORIENTATION),
            printed=(
                Formula(
                    r"e(\theta)",
                    r"\begin{cases} P^d - P(\theta) & \text{position} \\ "
                    r"c\left(R^d R(\theta)^T\right) & \text{orientation} \end{cases}",
                ),
            ),
        ),
        derivation="P^d - P(θ) differentiated symbolically, against the geometric Jacobian built from the "
        "joint axes without differentiation. J_r⁻¹(c) = I + [c]×/2 + (1/δ² - (1 + cos δ)/(2 δ sin δ)) [c]×², "
        "δ = ‖c‖, is the inverse right Jacobian of SO(3): (R^d Rᵀ)' = -R^d Rᵀ [ω]×, from the right.",
    ),
)
