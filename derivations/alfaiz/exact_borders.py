"""Where a printed formula has a case of its own for a vanishing denominator, rounding hides that case.

`Branch` meets cos(π/2) only as a number near zero. Here the same formulas are evaluated in SymPy, where the
cosine of a right angle is zero, so that the printed case is really the one that is taken. The same way gives
counterexamples in round numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derivations.alfaiz.letters import in_words
from derivations.branch import Branch
from derivations.claim import Evidence, Verdict

Posture = Mapping[sp.Symbol, sp.Expr | int]


def check_with_borders(branch: Branch, borders: Sequence[Posture]) -> Evidence:
    """Check a branch, then its exact formulas at postures in which a denominator is exactly zero.

    Args:
        branch: The claim.
        borders: Postures, exact numbers for every symbol.

    Returns:
        As `with_borders`.

    Source:
        None (exact evaluation).
    """
    return with_borders(branch, branch.check(), borders)


def with_borders(branch: Branch, found: Evidence, borders: Sequence[Posture]) -> Evidence:
    """Evidence about a branch, and its exact formulas where a denominator is exactly zero.

    Args:
        branch: The claim.
        found: Its evidence so far.
        borders: Postures, exact numbers for every symbol.

    Returns:
        The evidence; what fails at the borders joins the counterexample. FALSE if the corrected form (or, if
        the printed one holds everywhere else, the printed one) fails at a border.

    Source:
        None (exact evaluation).
    """
    misses = [_words(branch, posture) for posture in borders if not _right(branch.printed, branch, posture)]
    if found.verdict is Verdict.HOLDS:
        if misses:
            return Evidence(Verdict.FALSE, "fails where its denominator is exactly zero", misses[0])
        return found
    if branch.corrected is None or not borders:
        return found
    if not all(_right(branch.corrected, branch, posture) for posture in borders):
        return Evidence(Verdict.FALSE, "the corrected form fails at a border", found.counterexample)
    proof = found.proof + f"; the corrected form is exact at {len(borders)} postures with a zero denominator"
    return Evidence(found.verdict, proof, "; ".join([found.counterexample, *misses]))


def with_example(branch: Branch, found: Evidence, posture: Posture | None) -> Evidence:
    """Evidence with a counterexample in round numbers instead of the first one of the grid.

    Args:
        branch: The claim.
        found: Its evidence so far.
        posture: Where the printed form fails, exact numbers for every symbol; None leaves the evidence.

    Returns:
        The evidence; unchanged too if the printed form does not fail there.

    Source:
        None (exact evaluation).
    """
    if posture is None or not found.counterexample or _right(branch.printed, branch, posture):
        return found
    return replace(found, counterexample=_words(branch, posture))


def _right(form: sp.Expr, branch: Branch, posture: Posture) -> bool:
    turns = sp.nsimplify(sp.simplify((form - branch.true).subs(posture)) / (2 * sp.pi))
    return bool(turns.is_integer)


def _words(branch: Branch, posture: Posture) -> str:
    inputs = branch.inputs or {str(symbol): symbol for symbol in posture}
    point = ", ".join(f"{name} = {in_words(value.subs(posture))}" for name, value in inputs.items())
    printed, true = branch.printed.subs(posture), branch.true.subs(posture)
    return f"exactly at {point}: printed {in_words(printed)}, true {in_words(true)}"
