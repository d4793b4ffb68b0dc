"""A claim about one printed equation, and what checking it gives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum

import sympy as sp

from derivations.exact_zero import is_exactly_zero
from derivations.random_points import Counterexample, first_difference, largest_difference


class Verdict(Enum):
    """What becomes of a printed equation."""

    HOLDS = "holds as printed"
    CORRECTED = "holds after correction"
    FALSE = "does not hold"
    DEFINITION = "definition"
    NOT_CHECKABLE = "not checkable"


@dataclass(frozen=True)
class Evidence:
    """What a check found.

    Attributes:
        verdict: The verdict that follows from the check itself, whatever the claim says.
        proof: How it was decided, in one or two sentences.
        counterexample: Numbers for which the printed form fails, in words; empty if it holds.
    """

    verdict: Verdict
    proof: str
    counterexample: str = ""


@dataclass(frozen=True, eq=False)
class Identity:
    """An equation between trigonometric expressions: printed side against derived side.

    Attributes:
        printed: What the paper prints, SymPy matrix.
        derived: The same quantity from the DH chain through `armik_sym.symbolic`, SymPy matrix.
        corrected: The printed form with the smallest correction, or None if none is needed.
    """

    printed: sp.Matrix
    derived: sp.Matrix
    corrected: sp.Matrix | None = None

    def check(self) -> Evidence:
        """Prove the printed form, or else the corrected one, exactly and again in numbers."""
        if _proved(self.printed, self.derived):
            return Evidence(Verdict.HOLDS, _words(self.printed, self.derived))
        counterexample = first_difference(self.printed, self.derived)
        if self.corrected is not None and _proved(self.corrected, self.derived):
            words = _words(self.corrected, self.derived)
            return Evidence(Verdict.CORRECTED, words, _say(counterexample))
        return Evidence(
            Verdict.FALSE, "the difference has a remainder that is not zero", _say(counterexample)
        )


@dataclass(frozen=True, eq=False)
class Check:
    """A statement that is no identity: branches, ranges, algorithms. Checked by its own code."""

    run: Callable[[], Evidence]

    def check(self) -> Evidence:
        """Run the check."""
        return self.run()


@dataclass(frozen=True, eq=False)
class Claim:
    """One printed equation, what is true, and why.

    Attributes:
        paper: "nguyen2021" or "alfaiz".
        equation: Its number, "3", or "Table 4"; several equations handled as one: "28-29".
        title: What it says, in a few words.
        verdict: The verdict the ledger states; a test holds it against the check's own.
        summary: What is printed, what is true, in one or two sentences.
        body: The check, or None for definitions and what cannot be checked.
        correction: The smallest correction in words; empty if none is needed.
        extraction: Damage done by text extraction rather than by the printer, in words.
    """

    paper: str
    equation: str
    title: str
    verdict: Verdict
    summary: str
    body: Identity | Check | None = None
    correction: str = ""
    extraction: str = field(default="")

    def check(self) -> Evidence:
        """What the check finds; definitions and what cannot be checked find themselves."""
        return Evidence(self.verdict, "nothing to prove") if self.body is None else self.body.check()


def _proved(left: sp.Matrix, right: sp.Matrix) -> bool:
    return left.shape == right.shape and all(is_exactly_zero(a - b) for a, b in zip(left, right, strict=True))


def _words(left: sp.Matrix, right: sp.Matrix) -> str:
    n = len(left)
    return (
        f"{n} {'entry' if n == 1 else 'entries'} reduced to zero over the rationals modulo s² + c² = 1; "
        f"largest difference at 1,000 random points {largest_difference(left, right):.1e}"
    )


def _say(counterexample: Counterexample | None) -> str:
    return "" if counterexample is None else str(counterexample)
