"""The ledger as a page: `docs/ledger.md`."""

from __future__ import annotations

from collections import Counter

import sympy as sp

from derivations.claim import Claim, Formula, Verdict
from derivations.ledger import PAPERS, all_claims
from derivations.nguyen2021.elbow_direction import P

_MARKS = {
    Verdict.HOLDS: "✓",
    Verdict.CORRECTED: "✎",
    Verdict.FALSE: "✗",
    Verdict.DEFINITION: "≔",
    Verdict.NOT_CHECKABLE: "?",
    Verdict.ADDED: "＋",
}
_TITLES = {"nguyen2021": "Nguyen, Bui, Pham (2021)", "alfaiz": "Al-Faiz, Ali, Miry"}
_SYMBOLS = {p: f"q'_{k + 1}" for k, p in enumerate(P)}

_HEAD = """# The ledger: every numbered equation of both papers, checked by machine

Written by `python -m derivations --markdown`; a test holds it against the code in `derivations/`. The true
side of every equation comes from the DH chain through `armik_sym.symbolic`; every verdict is reached by its
check, which the tests also show to be able to fail.

**How to read it.** "Printed" is the equation as the paper prints it. Both papers were read as text extracted
from print; what extraction damaged, rather than the printer, is said apart under "Stored text". A misprint
comes with numbers you can put into the printed formula. Angles are in radians, lengths of Nguyen 2021 in
millimetres.

**How it is proved.** Identities between sines and cosines are reduced to zero over the rationals, as
polynomials modulo s² + c² = 1 for every angle: a proof, not a sample. Inverse functions (arc sine, arc
tangent) are compared with 50 digits on a grid that contains their boundaries. Both are evaluated once more in
double precision, through CasADi, at random points.
"""


def page() -> str:
    """The whole ledger.

    Returns:
        Markdown with LaTeX between dollar signs.

    Source:
        Nguyen 2021; Al-Faiz.
    """
    parts = [_HEAD, _counts(), "## Misprints: what to write instead\n", _misprints()]
    for paper, module in PAPERS.items():
        parts += [f"## {_TITLES[paper]}\n", " ".join((module.__doc__ or "").split()) + "\n"]
        claims = [claim for claim in all_claims() if claim.paper == paper]
        parts += [_contents(claims), *(_section(claim) for claim in claims)]
    return "\n".join(parts)


def _counts() -> str:
    counts = Counter(claim.verdict for claim in all_claims())
    rows = [f"| {_MARKS[verdict]} | {verdict.value} | {counts[verdict]} |" for verdict in Verdict]
    return "\n".join(["| | verdict | entries |", "|---|---|---|", *rows]) + "\n"


def _misprints() -> str:
    wrong = [claim for claim in all_claims() if claim.verdict in (Verdict.CORRECTED, Verdict.FALSE)]
    rows = [
        f"| {claim.paper} | [{_number(claim)}](#{_anchor(claim)}) | {_cell(claim.title)} | "
        f"{_cell(claim.correction or 'no correction known')} |"
        for claim in wrong
    ]
    return "\n".join(["| paper | equation | about | instead |", "|---|---|---|---|", *rows]) + "\n"


def _contents(claims: list[Claim]) -> str:
    rows = [
        f"| [{_number(claim)}](#{_anchor(claim)}) | {_MARKS[claim.verdict]} {claim.verdict.value} | "
        f"{_cell(claim.title)} |"
        for claim in claims
    ]
    return "\n".join(["| equation | verdict | about |", "|---|---|---|", *rows]) + "\n"


def _section(claim: Claim) -> str:
    evidence = claim.check()
    lines = [
        f'<a id="{_anchor(claim)}"></a>\n',
        f"### {_number(claim)}: {claim.title}\n",
        f"{_MARKS[claim.verdict]} **{claim.verdict.value}.** {claim.summary}\n",
        *_formulas("Shown" if claim.verdict is Verdict.ADDED else "Printed", claim.printed_formulas()),
        _paragraph("Correction", claim.correction),
        *_formulas("Instead", claim.corrected_formulas()),
        _paragraph("Counterexample", evidence.counterexample),
        _paragraph("Derivation", claim.derivation),
        _paragraph("Proof", "" if claim.body is None else evidence.proof),
        _paragraph("Stored text", claim.extraction),
    ]
    return "\n".join(line for line in lines if line)


def _paragraph(name: str, text: str) -> str:
    return f"*{name}.* {text}\n" if text else ""


def _formulas(name: str, formulas: tuple[Formula, ...]) -> list[str]:
    if not formulas:
        return []
    return [f"*{name}.*\n", *(f"$$\n{latex(formula)}\n$$\n" for formula in formulas)]


def latex(formula: Formula) -> str:
    """One formula, long sums broken into lines.

    Args:
        formula: The formula.

    Returns:
        LaTeX without dollar signs.

    Source:
        None (typesetting).
    """
    left = f"{formula.left} {formula.relation} " if formula.left else ""
    if isinstance(formula.right, str):
        return left + formula.right
    return left + str(sp.latex(formula.right, symbol_names=_SYMBOLS, inv_trig_style="full"))


def _number(claim: Claim) -> str:
    return f"({claim.equation})" if claim.equation[0].isdigit() else claim.equation


def _anchor(claim: Claim) -> str:
    name = "".join(c if c.isalnum() else "-" for c in claim.equation.lower())
    return f"{claim.paper}-{name}"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
