"""Where a printed formula has a case of its own for a vanishing denominator, rounding hides that case.

`Branch` meets cos(π/2) only as a number near zero. Here the same formulas are evaluated in SymPy, where the
cosine of a right angle is zero, so that the printed case is really the one that is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from derivations.branch import Branch
from derivations.claim import Evidence, Verdict

Posture = Mapping[sp.Symbol, sp.Expr | int]


def check_with_borders(branch: Branch, borders: Sequence[Posture]) -> Evidence:
    """Check a branch, then its exact formulas at postures in which a denominator is exactly zero.

    Args:
        branch: The claim.
        borders: Postures, exact numbers for every symbol.

    Returns:
        The branch's evidence; what fails at the borders joins the counterexample. FALSE if the corrected
        form (or, if the printed one holds everywhere else, the printed one) fails at a border.

    Source:
        None (exact evaluation).
    """
    found = branch.check()
    misses = [_words(branch, posture) for posture in borders if not _right(branch.printed, branch, posture)]
    if found.verdict is Verdict.HOLDS:
        if misses:
            return Evidence(Verdict.FALSE, "fails where its denominator is exactly zero", misses[0])
        return found
    if branch.corrected is None:
        return found
    if not all(_right(branch.corrected, branch, posture) for posture in borders):
        return Evidence(Verdict.FALSE, "the corrected form fails at a border", found.counterexample)
    proof = found.proof + f"; exactly right at {len(borders)} postures with a zero denominator"
    return Evidence(found.verdict, proof, "; ".join([found.counterexample, *misses]))


def _right(form: sp.Expr, branch: Branch, posture: Posture) -> bool:
    turns = sp.nsimplify(sp.simplify((form - branch.true).subs(posture)) / (2 * sp.pi))
    return bool(turns.is_integer)


def _words(branch: Branch, posture: Posture) -> str:
    point = ", ".join(f"{symbol} = {value}" for symbol, value in posture.items())
    return f"exactly at {point}: printed {branch.printed.subs(posture)}, true {branch.true.subs(posture)}"
