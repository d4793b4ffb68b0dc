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
side of every equation comes from the DH chain through `armik_sym.symbolic`. Every verdict but that of a bare
definition is reached by a check, and the tests show that the checks are able to fail.

**How to read it.** "Printed" is the equation as the paper prints it, as far as one can tell: both papers were
read as text extracted from print, not in print. Where extraction damaged the text, "Stored text" says how it
was read; an equation that "holds as printed" then holds in that reading. A correction is of a kind:
*misprint* (something else was meant), *lost quadrant or branch* (an inverse function returns one solution,
and another lies inside the range of motion, too), *wording*, or *modelling* (the formula does what it says,
but not what it is for). It comes with numbers you can put into the printed formula. Angles are in radians,
lengths of Nguyen 2021 in millimetres.

**How it is proved.** Identities between sines and cosines are reduced to zero over the rationals, as
polynomials modulo s² + c² = 1 for every angle: a proof, not a sample. Inverse functions (arc sine, arc
tangent) are compared with 50 digits on a grid that contains the borders of all quadrants and what is next to
them. Both are evaluated once more in double precision, through CasADi, at random points.
"""


def page() -> str:
    """The whole ledger.

    Returns:
        Markdown with LaTeX between dollar signs.

    Source:
        Nguyen 2021; Al-Faiz.
    """
    parts = [_HEAD, _counts(), "## What to write instead\n", _corrections()]
    for paper, module in PAPERS.items():
        parts += [f"## {_TITLES[paper]}\n", " ".join((module.__doc__ or "").split()) + "\n"]
        claims = [claim for claim in all_claims() if claim.paper == paper]
        parts += [_contents(claims), *(_section(claim) for claim in claims)]
    return "\n".join(parts)


def _counts() -> str:
    counts = Counter(claim.verdict for claim in all_claims())
    rows = [f"| {_MARKS[verdict]} | {verdict.value} | {counts[verdict]} |" for verdict in Verdict]
    return "\n".join(["| | verdict | entries |", "|---|---|---|", *rows]) + "\n"


def _corrections() -> str:
    wrong = [claim for claim in all_claims() if claim.verdict in (Verdict.CORRECTED, Verdict.FALSE)]
    rows = [
        f"| {claim.paper} | [{_number(claim)}](#{_anchor(claim)}) | {_cell(claim.title)} | "
        f"{claim.fault.value if claim.fault else ''} | {_cell(claim.correction or 'no correction known')} |"
        for claim in wrong
    ]
    head = ["| paper | equation | about | kind | instead |", "|---|---|---|---|---|"]
    return "\n".join([*head, *rows]) + "\n"


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
    return [f"*{name}.*\n", *(f"```math\n{latex(formula)}\n```\n" for formula in formulas)]


def latex(formula: Formula) -> str:
    """One formula, in the macros GitHub allows (it refuses operatorname).

    Args:
        formula: The formula.

    Returns:
        LaTeX, one line.

    Source:
        None (typesetting).
    """
    left = f"{formula.left} {formula.relation} " if formula.left else ""
    right = formula.right
    if not isinstance(right, str):
        right = str(sp.latex(right, symbol_names=_SYMBOLS, inv_trig_style="full"))
    text = (left + right).replace(r"\operatorname{atan}_{2}", r"\mathrm{atan2}")
    return text.replace(r"\operatorname", r"\mathrm")


def _number(claim: Claim) -> str:
    return f"({claim.equation})" if claim.equation[0].isdigit() else claim.equation


def _anchor(claim: Claim) -> str:
    name = "".join(c if c.isalnum() else "-" for c in claim.equation.lower())
    return f"{claim.paper}-{name}"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
