"""Al-Faiz, §3.2, eq. (51)-(53): the orientation residual as an axis-angle vector."""

from __future__ import annotations

import numpy as np
import sympy as sp
from sympy import atan, atan2, cos, pi, sin

from derivations.alfaiz.axis_angle import (
    MIRROR,
    MIRROR_NORMAL,
    corrected_l,
    difference_rotation,
    growth,
    is_mirrored,
    printed_l,
    vanishes,
)
from derivations.alfaiz.chain import Q
from derivations.alfaiz.facts import BranchWithFacts, Fact, IdentityWithFacts
from derivations.alfaiz.target_pose import (
    TURN,
    current_rotation,
    target_rotation,
    turn_axis,
)
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.random_points import largest_difference

PAPER = "alfaiz"
_ROUNDING = 1e-9
_TENTH = 0.1
_AXES = 4_000
_SAMPLING = 0.03


def check_difference_rotation(RT: sp.Matrix) -> Evidence:
    """Whether a matrix turns the hand to the target about an axis given in the base frame.

    Args:
        RT: SymPy matrix of shape (3, 3).

    Returns:
        The verdict DEFINITION if it is a rotation that leaves the axis of the turn as it is, and carries R(θ)
        to R^d; else FALSE.

    Source:
        Al-Faiz, eq. 52.
    """
    exact = (
        vanishes(RT.T * RT - sp.eye(3))
        and vanishes(RT * turn_axis() - turn_axis())
        and vanishes(RT * current_rotation() - target_rotation())
    )
    if exact and largest_difference(RT * turn_axis(), turn_axis()) < _ROUNDING:
        words = "a rotation, its axis that of the turn in the base frame, reduced to zero over the rationals"
        return Evidence(Verdict.DEFINITION, words)
    return Evidence(Verdict.FALSE, "not the rotation to the target in the base frame")


def _doubles() -> bool:
    wrong, right = growth(printed_l, 0), growth(corrected_l, 0)
    return abs(wrong - 2) < _TENTH and right < _TENTH


def _away_within_60_degrees() -> bool:
    """A misalignment e becomes e - P e = 2 n (n·e): longer if, and only if, 2 |n·e| > |e|."""
    n, e = MIRROR_NORMAL, sp.Matrix(sp.symbols("e1:4"))
    exact = vanishes(e - MIRROR * e - 2 * n * n.dot(e))
    on_the_arm = all(abs(growth(printed_l, t) - 2 * np.cos(np.deg2rad(t))) < _TENTH for t in (0, 45, 75, 90))
    axes = np.random.default_rng(0).normal(size=(_AXES, 3))
    share = np.mean(np.abs(axes @ np.array(n, dtype=float)).ravel() > np.linalg.norm(axes, axis=1) / 2)
    return exact and on_the_arm and abs(share - 0.5) < _SAMPLING


def _length_and_trace() -> bool:
    RT = difference_rotation()
    l = corrected_l(RT)
    return is_exactly_zero(l.dot(l) - 4 * sin(TURN) ** 2) and is_exactly_zero(RT.trace() - 1 - 2 * cos(TURN))


def _half_turn_looks_solved() -> bool:
    RT = difference_rotation().subs(TURN, pi)
    return not vanishes(RT - sp.eye(3)) and vanishes(corrected_l(RT)) and vanishes(printed_l(RT))


def _half_turn_has_its_axis() -> bool:
    a = turn_axis()
    return vanishes(difference_rotation().subs(TURN, pi) + sp.eye(3) - 2 * a * a.T)


def printed_angle(length: sp.Expr, trace: sp.Expr) -> sp.Expr:
    """The length of c in eq. (51) as printed.

    Args:
        length: ‖l‖.
        trace: r11 + r22 + r33.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 51.
    """
    return atan(length / (trace - 1))


def _quarter_turn_about_x() -> str:
    """Eq. (53) in its own inputs: joint 3 turned by 90° where its axis is the base's x axis."""
    at = {TURN: pi / 2, Q[0]: pi, Q[1]: 0}
    RT = sp.Matrix(difference_rotation().subs(at))
    true = sp.Matrix((2 * sin(TURN) * turn_axis()).subs(at))
    entries = ((1, 2), (2, 1), (1, 3), (3, 1), (2, 3), (3, 2))
    inputs = ", ".join(f"r{i}{j} = {RT[i - 1, j - 1]}" for i, j in entries)
    return f"quarter turn about x ({inputs}): printed {tuple(printed_l(RT))}, true {tuple(true)}"


_LENGTH, _TRACE = 2 * sin(TURN), 1 + 2 * cos(TURN)

