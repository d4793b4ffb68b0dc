"""The ledger as plain text, for the terminal."""

from __future__ import annotations

import sympy as sp

from derivations.claim import Claim, Evidence, Formula


def line(claim: Claim, evidence: Evidence) -> str:
    """Paper, equation, verdict and title.

    Args:
        claim: The claim.
        evidence: What its check found.

    Returns:
        One line; a second one if the check contradicts the ledger.

    Source:
        None (text).
    """
    text = f"{claim.paper:11s} {claim.equation:10s} {evidence.verdict.value:24s} {claim.title}\n"
    if evidence.verdict is not claim.verdict:
        text += f"    THE LEDGER SAYS {claim.verdict.value!r}\n"
    return text


def explanation(claim: Claim, evidence: Evidence) -> str:
    """Everything a claim holds: printed form, truth, proof, counterexample.

    Args:
        claim: The claim.
        evidence: What its check found.

    Returns:
        Indented lines, an empty one at the end.

    Source:
        None (text).
    """
    parts = {
        "says": claim.summary,
        "printed": formulas(claim.printed_formulas()),
        "correction": claim.correction,
        "corrected": formulas(claim.corrected_formulas()),
        "derivation": claim.derivation,
        "proof": evidence.proof,
        "counterexample": evidence.counterexample,
        "extraction": claim.extraction,
    }
    return "".join(f"    {name}: {part}\n" for name, part in parts.items() if part) + "\n"


def formulas(shown: tuple[Formula, ...]) -> str:
    """Formulas, one per line; of a matrix every entry.

    Args:
        shown: The formulas.

    Returns:
        Lines.

    Source:
        None (text).
    """
    return "".join("\n        " + text for formula in shown for text in _lines(formula))


def _lines(formula: Formula) -> list[str]:
    if not isinstance(formula.right, sp.MatrixBase):
        return [f"{formula.left} {formula.relation} {formula.right}"]
    rows, columns = formula.right.shape
    return [
        f"{formula.left}[{i + 1}, {j + 1}] {formula.relation} {formula.right[i, j]}"
        for i in range(rows)
        for j in range(columns)
    ]
