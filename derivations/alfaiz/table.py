"""Al-Faiz, Table 1, the matrices A_1 to A_7 below it, and eq. (3)."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import sympy as sp
from sympy import cos, pi, sin

from derivations.alfaiz.chain import L3, L4, OFFSETS, Q, frame
from derivations.alfaiz.elementary_transforms import modified_row
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.identity import Identity
from derivations.random_points import first_difference

PAPER = "alfaiz"

# The columns of Table 1: a_i (d_i is 0 everywhere) and α_i in right angles.
_A = (0, 0, 0, L4, L3, 0, 0)
_ALPHA_PRINTED = (1, 1, -1, 1, -1, -1, -1)
_ALPHA_CORRECTED = (1, 1, -1, 1, -1, 1, -1)


@dataclass(frozen=True)
class Table:
    """Table 1 by columns.

    Attributes:
        offsets: What is added to q_i, in [rad].
        a: Shifts along x.
        alpha: Twists, in right angles.
    """

    offsets: tuple[sp.Expr | int, ...] = OFFSETS
    a: tuple[sp.Expr | int, ...] = _A
    alpha: tuple[int, ...] = _ALPHA_PRINTED

    def matrix(self, row: int) -> sp.Matrix:
        """Eq. (2) for a row, counted from 1.

        Args:
            row: 1 to 7.

        Returns:
            SymPy matrix of shape (4, 4).

        Source:
            Al-Faiz, Table 1 and eq. 2, through `armik_sym.symbolic`.
        """
        i = row - 1
        return modified_row(self.alpha[i] * math.pi / 2, Q[i] + self.offsets[i], self.a[i], sp.Integer(0))


def printed_matrix(row: int, offsets: tuple[sp.Expr | int, ...] = OFFSETS) -> sp.Matrix:
    """A_row as printed, c and s being cosine and sine "of theta".

    Args:
        row: 1 to 7.
        offsets: What theta has in addition to q; Table 1's.

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, matrices below Table 1.
    """
    theta = Q[row - 1] + offsets[row - 1]
    c, s = cos(theta), sin(theta)
    a = {4: L4, 5: L3}.get(row, 0)
    if row in (1, 2, 4, 6):
        return sp.Matrix([[c, -s, 0, a], [0, 0, -1, 0], [s, c, 0, 0], [0, 0, 0, 1]])
    return sp.Matrix([[c, -s, 0, a], [0, 0, 1, 0], [-s, -c, 0, 0], [0, 0, 0, 1]])


def check_table(table: Table, corrected: Table) -> Evidence:
    """Which rows of the table give the printed matrix of their number.

    Args:
        table: As printed.
        corrected: With its correction.

    Returns:
        The evidence.

    Source:
        Al-Faiz, Table 1, eq. 2 and the matrices below the table.
    """
    rows = range(1, 8)
    wrong = [i for i in rows if not _same(table.matrix(i), printed_matrix(i))]
    if not wrong:
        return Evidence(Verdict.HOLDS, "all seven rows give the printed matrices exactly")
    found = first_difference(printed_matrix(wrong[0]), table.matrix(wrong[0]))
    if found is None:
        return Evidence(Verdict.FALSE, f"rows {wrong} differ from their matrices, but not in numbers")
    i, j = found.entry or (0, 0)
    at = ", ".join(f"{name} = {value:g}" for name, value in found.point.items())
    counterexample = (
        f"row {wrong[0]}: entry ({i + 1}, {j + 1}) of the printed matrix is {found.printed:.6g}, the row "
        f"gives {found.true:.6g} (at {at})"
    )
    mended = all(_same(corrected.matrix(i), printed_matrix(i)) for i in rows)
    words = ", ".join(str(i) for i in rows if i not in wrong)
    return Evidence(
        Verdict.CORRECTED if mended else Verdict.FALSE,
        f"rows {words} give the printed matrices exactly as they are"
        + (f", row {wrong[0]} after the correction" if mended else ""),
        counterexample,
    )


def _same(left: sp.Matrix, right: sp.Matrix) -> bool:
    return Identity(left, right).check().verdict is Verdict.HOLDS


def check_product(offsets: tuple[sp.Expr | int, ...] = OFFSETS) -> Evidence:
    """Whether the printed matrices multiply to the pose of the catalogue's chain, a rigid transform.

    Args:
        offsets: What theta has in addition to q.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 3.
    """
    product = functools.reduce(
        lambda A, B: sp.Matrix(A * B), [printed_matrix(i, offsets) for i in range(1, 8)]
    )
    found = Identity(product, frame(7)).check()
    if found.verdict is not Verdict.HOLDS:
        return found
    return Evidence(
        Verdict.DEFINITION,
        "the product of the printed matrices is the pose of the catalogue's chain: " + found.proof,
    )


def _in_theta(row: int) -> sp.Matrix:
    """A_row in the paper's letters, theta with whatever it contains, l5 for the forearm."""
    letters = {Q[row - 1]: sp.Symbol(f"theta{row}", real=True), L3: sp.Symbol("l5")}
    return printed_matrix(row, (0,) * 7).subs(letters)


