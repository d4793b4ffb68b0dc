"""Claims that rest on more than one finding: a body that proves further facts along the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import sympy as sp

from derivations.alfaiz.exact_borders import Posture, with_borders, with_example
from derivations.alfaiz.letters import in_letters
from derivations.branch import Branch
from derivations.claim import Evidence, Formula, Verdict
from derivations.identity import Identity


@dataclass(frozen=True, eq=False)
class Fact:
    """Something the words of a claim say, and the machine checks.

    Attributes:
        words: What is said.
        holds: Whether it is true.
    """

    words: str
    holds: Callable[[], bool]


def with_facts(evidence: Evidence, facts: tuple[Fact, ...]) -> Evidence:
    """Evidence with what else was found; a fact that fails turns the verdict.

    Args:
        evidence: What the main check found.
        facts: What else is to be true.

    Returns:
        The evidence, its proof followed by the words of every fact; or the verdict FALSE, naming the first
        fact that is not true.

    Source:
        None (bookkeeping).
    """
    for fact in facts:
        if not fact.holds():
            return replace(evidence, verdict=Verdict.FALSE, proof=f"not true: {fact.words}")
    return replace(evidence, proof="; ".join([evidence.proof, *(fact.words for fact in facts)]))


@dataclass(frozen=True, eq=False)
class IdentityWithFacts(Identity):
    """An identity, and what else the claim says; shown in the paper's letters.

    Attributes:
        facts: What else is checked.
        example: A counterexample in the formula's own inputs, computed; None: the first of a grid.
        names: What every entry of `printed` is said to be, in the paper's names, same shape; None: nothing.
        names_first: Whether the paper puts the names before the equals sign.
        letters: How `printed` is written with the paper's letters.
        shown: What to show as printed where that cannot be made from `printed`; empty shows `printed`.
        shown_corrected: What to show as corrected; empty shows `corrected`.
    """

    facts: tuple[Fact, ...] = ()
    example: Callable[[], str] | None = None
    names: sp.Matrix | None = None
    names_first: bool = True
    letters: Callable[[sp.Matrix], sp.Matrix] = in_letters
    shown: tuple[Formula, ...] = ()
    shown_corrected: tuple[Formula, ...] = ()

    def check(self) -> Evidence:
        """Prove the identity, then the facts."""
        found = super().check()
        if self.example is not None and found.counterexample:
            found = replace(found, counterexample=self.example())
        return with_facts(found, self.facts)

    def printed_formulas(self) -> tuple[Formula, ...]:
        """The printed equation, in the paper's letters."""
        if self.shown:
            return self.shown
        forms = self.letters(self.printed)
        if self.names is None:
            return (Formula(self.symbol, forms[0] if len(forms) == 1 else forms),)
        pairs = zip(self.names, forms, strict=True)
        if self.names_first:
            return tuple(Formula(sp.latex(name), form) for name, form in pairs)
        return tuple(Formula(sp.latex(form), name) for name, form in pairs)

    def corrected_formulas(self) -> tuple[Formula, ...]:
        """The corrected equation, in the paper's letters."""
        return self.shown_corrected or super().corrected_formulas()


@dataclass(frozen=True, eq=False)
class BranchWithFacts(Branch):
    """A branch equation, and what else the claim says.

    Attributes:
        facts: What else is checked.
        borders: Postures in which a denominator of the printed form is exactly zero.
        example: A posture in round numbers at which the printed form fails; None: the first of a grid.
    """

    facts: tuple[Fact, ...] = ()
    borders: tuple[Posture, ...] = ()
    example: Posture | None = None

    def check(self) -> Evidence:
        """Check the branches, exactly where rounding hides a case, then the facts."""
        found = with_example(self, super().check(), self.example)
        return with_facts(with_borders(self, found, self.borders), self.facts)
