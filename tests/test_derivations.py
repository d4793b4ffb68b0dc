"""The ledger: complete, every verdict reached by the check itself, and the checker is able to fail."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
import sympy as sp

from derivations import __main__ as command
from derivations.branch import Branch
from derivations.claim import Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.from_casadi import to_sympy
from derivations.identity import Identity
from derivations.ledger import EQUATIONS, all_claims, covered, missing
from derivations.random_points import evaluate, first_difference, largest_difference

CLAIMS = {f"{claim.paper} {claim.equation}": claim for claim in all_claims()}
IDENTITIES = [name for name, claim in CLAIMS.items() if isinstance(claim.body, Identity)]
BRANCHES = [name for name, claim in CLAIMS.items() if isinstance(claim.body, Branch)]

# What must be proved exactly, not sampled ((40), (44), (47) between them are inverse functions).
EXACT = {
    "nguyen2021": ["3", "5", "7", "8"],
    "alfaiz": [
        "A_1…A_7", "6", "7", "8", "11", "12", "23", "28", "29", "38", "39", "41", "42", "43", "45", "46",
    ],
}  # fmt: skip


def test_every_equation_of_both_papers_is_in_the_ledger() -> None:
    assert EQUATIONS["nguyen2021"][:16] == tuple(str(k) for k in range(1, 17))
    assert EQUATIONS["alfaiz"][:63] == tuple(str(k) for k in range(1, 64))
    assert missing() == []
    assert len(CLAIMS) == len(all_claims()), "an entry occurs twice"


def test_no_equation_is_claimed_twice() -> None:
    seen = [(claim.paper, equation) for claim in all_claims() for equation in covered(claim)]
    assert len(seen) == len(set(seen)), sorted({name for name in seen if seen.count(name) > 1})


@pytest.mark.parametrize("name", CLAIMS)
def test_the_check_reaches_the_verdict_of_the_ledger(name: str) -> None:
    claim = CLAIMS[name]
    evidence = claim.check()
    assert evidence.verdict is claim.verdict, evidence
    assert claim.summary
    assert claim.printed_formulas() or claim.equation.startswith("Table") or not claim.equation[0].isdigit()
    if claim.verdict in (Verdict.CORRECTED, Verdict.FALSE):
        assert evidence.counterexample, "a misprint comes with numbers that show it"
    if claim.verdict is Verdict.CORRECTED:
        assert claim.correction
        assert claim.fault is not None
    else:
        assert claim.fault is None
    if claim.verdict in (Verdict.HOLDS, Verdict.CORRECTED, Verdict.FALSE):
        assert claim.body is not None, "a verdict needs a check"


def mutants(matrix: sp.Matrix) -> list[sp.Matrix]:
    """The same matrix with one sign turned, or two angles swapped in one entry."""
    found = []
    for i in range(len(matrix)):
        turned = matrix.copy()
        turned[i] = -turned[i]
        found.append(turned)
        angles = sorted(matrix[i].free_symbols, key=str)
        if len(angles) > 1:
            swapped = matrix.copy()
            swapped[i] = swapped[i].subs(dict(zip(angles[:2], angles[1::-1], strict=True)), simultaneous=True)
            found.append(swapped)
    return found


@pytest.mark.parametrize("name", IDENTITIES)
def test_a_turned_sign_or_swapped_angle_turns_the_verdict(name: str) -> None:
    body = CLAIMS[name].body
    assert isinstance(body, Identity)
    right = body.printed if body.corrected is None else body.corrected
    turned = 0
    for wrong in mutants(right):
        if all(is_exactly_zero(a - b, body.roots) for a, b in zip(wrong, right, strict=True)):
            continue
        printed = wrong if body.corrected is None else body.printed
        corrected = None if body.corrected is None else wrong
        mutated = dataclasses.replace(body, printed=printed, corrected=corrected)
        assert mutated.check().verdict is Verdict.FALSE
        turned += 1
    assert turned


@pytest.mark.parametrize("name", BRANCHES)
def test_a_turned_sign_turns_the_verdict_of_a_branch(name: str) -> None:
    body = CLAIMS[name].body
    assert isinstance(body, Branch)
    if body.corrected is None:
        wrong = dataclasses.replace(body, printed=-body.printed)
    else:
        wrong = dataclasses.replace(body, corrected=-body.corrected)
    assert wrong.check().verdict is not CLAIMS[name].verdict


@pytest.mark.parametrize("name", IDENTITIES)
def test_numbers_agree_with_the_proof(name: str) -> None:
    body = CLAIMS[name].body
    assert isinstance(body, Identity)
    right = body.printed if body.corrected is None else body.corrected
    roots = {W: sp.sqrt(value) for W, value in body.roots.items()}
    difference = (right - body.derived).subs(roots)
    symbols = sorted(difference.free_symbols, key=str)
    rng = np.random.default_rng(3)
    for point in rng.uniform(0.1, 3, (5, len(symbols))):
        values = dict(zip(symbols, point, strict=True))
        assert max(abs(complex(entry)) for entry in sp.N(difference.subs(values), 30)) < 1e-9


@pytest.mark.parametrize(("paper", "equation"), [(p, e) for p, names in EXACT.items() for e in names])
def test_identities_are_proved_exactly(paper: str, equation: str) -> None:
    (claim,) = [c for c in all_claims() if c.paper == paper and equation in (*covered(c), c.equation)]
    proof = claim.check().proof
    assert "zero over the rationals" in proof or "exact" in proof, proof


def test_exact_zero_knows_identities_from_near_misses() -> None:
    a, b, w = sp.symbols("a b w")
    assert is_exactly_zero(sp.sin(a + b) - sp.sin(a) * sp.cos(b) - sp.cos(a) * sp.sin(b))
    assert is_exactly_zero((1 - sp.cos(a) ** 2) / sp.sin(a) - sp.sin(a))
    assert is_exactly_zero(sp.tan(a / 2) - sp.sin(a) / (1 + sp.cos(a)))
    assert is_exactly_zero(sp.tan(a / 2 - sp.pi / 4) - (sp.sin(a) - 1) / sp.cos(a))
    assert is_exactly_zero(sp.cot(a / 3) * sp.tan(a / 3) - 1)
    assert is_exactly_zero((1 - w) * (1 + w) - sp.sin(a) ** 2, {w: sp.cos(a) ** 2})
    assert not is_exactly_zero((1 - w) * (1 + w) - sp.sin(a) ** 2, {w: sp.cos(b) ** 2})
    assert not is_exactly_zero(sp.tan(a / 2) - sp.sin(a) / (1 - sp.cos(a)))
    assert not is_exactly_zero(sp.sin(a) ** 2 + sp.cos(a) ** 2 - 1 - sp.Rational(1, 10**12))
    assert not is_exactly_zero(sp.sin(a) - sp.sin(b))
    with pytest.raises(ValueError, match="expected a symbol"):
        is_exactly_zero(sp.sin(a**2))
    with pytest.raises(ValueError, match="with a denominator"):
        is_exactly_zero(w, {w: 1 / sp.cos(a)})


def test_a_branch_knows_lost_quadrants() -> None:
    a = sp.Symbol("a", real=True)
    whole, half = {a: (-sp.pi, sp.pi)}, {a: (-sp.pi / 2, sp.pi / 2)}
    plain, two = sp.atan(sp.sin(a) / sp.cos(a)), sp.atan2(sp.sin(a), sp.cos(a))
    assert Branch("a", two, a, whole).check().verdict is Verdict.HOLDS
    lost = Branch("a", plain, a, whole, half, two).check()
    assert lost.verdict is Verdict.CORRECTED
    assert lost.counterexample
    assert "-pi/2 < a < pi/2" in lost.proof
    assert Branch("a", plain, a, whole, whole, two).check().verdict is Verdict.FALSE, "said to be right"
    assert Branch("a", plain, a, whole, None, plain).check().verdict is Verdict.FALSE
    divided = Branch("a", sp.atan(1 / sp.sin(a)), a, {a: (sp.Integer(0), sp.Integer(1))}).check()
    assert divided.verdict is Verdict.FALSE


def test_casadi_expressions_arrive_in_sympy_unchanged() -> None:
    x = ca.SX.sym("x", 2)
    matrix = ca.vertcat(
        ca.horzcat(ca.sin(x[0]) * x[1] ** 2, 0.1 - x[0] / x[1]),
        ca.horzcat(-ca.cos(x[1] + np.pi / 2), 2 * x[0]),
    )
    a, b = sp.symbols("a b")
    there = to_sympy(matrix, [x], [[a, b]])
    expected = sp.Matrix([[sp.sin(a) * b**2, sp.Rational(1, 10) - a / b], [sp.sin(b), 2 * a]])
    assert sp.simplify(there - expected) == sp.zeros(2, 2)


def test_differences_are_found_and_measured() -> None:
    a = sp.Symbol("a")
    left, right = sp.Matrix([[sp.sin(a), a]]), sp.Matrix([[sp.sin(a), a + sp.Rational(1, 4)]])
    assert 0.05 < largest_difference(left, right) <= 0.25
    found = first_difference(left, right)
    assert found is not None
    assert found.entry == (0, 1)
    assert found.true - found.printed == pytest.approx(0.25)
    assert first_difference(left, left) is None
    assert evaluate(sp.sin(a) + 1, [a], np.array([[0.0], [np.pi / 2]])) == pytest.approx([1, 2])


def test_the_command_prints_the_ledger(capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--explain"]) == 0
    text = capsys.readouterr().out
    assert all(claim.title in text for claim in CLAIMS.values())
    for part in ("printed: ", "correction: ", "corrected: ", "derivation: ", "proof: ", "counterexample: "):
        assert part in text
    assert command.main(["--equation", "3", "--paper", "nguyen2021"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 1
    for typed, lines in (("29", 1), ("(8)", 2), ("table 4", 1), ("A_1", 1), ("A1..A7", 1), ("3-5", 5)):
        assert command.main(["--equation", typed]) == 0
        assert len(capsys.readouterr().out.splitlines()) == lines, typed


def test_an_unknown_equation_is_answered_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--equation", "64"]) == 2
    said = capsys.readouterr().err
    assert "no equation '64'" in said
    assert "nguyen2021: 1 to 16" in said
    assert "alfaiz: 1 to 63" in said
    assert "Table 4" in said


def test_a_wrong_verdict_is_reported(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lying = dataclasses.replace(CLAIMS["nguyen2021 4-5"], verdict=Verdict.HOLDS)
    monkeypatch.setattr(command, "all_claims", lambda: (lying,))
    assert command.main([]) == 1
    assert "THE LEDGER SAYS 'holds as printed'" in capsys.readouterr().out


def test_the_committed_page_is_current() -> None:
    from derivations.markdown import page

    written = command.PAGE.read_text(encoding="utf-8")
    assert written == page(), "run `python -m derivations --markdown` and commit docs/ledger.md"


def test_the_page_is_written_whole_or_not_at_all(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr(command, "PAGE", tmp_path / "ledger.md")
    assert command.main(["--markdown", "--paper", "alfaiz"]) == 2
    assert "leave out --paper" in capsys.readouterr().err
    lying = dataclasses.replace(CLAIMS["nguyen2021 4-5"], verdict=Verdict.HOLDS)
    monkeypatch.setattr(command, "all_claims", lambda: (lying,))
    assert command.main(["--markdown"]) == 1
    assert "contradict the ledger in nguyen2021 4-5" in capsys.readouterr().err
    assert not command.PAGE.exists()


def test_the_page_can_be_shown_by_github() -> None:
    text = command.PAGE.read_text(encoding="utf-8")
    assert "$$" not in text, "outside a fence, backslashes and underscores of a formula are read as markdown"
    assert r"\operatorname" not in text, "refused by GitHub"
    for formula in re.findall(r"```math\n(.*?)\n```", text, re.DOTALL):
        assert formula.count("{") == formula.count("}")
        assert formula.count(r"\left") - formula.count(r"\leftarrow") == formula.count(r"\right")
        assert re.sub(r"\\text\{[^}]*\}", "", formula).isascii(), formula
        assert formula.count(r"\begin") == formula.count(r"\end")
    for row in (line for line in text.splitlines() if line.startswith("|")):
        assert len(re.findall(r"(?<!\\)\|", row)) in (4, 6), row


def test_the_page_names_no_number_that_changes_with_the_machine() -> None:
    text = command.PAGE.read_text(encoding="utf-8")
    assert "e-16" not in text
    assert "nan" not in text.split()


def test_docstrings_cite_entries_that_exist() -> None:
    names = {f"{paper} {equation}" for paper, equations in EQUATIONS.items() for equation in equations} | set(
        CLAIMS
    )
    cited = []
    for file in (command.PAGE.parent.parent / "armik_sym").rglob("*.py"):
        for text in re.findall(r"ledger: ([^;)]*?)(?:[;)]|\.\n)", file.read_text(encoding="utf-8")):
            words = " ".join(text.split())
            cited += [part.strip() for part in re.split(r",| and (?=nguyen2021|alfaiz)", words)]
    assert len(cited) > 8
    assert not [name for name in cited if name not in names]
