"""The ledger: every verdict is reached by the check itself, and the checker is able to fail."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
import sympy as sp

from derivations.__main__ import main
from derivations.claim import Claim, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.from_casadi import to_sympy
from derivations.identity import Identity
from derivations.ledger import all_claims
from derivations.random_points import first_difference, largest_difference

CLAIMS = {f"{claim.paper} {claim.equation}": claim for claim in all_claims()}
IDENTITIES = [name for name, claim in CLAIMS.items() if isinstance(claim.body, Identity)]


@pytest.mark.parametrize("name", CLAIMS)
def test_the_check_reaches_the_verdict_of_the_ledger(name: str) -> None:
    claim = CLAIMS[name]
    evidence = claim.check()
    assert evidence.verdict is claim.verdict
    if claim.verdict in (Verdict.CORRECTED, Verdict.FALSE):
        assert evidence.counterexample, "a misprint comes with numbers that show it"
    if claim.verdict is Verdict.CORRECTED:
        assert claim.correction


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
    claim: Claim = CLAIMS[name]
    body = claim.body
    assert isinstance(body, Identity)
    right = body.printed if body.corrected is None else body.corrected
    for wrong in mutants(right):
        if all(is_exactly_zero(a - b) for a, b in zip(wrong, right, strict=True)):
            continue
        printed = wrong if body.corrected is None else body.printed
        corrected = None if body.corrected is None else wrong
        assert Identity(printed, body.derived, corrected).check().verdict is Verdict.FALSE


@pytest.mark.parametrize("name", IDENTITIES)
def test_numbers_agree_with_the_proof(name: str) -> None:
    body = CLAIMS[name].body
    assert isinstance(body, Identity)
    right = body.printed if body.corrected is None else body.corrected
    symbols = sorted(right.free_symbols | body.derived.free_symbols, key=str)
    rng = np.random.default_rng(3)
    for point in rng.uniform(-3, 3, (5, len(symbols))):
        values = dict(zip(symbols, point, strict=True))
        difference = sp.N((right - body.derived).subs(values), 30)
        assert max(abs(complex(entry)) for entry in difference) < 1e-9


def test_exact_zero_knows_identities_from_near_misses() -> None:
    a, b = sp.symbols("a b")
    assert is_exactly_zero(sp.sin(a + b) - sp.sin(a) * sp.cos(b) - sp.cos(a) * sp.sin(b))
    assert is_exactly_zero((1 - sp.cos(a) ** 2) / sp.sin(a) - sp.sin(a))
    assert not is_exactly_zero(sp.sin(a) ** 2 + sp.cos(a) ** 2 - 1 - sp.Rational(1, 10**12))
    assert not is_exactly_zero(sp.sin(a) - sp.sin(b))
    with pytest.raises(ValueError, match="expected a symbol"):
        is_exactly_zero(sp.sin(a**2))


def test_casadi_expressions_arrive_in_sympy_unchanged() -> None:
    x = ca.SX.sym("x", 2)
    matrix = ca.vertcat(
        ca.horzcat(ca.sin(x[0]) * x[1] ** 2, 0.1 - x[0] / x[1]), ca.horzcat(-ca.cos(x[1]), 2 * x[0])
    )
    a, b = sp.symbols("a b")
    there = to_sympy(matrix, [x], [[a, b]])
    expected = sp.Matrix([[sp.sin(a) * b**2, sp.Rational(1, 10) - a / b], [-sp.cos(b), 2 * a]])
    assert sp.simplify(there - expected) == sp.zeros(2, 2)


def test_differences_are_found_and_measured() -> None:
    a = sp.Symbol("a")
    left, right = sp.Matrix([[sp.sin(a), a]]), sp.Matrix([[sp.sin(a), a + sp.Rational(1, 4)]])
    assert 0.2 < largest_difference(left, right) <= 0.25
    found = first_difference(left, right)
    assert found is not None
    assert found.entry == (0, 1)
    assert found.true - found.printed == pytest.approx(0.25)
    assert first_difference(left, left) is None


def test_the_command_prints_the_ledger(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--explain"]) == 0
    text = capsys.readouterr().out
    assert all(claim.title in text for claim in CLAIMS.values())
    assert "counterexample: " in text
    assert main(["--equation", "3"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 1
