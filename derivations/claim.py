"""A claim about one printed equation, and what checking it gives."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import sympy as sp


class Verdict(Enum):
    """What becomes of a printed equation."""

    HOLDS = "holds as printed"
    CORRECTED = "holds after correction"
    FALSE = "does not hold"
    DEFINITION = "definition"
    NOT_CHECKABLE = "not checkable"
    ADDED = "not in the paper, shown here"


class Fault(Enum):
    """What is wrong with an equation that needs a correction."""

    MISPRINT = "misprint"
    BRANCH = "lost quadrant or branch"
    WORDING = "wording"
    MODEL = "modelling"


@dataclass(frozen=True)
class Evidence:
    """What a check found; the same on every machine, so no measured rounding errors in the words.

    Attributes:
        verdict: The verdict that follows from the check itself, whatever the claim says.
        proof: How it was decided, in one or two sentences.
        counterexample: Numbers for which the printed form fails, in words; empty if it holds.
    """

    verdict: Verdict
    proof: str
    counterexample: str = ""


@dataclass(frozen=True, eq=False)
class Formula:
    r"""An equation to be read, left = right.

    Attributes:
        left: LaTeX of the left side, for example `B_{12}` or `\theta_5`.
        right: The right side: a SymPy expression or matrix, or LaTeX where SymPy has no words for it.
        relation: LaTeX of the sign between the two.
    """

    left: str
    right: sp.Expr | sp.Matrix | str
    relation: str = "="


class Body(Protocol):
    """A check that knows the formulas it is about."""

    def check(self) -> Evidence:
        """Reach a verdict."""

    def printed_formulas(self) -> tuple[Formula, ...]:
        """What the paper prints."""

    def corrected_formulas(self) -> tuple[Formula, ...]:
        """What it should have printed, only what differs; empty if nothing does."""


@dataclass(frozen=True, eq=False)
class Check:
    """A statement that is neither identity nor branch: ranges, algorithms, counts. Its own code checks it.

    Attributes:
        run: The check.
        printed: What the paper prints.
        corrected: What it should have printed; empty if nothing differs.
    """

    run: Callable[[], Evidence]
    printed: tuple[Formula, ...] = ()
    corrected: tuple[Formula, ...] = ()

    def check(self) -> Evidence:
        """Run the check."""
        return self.run()

    def printed_formulas(self) -> tuple[Formula, ...]:
        """What the paper prints."""
        return self.printed

    def corrected_formulas(self) -> tuple[Formula, ...]:
        """What it should have printed."""
        return self.corrected


@dataclass(frozen=True, eq=False)
class Claim:
    """One printed equation, what is true, and why.

    Attributes:
        paper: "nguyen2021" or "alfaiz".
        equation: Its number, "3", or "Table 4"; several equations handled as one: "28-29".
        title: What it says, in a few words.
        verdict: The verdict the ledger states; a test holds it against the check's own.
        summary: What is printed, what is true and what it means for a user, in one to three sentences.
        body: The check, or None for definitions and what cannot be checked.
        derivation: Where the derived side comes from, or how one gets from here to there, in words.
        correction: The smallest correction in words; empty if none is needed.
        extraction: Damage done by text extraction rather than by the printer, in words.
        definition: For claims without a body: what is printed.
        fault: What is wrong, for claims that need a correction.
    """

    paper: str
    equation: str
    title: str
    verdict: Verdict
    summary: str
    body: Body | None = None
    derivation: str = ""
    correction: str = ""
    extraction: str = ""
    definition: tuple[Formula, ...] = ()
    fault: Fault | None = None

    def check(self) -> Evidence:
        """What the check finds; definitions and what cannot be checked find themselves."""
        return _evidence(self)

    def printed_formulas(self) -> tuple[Formula, ...]:
        """What the paper prints."""
        return self.definition if self.body is None else self.body.printed_formulas()

    def corrected_formulas(self) -> tuple[Formula, ...]:
        """What it should have printed, only what differs."""
        return () if self.body is None else self.body.corrected_formulas()


@functools.cache
def _evidence(claim: Claim) -> Evidence:
    """Every claim is checked once per process, however often it is asked."""
    return Evidence(claim.verdict, "nothing to prove") if claim.body is None else claim.body.check()