CLAIMS = (
    Claim(
        PAPER,
        "51",
        "axis-angle vector of a rotation",
        Verdict.CORRECTED,
        "The plain arc tangent is right for a misalignment δ below 90° only. Beyond, it returns δ - 180°: "
        "the residual points away from the target, shrinks as the hand turns further off and is zero at half "
        "a turn, where an optimiser may stop and report success. At δ = 0 and δ = 180° it is 0/0. The "
        "derivative of the corrected "
        "c is not minus the geometric Jacobian, see (50).",
        BranchWithFacts(
            "c(RT)",
            printed_angle(_LENGTH, _TRACE),
            TURN,
            {TURN: (sp.Integer(0), pi)},
            printed_domain={TURN: (sp.Integer(0), pi / 2)},
            corrected=atan2(_LENGTH, _TRACE - 1),
            printed_text=r"\left[\frac{1}{\lVert l\rVert} "
            r"\tan^{-1}\frac{\lVert l\rVert}{r_{11}+r_{22}+r_{33}-1}\right] l",
            corrected_text=r"\frac{\mathrm{atan2}\left(\lVert l\rVert,\ r_{11}+r_{22}+r_{33}-1\right)}"
            r"{\lVert l\rVert}\, l",
            inputs={"‖l‖": _LENGTH, "r11 + r22 + r33": _TRACE},
            example={TURN: 2 * pi / 3},
            facts=(
                Fact("‖l‖² = 4 sin²δ and trace - 1 = 2 cos δ (exact)", _length_and_trace),
                Fact(
                    "the factor before l tends to 1/2 as δ tends to 0",
                    lambda: sp.limit(printed_angle(_LENGTH, _TRACE) / _LENGTH, TURN, 0, "+") == sp.S.Half,
                ),
                Fact("at δ = 180° l = 0 for every axis although RT ≠ I (exact)", _half_turn_looks_solved),
                Fact(
                    "there RT + I = 2 a aᵀ still holds the axis a (exact)",
                    _half_turn_has_its_axis,
                ),
            ),
        ),
        derivation="RT is taken between two postures of the arm that differ by δ in joint 3, so its angle is "
        "δ, and c must have the length δ. ‖l‖ and trace - 1 are sine and cosine of δ, each doubled.",
        fault=Fault.BRANCH,
        correction="atan2(‖l‖, trace - 1) instead of the arc tangent of the quotient; c = l/2 for δ → 0, and "
        "for l = 0 with trace = -1 the axis from the columns of RT + I",
    ),
    Claim(
        PAPER,
        "52",
        "rotation from the hand to the target",
        Verdict.DEFINITION,
        "R^d Rᵀ, in this order, has its axis in the base frame and belongs to the Jacobian in the base "
        "frame. The arguments q and θ mean the same.",
        Check(
            lambda: check_difference_rotation(difference_rotation()),
            printed=(Formula("RT", r"R^d R^T(\theta)"),),
        ),
        derivation="Two postures of the arm that differ by δ in joint 3.",
    ),
    Claim(
        PAPER,
        "53",
        "direction of the axis-angle vector",
        Verdict.CORRECTED,
        "The three differences stand in the order z, y, x, and the first and last have the wrong sign: the "
        "printed vector is the right one reflected at the plane x + z = 0. Its length is right, so tests of "
        "convergence work, and with J differentiated from this very residual the reflection cancels. With "
        "the geometric Jacobian every iteration doubles the misalignment about (1, 0, 1).",
        IdentityWithFacts(
            printed_l(difference_rotation()),
            2 * sin(TURN) * turn_axis(),
            corrected_l(difference_rotation()),
            symbol="l",
            shown=(Formula("l", printed_l(sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"r_{i + 1}{j + 1}")))),),
            shown_corrected=(
                Formula("l", corrected_l(sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"r_{i + 1}{j + 1}")))),
            ),
            example=_quarter_turn_about_x,
            facts=(
                Fact(
                    "printed l = P · right l and, where R(θ) = R^d, ∂c/∂θ = -P J_ω (elsewhere -P J_r⁻¹(c) "
                    "J_ω, "
                    "see (50)), with P the reflection at x + z = 0; P² = I, so P cancels in JᵀJ and Jᵀe if J "
                    "is the derivative of the printed "
                    "residual (exact)",
                    lambda: (
                        is_mirrored(printed_l, MIRROR)
                        and MIRROR.det() == -1
                        and vanishes(MIRROR**2 - sp.eye(3))
                    ),
                ),
                Fact(
                    "a Newton step with the geometric Jacobian turns a misalignment e into 2n(n·e), "
                    "n = (1, 0, 1)/√2, to first order: worse for every axis within 60° of ±n, half of all",
                    _away_within_60_degrees,
                ),
                Fact(
                    "on the arm at q = (0.3, 0.5, -0.4, 1, 0.2, 0.4, -0.6) such a step takes 10° about n to "
                    "20° with the printed l, to below 1° with the corrected one (CasADi)",
                    _doubles,
                ),
            ),
        ),
        derivation="RT between two postures of the arm that differ by δ in joint 3; its axis is the third "
        "column of the geometric Jacobian. RT - RTᵀ = 2 sin δ [axis]×, whose entries (3,2), (1,3), (2,1) "
        "are x, y, z. The corrected (51) and (53) are the residual of Sugihara (IEEE Trans. Robotics 27, "
        "2011), a later account of the method this paper compares with.",
        correction="l = (r32 - r23, r13 - r31, r21 - r12)",
        fault=Fault.MISPRINT,
    ),
)
