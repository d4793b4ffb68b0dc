"""Al-Faiz, §3.1, eq. (36)-(38): the rotation of the wrist."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import casadi as ca
import sympy as sp
from sympy import cos, sin

from armik_sym.arm.catalog import alfaiz
from armik_sym.symbolic.link_transform import link_transform
from derivations.alfaiz.chain import L3, L4, Q, between
from derivations.alfaiz.facts import Fact, IdentityWithFacts
from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.from_casadi import to_sympy
from derivations.random_points import first_difference, largest_difference

PAPER = "alfaiz"
_ROUNDING = 1e-9


@functools.cache
def wrist(quarter_turns_of_alpha_6: int = 1) -> sp.Matrix:
    """Product A_5 A_6 A_7 of the catalogue's rows.

    Args:
        quarter_turns_of_alpha_6: Twist α6 in right angles: 1 as in the matrix A_6 and in the catalogue, -1 as
            in Table 1.

    Returns:
        Homogeneous transform, SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, Table 1 and eq. 2, through `armik_sym.symbolic`.
    """
    chain = alfaiz().chain
    rows = list(chain.links)
    rows[5] = replace(rows[5], alpha=quarter_turns_of_alpha_6 * math.pi / 2)
    q, lengths = ca.SX.sym("q", 7), ca.SX.sym("lengths", 2)
    named = dict(zip(chain.length_names, ca.vertsplit(lengths), strict=True))
    T = ca.SX.eye(4)
    for i in (4, 5, 6):
        T = T @ link_transform(rows[i], chain.convention, q[i], named)
    return to_sympy(T, [q, lengths], [Q, (L4, L3)])


def printed_rotation() -> sp.Matrix:
    """Eq. (38) as it must have been printed.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Al-Faiz, eq. 38, subscripts read from the pattern of the product and from eq. 39-46.
    """
    s5, s6, s7 = (sin(q) for q in Q[4:])
    c5, c6, c7 = (cos(q) for q in Q[4:])
    return sp.Matrix(
        [
            [c5 * c7 * s6 - s5 * s7, -c7 * s5 - c5 * s6 * s7, c5 * c6],
            [-c6 * c7, c6 * s7, s6],
            [-c5 * s7 - c7 * s5 * s6, s5 * s6 * s7 - c5 * c7, -c6 * s5],
        ]
    )


def extracted_rotation() -> sp.Matrix:
    """Eq. (38) as the stored text has it, letter by letter.

    Returns:
        SymPy matrix of shape (3, 3).

    Source:
        Al-Faiz, eq. 38, as extracted.
    """
    c2, s2, c7, s7 = cos(Q[1]), sin(Q[1]), cos(Q[6]), sin(Q[6])
    return sp.Matrix(
        [
            [c2 * c7 * s2 - c2 * s2 * s7, -c2 * s2 - c2 * s2 * s7, c2 * c2],
            [-c2 * c7, c2 * s7, s2],
            [-c2 * s7 - c7 * s2 * s2, s2 * s2 * s7 - c2 * c7, -c2 * s2],
        ]
    )


def check_product(product: sp.Matrix) -> Evidence:
    """Whether a product of the arm's transforms is that of the last three rows.

    Args:
        product: SymPy matrix of shape (4, 4), supposed to be A_5 A_6 A_7.

    Returns:
        The verdict HOLDS if all 16 entries agree exactly and in numbers, else FALSE.

    Source:
        Al-Faiz, eq. 36.
    """
    exact = all(is_exactly_zero(a - b) for a, b in zip(product, wrist(), strict=True))
    if exact and largest_difference(product, wrist()) < _ROUNDING:
        words = "16 entries reduced to zero over the rationals, and agreeing at 1,000 random points in CasADi"
        return Evidence(Verdict.HOLDS, words)
    return Evidence(Verdict.FALSE, "not the same matrix", str(first_difference(product, wrist())))


def check_names(T: sp.Matrix) -> Evidence:
    """Whether nine numbers r_ij are enough to name a transform: a rotation and a constant shift.

    Args:
        T: Homogeneous transform, SymPy matrix of shape (4, 4).

    Returns:
        The verdict DEFINITION if its rotation part is one and its shift is the forearm along x, else FALSE.

    Source:
        Al-Faiz, eq. 37.
    """
    R = sp.Matrix(T[:3, :3])
    if T[:3, 3] != sp.Matrix([L3, 0, 0]) or largest_difference(R.T * R, sp.eye(3)) > _ROUNDING:
        return Evidence(Verdict.FALSE, "not a rotation with the forearm as its shift")
    if all(is_exactly_zero(entry) for entry in R.T * R - sp.eye(3)) and is_exactly_zero(R.det() - 1):
        words = "RᵀR = I, det R = 1 and the fourth column (l3, 0, 0, 1)ᵀ, reduced to zero over the rationals"
        return Evidence(Verdict.DEFINITION, words)
    return Evidence(Verdict.FALSE, "no rotation")


def _alpha_6_of_table_1_fails() -> bool:
    rotations = {turns: sp.Matrix(wrist(turns)[:3, :3]) for turns in (1, -1)}
    miss = {turns: largest_difference(printed_rotation(), R) for turns, R in rotations.items()}
    return miss[1] < _ROUNDING and miss[-1] > 0.5 and is_exactly_zero(rotations[-1][1, 2] + sin(Q[5]))


CLAIMS = (
    Claim(
        PAPER,
        "36",
        "what is left for the wrist",
        Verdict.HOLDS,
        "The last three transforms are the first four, inverted, times the target. Since the shoulder and "
        "elbow enter through their full rotation, a wrong branch in θ1 … θ4 changes the wrist angles too.",
        Check(
            lambda: check_product(between(5, 7)),
            printed=(Formula("A_5 A_6 A_7", r"[A_1 A_2 A_3 A_4]^{-1}\, T"),),
        ),
        derivation="Left: the product of rows 5 to 7. Right: frame 4 inverted as a rigid transform, times "
        "frame 7. Both from the same chain, multiplied in different order.",
    ),
    Claim(
        PAPER,
        "37",
        "names of the nine entries",
        Verdict.DEFINITION,
        "r_ij are the entries of the rotation of A_5 A_6 A_7. The product itself is a 4 x 4 matrix; its "
        "fourth column is the constant forearm (l3, 0, 0, 1), which eq. (37) and (38) leave out. The "
        'text before it cites "eq 37" where (36) is meant, and step 5 announces θ5 but finds θ6.',
        Check(
            lambda: check_names(wrist()),
            printed=(Formula("A_5 A_6 A_7", sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"r_{i + 1}{j + 1}"))),),
        ),
        derivation="The rotation part and the shift of the product of rows 5 to 7.",
    ),
    Claim(
        PAPER,
        "38",
        "the rotation of the wrist",
        Verdict.HOLDS,
        "Exact, with two provisos. s6 and c6 are those of the joint angle q6, without the -π/2 of Table 1; "
        "and row 6 must have the twist +π/2 of the printed matrix A_6. With the -π/2 of Table 1 the whole "
        "wrist solution fails: r23 becomes -sin q6.",
        IdentityWithFacts(
            printed_rotation(),
            sp.Matrix(wrist()[:3, :3]),
            extracted=extracted_rotation(),
            symbol="A_5 A_6 A_7",
            facts=(
                Fact(
                    "with α6 = -π/2, as in Table 1, the matrix differs and r23 = -sin q6 exactly",
                    _alpha_6_of_table_1_fails,
                ),
            ),
        ),
        derivation="Product of rows 5 to 7, rotation part.",
        extraction="The left side stands as A_1·A_2·A_7, nearly all subscripts 5 and 6 stand as 2, s5·s7 "
        "as c2·s2·s7 and c7·s5 as c2·s2; the reading is fixed by the product and by (39)-(46). "
        "Read with the subscripts that make it true; the print itself was not seen.",
    ),
)
