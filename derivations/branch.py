"""Claims about inverse functions: which angle does a printed asin, acos or atan really return?

Such equations are no identities: a plain arc tangent loses two quadrants, an arc sine one branch. They are
checked with 50 digits over a grid that contains the boundaries, the quadrant borders and points next to them.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field

import mpmath
import numpy as np
import sympy as sp

from derivations.claim import Evidence, Formula, Verdict
from derivations.random_points import evaluate

DIGITS = 50
_GUARD = 15  # an arc sine next to 1 loses half the digits of what it is next to
_CLOSE = mpmath.mpf(10) ** -40
_CLOSE_IN_DOUBLE = 1e-6
_NEXT_TO = sp.Rational(1, 10**12)

Domain = Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]]


@dataclass(frozen=True, eq=False)
class Branch:
    """A printed inverse function against the angle it should return, modulo full turns.

    Attributes:
        symbol: LaTeX of the left side.
        printed: The printed formula, all quantities in it written through the true angles.
        true: The angle it should return.
        domain: For every symbol the interval all values of which may occur; closed.
        printed_domain: The part of it inside which the printed formula is right (open intervals); None:
            it is not needed or nowhere. Symbols left out range over their domain.
        corrected: The formula that is right in the whole domain; None if the printed one is.
        printed_text: What to show as printed (in the paper's letters); None shows `printed`.
        corrected_text: What to show as corrected.
        inputs: What the printed formula takes, by name, written through the symbols; counterexamples are
            given in these. Empty: in the symbols themselves.
        points: Evenly spread grid points per symbol; at least 101 for one symbol, 15 for two.
    """

    symbol: str
    printed: sp.Expr
    true: sp.Expr
    domain: Domain
    printed_domain: Domain | None = None
    corrected: sp.Expr | None = None
    printed_text: sp.Expr | str | None = None
    corrected_text: sp.Expr | str | None = None
    inputs: Mapping[str, sp.Expr] = field(default_factory=dict)
    points: int = 9

    def check(self) -> Evidence:
        """Compare with 50 digits on the grid, and in double precision through CasADi inside it."""
        miss = self._first_miss(self.printed, self.domain)
        count = len(list(itertools.product(*self._grids(self.domain))))
        if miss is None:
            return Evidence(Verdict.HOLDS, f"with {DIGITS} digits at {count} points, boundaries included")
        right_inside = self.printed_domain is not None and not self._first_miss(
            self.printed, {**self.domain, **_opened(self.printed_domain)}
        )
        where = f"; the printed form is right for {_interval(self.printed_domain)}" if right_inside else ""
        if self.printed_domain is not None and not right_inside:
            return Evidence(Verdict.FALSE, "not even right where it is said to be", miss)
        if self.corrected is None or self._first_miss(self.corrected, self.domain) is not None:
            return Evidence(Verdict.FALSE, f"fails with {DIGITS} digits{where}", miss)
        proof = f"Corrected form: with {DIGITS} digits at {count} points, boundaries included{where}"
        return Evidence(Verdict.CORRECTED, proof, miss)

    def printed_formulas(self) -> tuple[Formula, ...]:
        """The printed inverse function."""
        return (Formula(self.symbol, self.printed if self.printed_text is None else self.printed_text),)

    def corrected_formulas(self) -> tuple[Formula, ...]:
        """The one that keeps every quadrant."""
        shown = self.corrected if self.corrected_text is None else self.corrected_text
        return () if shown is None else (Formula(self.symbol, shown),)

    def _first_miss(self, form: sp.Expr, domain: Domain) -> str | None:
        symbols = list(domain)
        with mpmath.workdps(DIGITS + _GUARD):
            value = sp.lambdify(symbols, form, "mpmath")
            true = sp.lambdify(symbols, self.true, "mpmath")
            for point in itertools.product(*self._grids(domain)):
                numbers = [mpmath.mpf(sp.N(x, DIGITS)) for x in point]
                try:
                    found = value(*numbers)
                except ZeroDivisionError:
                    return f"at {self._named(symbols, point)}: a division by zero"
                wanted = true(*numbers)
                if abs(_turned(found - wanted)) > _CLOSE:
                    return (
                        f"at {self._named(symbols, point)}: printed {_number(found)}, true {_number(wanted)} "
                        "(modulo full turns)"
                    )
        return self._first_miss_in_double(form, domain)

    def _grids(self, domain: Domain) -> list[list[sp.Expr]]:
        points = max(self.points, {1: 101, 2: 15}.get(len(domain), 0))
        return [_grid(low, high, points) for low, high in domain.values()]

    def _named(self, symbols: list[sp.Symbol], point: tuple[sp.Expr, ...]) -> str:
        values = dict(zip(symbols, point, strict=True))
        shown = self.inputs or {str(symbol): symbol for symbol in symbols}
        return ", ".join(f"{name} = {_number(sp.N(x.subs(values), 20))}" for name, x in shown.items())

    def _first_miss_in_double(self, form: sp.Expr, domain: Domain) -> str | None:
        symbols = list(domain)
        bounds = np.array([[float(low), float(high)] for low, high in domain.values()])
        points = np.random.default_rng(0).uniform(bounds[:, 0], bounds[:, 1], (1_000, len(symbols)))
        off = evaluate(form, symbols, points) - evaluate(self.true, symbols, points)
        wrong = ~(np.abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi) < _CLOSE_IN_DOUBLE)
        return f"in double precision at {points[np.argmax(wrong)]}" if wrong.any() else None


def _grid(low: sp.Expr, high: sp.Expr, points: int) -> list[sp.Expr]:
    """Evenly spread points, the ends, every border of a quadrant, and what is next to these.

    Round numbers come first, so that counterexamples are easy to type.
    """
    inner = [low + (high - low) * sp.Rational(k, points + 1) for k in range(1, points + 1)]
    first, last = (int(sp.floor(end / (sp.pi / 2))) for end in (low, high))
    borders = [k * sp.pi / 2 for k in range(first, last + 1) if low < k * sp.pi / 2 < high]
    beside = [border + side for border in borders for side in (-_NEXT_TO, _NEXT_TO)]
    return [*inner, *borders, *beside, low, low + _NEXT_TO, high - _NEXT_TO, high]


def _opened(domain: Domain) -> Domain:
    """Without the ends, where an arc tangent may take either side."""
    return {symbol: (low + _NEXT_TO, high - _NEXT_TO) for symbol, (low, high) in domain.items()}


def _turned(angle: mpmath.mpf) -> mpmath.mpf:
    return angle - 2 * mpmath.pi * mpmath.nint(angle / (2 * mpmath.pi))


def _number(value: object) -> str:
    return mpmath.nstr(mpmath.mpf(str(value)), 6)


def _interval(domain: Domain | None) -> str:
    return ", ".join(f"{low} < {symbol} < {high}" for symbol, (low, high) in (domain or {}).items())
