"""Al-Faiz, §3.2, eq. (48)-(50): what the optimisation drives to zero."""

from __future__ import annotations

import sympy as sp

from derivations.alfaiz.chain import Q, frame
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
        "Target minus current, in the base frame. Its derivative is therefore minus the geometric Jacobian: "
        "whoever puts the geometric Jacobian into (55) or (62) steps away from the target.",
        Check(
            lambda: check_sign(printed_residual()),
            printed=(
                Formula(
                    r"e(\theta)",
                    r"\begin{cases} P^d - P(\theta) & \text{position} \\ "
                    r"c\left(R^d R(\theta)^T\right) & \text{orientation} \end{cases}",
                ),
            ),
        ),
        derivation="P^d - P(θ) differentiated symbolically, against the geometric Jacobian built from the "
        "joint axes without differentiation.",
    ),
)
