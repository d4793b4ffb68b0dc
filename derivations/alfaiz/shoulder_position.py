"""Al-Faiz, eq. (7) to (12) and (23): the wrist position in the shoulder angles."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp
from sympy import cos, pi, sin

from derivations.alfaiz.chain import L3, L4, Q, frame
from derivations.alfaiz.facts import IdentityWithFacts
from derivations.alfaiz.letters import in_letters
from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.identity import Identity
from derivations.random_points import first_difference

PAPER = "alfaiz"
_q1, _q2, _q3, _q4 = Q[:4]
DX, DY, DZ, K1, K2 = sp.symbols("dx dy dz k_1 k_2", real=True)
_OFFSET = {_q2: _q2 + pi / 2}

# Which angle stands behind each subscript of eq. (7) and (8) that text extraction has damaged.
Reading = tuple[int, int, int]
AS_STORED: Reading = (2, 2, 2)
AS_READ: Reading = (3, 3, 2)


def printed_dx(reading: Reading = AS_READ) -> sp.Expr:
    """Eq. (7): -l3·(c4·(s1·s? + c1·c?·s?) + c1·c2·s4) - l4·(s1·s? + c1·c?·s?), q without offset.

    Args:
        reading: The three subscripts marked ?.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 7.
    """
    i, j, k = (Q[n - 1] for n in reading)
    pair = sin(_q1) * sin(i) + cos(_q1) * cos(j) * sin(k)
    return -L3 * (cos(_q4) * pair + cos(_q1) * cos(_q2) * sin(_q4)) - L4 * pair


def printed_dz(reading: Reading = AS_READ) -> sp.Expr:
    """Eq. (8): l3·(c4·(c1·s? - c?·s1·s?) - c2·s1·s4) + l4·(c1·s? - c?·s1·s?), q without offset.

    Args:
        reading: The three subscripts marked ?.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 8.
    """
    i, j, k = (Q[n - 1] for n in reading)
    pair = cos(_q1) * sin(i) - cos(j) * sin(_q1) * sin(k)
    return L3 * (cos(_q4) * pair - cos(_q2) * sin(_q1) * sin(_q4)) + L4 * pair


def printed_dy() -> sp.Expr:
    """Eq. (23) as printed, q without offset.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, eq. 23.
    """
    return L3 * (sin(_q2) * sin(_q4) - cos(_q2) * cos(_q3) * cos(_q4)) - L4 * cos(_q2) * cos(_q3)


def k1(third: sp.Symbol = _q3) -> sp.Expr:
    """The first of the two abbreviations.

    Args:
        third: The angle read for the damaged subscripts.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, second eq. 9.
    """
    return L3 * cos(_q4) * sin(third) + L4 * sin(third)


def k2(third: sp.Symbol = _q3) -> sp.Expr:
    """The second of the two abbreviations.

    Args:
        third: The angle read for the damaged subscripts.

    Returns:
        SymPy expression.

    Source:
        Al-Faiz, second eq. 10.
    """
    c, s = cos(third), sin(_q2)
    return L3 * cos(_q4) * c * s + L3 * cos(_q2) * sin(_q4) + L4 * c * s


def regrouped(first: sp.Expr, second: sp.Expr) -> sp.Matrix:
    """(-dx, dz) as s1·first + c1·second and c1·first - s1·second.

    Args:
        first: k1 or what stands for it.
        second: k2 or what stands for it.

    Returns:
        SymPy matrix of shape (2, 1).

    Source:
        Al-Faiz, eq. 9-12.
    """
    s, c = sin(_q1), cos(_q1)
    return sp.Matrix([s * first + c * second, c * first - s * second])


def derived_k() -> sp.Matrix:
    """What k1 and k2 must be: dz and -dx of the chain with the first joint at zero.

    Returns:
        SymPy matrix of shape (2, 1).

    Source:
        Al-Faiz, eq. 11-12 at θ1 = 0, through `armik_sym.symbolic`.
    """
    p = frame(5)[:3, 3].subs(_q1, 0)
    return sp.Matrix([p[2], -p[0]])


def of_the_arm(names: sp.Matrix) -> sp.Matrix:
    """What stands behind the names dx, dy, dz, k1 and k2.

    Args:
        names: SymPy matrix in these names.

    Returns:
        The same in the angles and lengths of the chain.

    Source:
        Al-Faiz, eq. 3 and 11-12, through `armik_sym.symbolic`.
    """
    values = zip((DX, DY, DZ, K1, K2), (*frame(5)[:3, 3], *derived_k()), strict=True)
    return names.subs(dict(values), simultaneous=True)


def check_coordinate(
    form: Callable[[], sp.Expr], row: int, readings: Callable[[Reading], sp.Expr]
) -> Evidence:
    """A printed coordinate against the chain; every other reading of it; and θ2 with its offset.

    Args:
        form: The coordinate as read.
        row: 0 for x, 1 for y, 2 for z.
        readings: The coordinate for any choice of the damaged subscripts.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 7, 8 and 23.
    """
    true = frame(5)[row, 3]
    stored = sp.Matrix([readings(AS_STORED)])
    undamaged = stored == sp.Matrix([readings(AS_READ)])
    found = Identity(sp.Matrix([form()]), sp.Matrix([true]), extracted=None if undamaged else stored).check()
    if found.verdict is not Verdict.HOLDS:
        return found
    words = [found.proof]
    if not undamaged:
        every: list[Reading] = [(i, j, k) for i in range(1, 5) for j in range(1, 5) for k in range(1, 5)]
        right = [reading for reading in every if _holds(readings(reading), true)]
        if right != [AS_READ]:
            return Evidence(Verdict.FALSE, f"readings of the subscripts that hold: {right}", str(right))
        words.append(f"of the {len(every)} ways to fill in the three damaged subscripts no other holds")
    with_offset = Identity(sp.Matrix([form().subs(_OFFSET)]), sp.Matrix([true])).check()
    if with_offset.verdict is Verdict.HOLDS:
        return Evidence(Verdict.FALSE, "holds with and without the offset of θ2", "none needed")
    words.append(f"with θ2 = q2 + 90° as in A_2 it fails, {with_offset.counterexample}")
    return Evidence(Verdict.HOLDS, "; ".join(words))


def _holds(form: sp.Expr, true: sp.Expr) -> bool:
    """Exactly; a counterexample spares the proof."""
    left, right = sp.Matrix([form]), sp.Matrix([true])
    return first_difference(left, right) is None and is_exactly_zero(form - true)


def _stacked(third: sp.Symbol) -> sp.Matrix:
    k = sp.Matrix([k1(third), k2(third)])
    return sp.Matrix.vstack(regrouped(*k), k)


_NOT_SEEN = "Read with the subscripts that make it true; the print itself was not seen."
_OFFSET_WORDS = "Here θ2 is the joint variable q2, not the θ2 = q2 + 90° of Table 1 and A_2."

CLAIMS = (
    Claim(
        PAPER,
        "7",
        "x of the wrist",
        Verdict.HOLDS,
        "Holds, once the subscripts are read right. " + _OFFSET_WORDS,
        Check(
            lambda: check_coordinate(printed_dx, 0, printed_dx),
            printed=(Formula("dx", in_letters(printed_dx())),),
        ),
        derivation="Last column of A_1 … A_5; the wrist joints do not move their own centre.",
        extraction="Stored with s1·s2 + c1·c2·s2 for s1·s3 + c1·c3·s2 (twice). " + _NOT_SEEN,
    ),
    Claim(
        PAPER,
        "8",
        "z of the wrist",
        Verdict.HOLDS,
        "Holds, once the subscripts are read right. " + _OFFSET_WORDS,
        Check(
            lambda: check_coordinate(printed_dz, 2, printed_dz),
            printed=(Formula("dz", in_letters(printed_dz())),),
        ),
        derivation="As eq. (7).",
        extraction="Stored with c1·s2 - c2·s1·s2 for c1·s3 - c3·s1·s2 (twice). " + _NOT_SEEN,
    ),
    Claim(
        PAPER,
        "9-10",
        "x and z regrouped, and the abbreviations k1, k2",
        Verdict.HOLDS,
        "The numbers (9) and (10) are printed twice: first for -dx and dz regrouped, then for k1 and k2. "
        "All four hold; k1 does not contain θ2, which is what makes the method work.",
        IdentityWithFacts(
            _stacked(_q3),
            of_the_arm(sp.Matrix([-DX, DZ, K1, K2])),
            extracted=_stacked(_q2),
            names=sp.Matrix([-DX, DZ, K1, K2]),
        ),
        derivation="Eq. (7) and (8), sorted by s1 and c1. For k1 and k2 alone: dz and -dx at θ1 = 0.",
        extraction="All four rows stored with s2, c2 for s3, c3: the first (9) and (10), for -dx and dz, as "
        "well "
        "as k1 and k2. " + _NOT_SEEN,
    ),
    Claim(
        PAPER,
        "11-12",
        "x and z through k1 and k2",
        Verdict.HOLDS,
        "(k1, k2) are the horizontal coordinates of the wrist before joint 1 turns them: dz and -dx at "
        "θ1 = 0.",
        IdentityWithFacts(
            regrouped(k1(), k2()),
            of_the_arm(sp.Matrix([-DX, DZ])),
            names=sp.Matrix([-DX, DZ]),
            names_first=False,
            letters=lambda form: in_letters(form, {k2(): K2, k1(): K1}),
        ),
        derivation="Joint 1 turns about the vertical y axis. (The text says k1, k2 were put into (7), (8); "
        "it means the first (9), (10).)",
    ),
    Claim(
        PAPER,
        "23",
        "height of the wrist",
        Verdict.HOLDS,
        "Holds as stored. " + _OFFSET_WORDS,
        Check(
            lambda: check_coordinate(printed_dy, 1, lambda _: printed_dy()),
            printed=(Formula("dy", in_letters(printed_dy())),),
        ),
        derivation="As eq. (7).",
    ),
)