def _all_matrices() -> Evidence:
    left = [sp.Matrix(frame(i - 1) * printed_matrix(i)) for i in range(1, 8)]
    return Identity(sp.Matrix.hstack(*left), sp.Matrix.hstack(*map(frame, range(1, 8)))).check()


CLAIMS = (
    Claim(
        PAPER,
        "Table 1",
        "DH parameters of the human arm",
        Verdict.CORRECTED,
        "Six rows agree with the printed matrices; row 6 prints a twist of -90° where A_6 has +90°. The "
        "inverse solution (38)-(47) uses +90°: program the table as it stands and the sign of θ6 is wrong.",
        Check(
            lambda: check_table(Table(), Table(alpha=_ALPHA_CORRECTED)),
            printed=(Formula(r"\alpha_6", -pi / 2),),
            corrected=(Formula(r"\alpha_6", pi / 2),),
        ),
        derivation="Eq. (2) is written out for every row (d = 0 throughout) and compared with A_1 … A_7. "
        "L4 is the upper arm, l4 in the equations; L5 is the forearm, l5 in A_5 but l3 from eq. (5) on.",
        correction="α6 = +π/2",
        fault=Fault.MISPRINT,
    ),
    Claim(
        PAPER,
        "A_1…A_7",
        "the seven link matrices",
        Verdict.HOLDS,
        "All seven hold with c and s taken of θ, the offsets of Table 1 included: θ2 = q2 + 90° and "
        "θ6 = q6 - 90°. The equations from (7) on write c2, s2, c6, s6 and θ2, θ6 for q2 and q6 without "
        "the offsets: the same letters mean two things.",
        Check(_all_matrices, printed=tuple(Formula(f"A_{i}", _in_theta(i)) for i in range(1, 8))),
        derivation="Frame i - 1 of the catalogue's chain times the printed A_i is frame i, for all seven i.",
    ),
    Claim(
        PAPER,
        "3",
        "the pose of the hand",
        Verdict.DEFINITION,
        "T is the product of the seven matrices; its last column is the wrist position (dx, dy, dz), as no "
        "link follows the wrist. Joint 1 turns about the y axis, and at q = 0 the arm hangs along -y.",
        Check(
            check_product,
            printed=(
                Formula(
                    "T",
                    r"A_1 A_2 A_3 A_4 A_5 A_6 A_7 = \begin{bmatrix} n_x & o_x & a_x & d_x \\ n_y & o_y & a_y "
                    r"& d_y \\ n_z & o_z & a_z & d_z \\ 0 & 0 & 0 & 1 \end{bmatrix}",
                ),
            ),
        ),
    ),
)
