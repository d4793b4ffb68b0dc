"""Al-Faiz, eq. (21): r from the sine, which takes a sign, and what (20) and (21) do together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import sympy as sp
from sympy import atan, atan2, cos, pi, sin, sqrt

from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.random_points import evaluate

PAPER = "alfaiz"
_dx, _dz = sp.symbols("dx dz", real=True)
_x, _z = sp.symbols("dx dz", real=True, nonzero=True)
_POINTS = 1_000
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Polar:
    """A way to get the azimuth σ = θ1 + φ and r from dx and dz.

    Attributes:
        azimuth: σ where dz ≠ 0.
        azimuth_dz_zero: σ where dz = 0.
        radius: r, in dx, dz and the symbol sigma.
    """

    azimuth: sp.Expr
    azimuth_dz_zero: sp.Expr
    radius: sp.Expr

    def misses(self, dx: sp.Expr, dz: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """By how much (17) and (18) are missed.

        Args:
            dx: x of the wrist, a number or a symbol that is not zero.
            dz: z of the wrist.

        Returns:
            r·sin σ + dx and r·cos σ - dz, simplified.

        Source:
            Al-Faiz, eq. 17-18.
        """
        at = {_dx: dx, _dz: dz}
        azimuth = (self.azimuth_dz_zero if dz == 0 else self.azimuth).subs(at)
        radius = self.radius.subs(at).subs(SIGMA, azimuth)
        return sp.simplify(radius * sin(azimuth) + dx), sp.simplify(radius * cos(azimuth) - dz)

    def is_right(self, dx: sp.Expr, dz: sp.Expr) -> bool:
        """Whether (17) and (18) both hold exactly.

        Args:
            dx: x of the wrist, a number or a symbol that is not zero.
            dz: z of the wrist.

        Returns:
            True if they do.

        Source:
            Al-Faiz, eq. 17-18.
        """
        return self.misses(dx, dz) == (0, 0)

    def largest_miss(self) -> float:
        """Largest miss of (17) and (18) at random points, through CasADi.

        Returns:
            The miss, NaN if one is not a number.

        Source:
            None (random testing).
        """
        points = np.random.default_rng(0).uniform(-1, 1, (_POINTS, 2))
        radius = self.radius.subs(SIGMA, self.azimuth)
        forms = (radius * sin(self.azimuth) + _dx, radius * cos(self.azimuth) - _dz)
        return float(max(np.abs(evaluate(form, [_dx, _dz], points)).max() for form in forms))


SIGMA = sp.Symbol("sigma", real=True)
PRINTED = Polar(atan(-_dx / _dz), -pi / 2, -_dx / sin(SIGMA))
CORRECTED = Polar(atan2(-_dx, _dz), atan2(-_dx, _dz), sqrt(_dx**2 + _dz**2))


def check_radius(printed: Polar, corrected: Polar) -> Evidence:
    """Whether σ and r meet (17) and (18): in general, on both axes, and without jumps.

    Args:
        printed: Eq. (20) and (21).
        corrected: Their corrections.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 17-21.
    """
    general = printed.is_right(_x, _z) and printed.largest_miss() < _ROUNDING
    on_x = all(printed.is_right(sp.Integer(x), sp.Integer(0)) for x in (-1, 1))
    on_z = all(printed.is_right(sp.Integer(0), sp.Integer(z)) for z in (-1, 1))
    if general and on_x and on_z:
        return Evidence(Verdict.HOLDS, "(17) and (18) hold exactly for all dx, dz")
    mended = (
        corrected.is_right(_x, _z)
        and all(corrected.is_right(sp.Integer(x), sp.Integer(0)) for x in (-1, 1))
        and all(corrected.is_right(sp.Integer(0), sp.Integer(z)) for z in (-1, 1))
        and corrected.largest_miss() < _ROUNDING
    )
    if not general or not mended:
        return Evidence(Verdict.FALSE, "(17) and (18) are not met", _where(printed))
    words = "" if on_x else "not "
    return Evidence(
        Verdict.CORRECTED,
        "printed (20) with printed (21): (17) and (18) hold exactly for dx ≠ 0, dz ≠ 0, where r has the sign "
        f"of dz, and {words}for dz = 0, where r = dx; the corrected pair meets them exactly everywhere; both "
        "checked again at 1,000 random points in CasADi",
        "dx = 0, dz = 1: the printed σ is 0 and r is 0/0; the true r is 1. " + _jump(printed),
    )


def _where(printed: Polar) -> str:
    return f"dx = 1, dz = 2: (17) and (18) are missed by {printed.misses(sp.Integer(1), sp.Integer(2))}"


def _jump(printed: Polar) -> str:
    """Both sides of dz = 0."""
    small = sp.Rational(1, 10**9)
    found = []
    for z in (small, -small):
        azimuth = printed.azimuth.subs({_dx: 1, _dz: z})
        radius = printed.radius.subs({_dx: 1, _dz: z}).subs(SIGMA, azimuth)
        found.append(f"σ = {float(azimuth):.4f}, r = {float(radius):.4f} for dz = {float(z):g}")
    return "At dx = 1 the printed pair jumps: " + ", but ".join(found)


CLAIMS = (
    Claim(
        PAPER,
        "21",
        "r",
        Verdict.CORRECTED,
        "The printed r comes out negative for dz < 0, and this undoes the lost quadrants of (20): used "
        "together, (20) and (21) satisfy (17) and (18). Two defects remain: r is 0/0 for dx = 0, and when a "
        "path crosses dz = 0 at constant φ, r changes its sign and θ1 jumps by half a turn, so the arm jumps "
        "to another posture.",
        Check(
            lambda: check_radius(PRINTED, CORRECTED),
            printed=(Formula("r", PRINTED.radius.subs(SIGMA, sum(sp.symbols("theta_1 varphi")))),),
            corrected=(Formula("r", CORRECTED.radius),),
        ),
        derivation="Eq. (17) solved for r. Mixing one printed and one corrected formula is what really goes "
        "wrong: atan2 with (21) fails for dx = 0 only, but the printed arc tangent with r = sqrt(dx² + dz²) "
        "puts the wrist on the opposite side for dz < 0.",
        correction="r = sqrt(dx² + dz²), together with atan2 in (20)",
        fault=Fault.BRANCH,
    ),
)
