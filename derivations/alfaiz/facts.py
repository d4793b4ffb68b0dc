"""Claims that rest on more than one finding: a body that proves further facts along the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

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
    """An identity, and what else the claim says.

    Attributes:
        facts: What else is checked.
        shown: What to show as printed, in the paper's letters; empty shows `printed`.
        shown_corrected: What to show as corrected; empty shows `corrected`.
    """

    facts: tuple[Fact, ...] = ()
    shown: tuple[Formula, ...] = ()
    shown_corrected: tuple[Formula, ...] = ()

    def check(self) -> Evidence:
        """Prove the identity, then the facts."""
        return with_facts(super().check(), self.facts)

    def printed_formulas(self) -> tuple[Formula, ...]:
        """The printed equation, in the paper's letters."""
        return self.shown or super().printed_formulas()

    def corrected_formulas(self) -> tuple[Formula, ...]:
        """The corrected equation, in the paper's letters."""
        return self.shown_corrected or super().corrected_formulas()


@dataclass(frozen=True, eq=False)
class BranchWithFacts(Branch):
    """A branch equation, and what else the claim says.

    Attributes:
        facts: What else is checked.
    """

    facts: tuple[Fact, ...] = ()

    def check(self) -> Evidence:
        """Check the branches, then the facts."""
        return with_facts(super().check(), self.facts)
