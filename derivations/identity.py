"""Claims that two trigonometric expressions are the same function: proved exactly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from derivations.claim import Evidence, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.random_points import first_difference, largest_difference

_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Identity:
    """An equation between trigonometric expressions: printed side against derived side.

    Attributes:
        printed: What the paper prints, SymPy matrix (1 x 1 for a scalar).
        derived: The same quantity from the DH chain through `armik_sym.symbolic`, SymPy matrix.
        corrected: The printed form with the smallest correction, or None if none is needed.
        extracted: What the stored text of the paper literally says where it differs from `printed`, the
            reading used; None if the text is undamaged.
        symbol: LaTeX of the left side.
        roots: For every symbol that stands for a square root, the expression it is the root of.
    """

    printed: sp.Matrix
    derived: sp.Matrix
    corrected: sp.Matrix | None = None
    extracted: sp.Matrix | None = None
    symbol: str = ""
    roots: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def check(self) -> Evidence:
        """Prove the printed form, or else the corrected one, exactly and again in numbers."""
        damage = self._damage()
        if self._proved(self.printed):
            return Evidence(Verdict.HOLDS, _words(self.derived) + damage)
        counterexample = str(first_difference(self.printed, self.derived, self.roots))
        if self.corrected is not None and self._proved(self.corrected):
            words = "Corrected form: " + _words(self.derived) + damage
            return Evidence(Verdict.CORRECTED, words, counterexample)
        return Evidence(
            Verdict.FALSE, "the difference has a remainder that is not zero" + damage, counterexample
        )

    def printed_formulas(self) -> tuple[Formula, ...]:
        """The printed matrix, or the printed scalar."""
        return (Formula(self.symbol, _scalar_or_matrix(self.printed)),)

    def corrected_formulas(self) -> tuple[Formula, ...]:
        """The entries that had to be corrected."""
        if self.corrected is None:
            return ()
        if len(self.corrected) == 1:
            return (Formula(self.symbol, self.corrected[0]),)
        return tuple(
            Formula(f"{self.symbol}_{{{i + 1}{j + 1}}}", self.corrected[i, j])
            for i in range(self.corrected.rows)
            for j in range(self.corrected.cols)
            if self.corrected[i, j] != self.printed[i, j]
        )

    def _proved(self, form: sp.Matrix) -> bool:
        if form.shape != self.derived.shape:
            return False
        pairs = zip(form, self.derived, strict=True)
        return (
            all(is_exactly_zero(a - b, self.roots) for a, b in pairs)
            and largest_difference(form, self.derived, self.roots, relative=True) < _ROUNDING
        )

    def _damage(self) -> str:
        if self.extracted is None:
            return ""
        found = first_difference(self.extracted, self.derived, self.roots)
        return f"; the stored text, read literally, fails: {found}"


def _scalar_or_matrix(matrix: sp.Matrix) -> sp.Expr | sp.Matrix:
    return matrix[0] if len(matrix) == 1 else matrix


def _words(matrix: sp.Matrix) -> str:
    n = len(matrix)
    return (
        f"{n} {'entry' if n == 1 else 'entries'} reduced to zero over the rationals modulo s² + c² = 1, "
        f"and below {_ROUNDING:g} at 1,000 random points in CasADi"
    )
