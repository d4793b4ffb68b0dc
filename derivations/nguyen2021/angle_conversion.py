"""Nguyen 2021, §2.3, eq. (8): from device angles to human angles, and what these formulas really solve."""

from __future__ import annotations

import itertools

import casadi as ca
import numpy as np
import sympy as sp
from sympy import acos, atan2, cos, sin, sqrt

from armik_sym.symbolic.elbow_direction import (
    device_elbow_direction,
    device_to_human,
    human_elbow_direction,
    shoulder_angles,
)
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.exact_zero import is_exactly_zero
from derivations.nguyen2021.elbow_direction import P, device_B, human_C
from derivations.nguyen2021.printed_conversion import Conversion, conversion, q1, q2, q3, root_2, under_root_1
from derivations.random_points import evaluate

PAPER = "nguyen2021"

H = sp.diag(-1, 1, -1)
_IDENTITY = sp.eye(3)
_TARGETS = {
    "B = C": (_IDENTITY, _IDENTITY),
    "B H = C": (_IDENTITY, H),
    "H B = C": (H, _IDENTITY),
    "H B H = C": (H, H),
}
_CLOSE = 1e-6

# w = |sin q'2|, the root that everything reduces to.
w = sp.Symbol("w", positive=True)
ROOTS = {w: 1 - sin(q1) ** 2 * cos(q2) ** 2}


def printed() -> Conversion:
    """Eq. (8) as printed.

    Returns:
        The arguments of its three arc tangents.

    Source:
        Nguyen 2021, eq. 8.
    """
    return conversion(sqrt(under_root_1(2)), root_2())


def corrected() -> Conversion:
    """Eq. (8) with tan(q1/2) instead of its square in the two products under the root of q'1.

    Returns:
        The arguments of its three arc tangents.

    Source:
        Nguyen 2021, eq. 8, corrected.
    """
    return conversion(sqrt(under_root_1(1)), root_2())


def proves(reading: Conversion, target: sp.Matrix) -> bool:
    """Whether -2 atan of a reading, its roots written with w, solves C(q') = target, proved exactly.

    tan(q'/2) = -x says x (1 + cos q') + sin q' = 0 and x sin q' + 1 - cos q' = 0, with the cosines and sines
    read off the target: cos q'2 = t22, sin q'2 = -w, and so on.

    Args:
        reading: Arguments x of the arc tangents, rational in tangents and w.
        target: The matrix to reach, SymPy matrix of shape (3, 3).

    Returns:
        True if all six relations and the nine entries of C reduce to zero over the rationals.

    Source:
        Nguyen 2021, eq. 7-8.
    """
    cosines = (-target[0, 1] / w, target[1, 1], target[1, 0] / w)
    sines = (-target[2, 1] / w, -w, -target[1, 2] / w)
    relations = [
        relation
        for x, c, s in zip((reading.x1, reading.x2, reading.x3), cosines, sines, strict=True)
        for relation in (x * (1 + c) + s, x * s + 1 - c)
    ]
    values = {cos(p): c for p, c in zip(P, cosines, strict=True)}
    values |= {sin(p): s for p, s in zip(P, sines, strict=True)}
    entries = list(human_C().subs(values, simultaneous=True) - target)
    return all(is_exactly_zero(zero, ROOTS) for zero in relations + entries)


def rational(power: int = 1) -> Conversion:
    """Corrected eq. (8) with both roots taken: they are w·(1 + t²)(1 + u²) and w / (cos²(q1/2) (1 + sin q2)).

    Args:
        power: Factor of ±1 in front of the first root.

    Returns:
        The arguments, rational in tangents and w.

    Source:
        Nguyen 2021, eq. 8.
    """
    t, u = sp.tan(q1 / 2), sp.tan(q2 / 2 - sp.pi / 4)
    return conversion(power * w * (1 + t**2) * (1 + u**2), w / (cos(q1 / 2) ** 2 * (1 + sin(q2))))


def roots_are_w() -> bool:
    """Whether the squares of both roots are those of the forms `rational` uses; all factors are positive.

    Returns:
        True if proved.

    Source:
        Nguyen 2021, eq. 8.
    """
    t, u = sp.tan(q1 / 2), sp.tan(q2 / 2 - sp.pi / 4)
    first = under_root_1(1) - w**2 * (1 + t**2) ** 2 * (1 + u**2) ** 2
    second = root_2() ** 2 - w**2 / (cos(q1 / 2) ** 4 * (1 + sin(q2)) ** 2)
    return is_exactly_zero(first, ROOTS) and is_exactly_zero(second, ROOTS)


def solved_by(exponent: int, sign_of_root: int, sign_of_q2: int) -> list[str]:
    """Which of the four conditions B = C, B H = C, H B = C, H B H = C a reading of (8) satisfies, in numbers.

    Args:
        exponent: Power of tan(q1/2) in the products under the root of q'1: 2 as printed, or 1.
        sign_of_root: Sign in front of that root, +1 as printed.
        sign_of_q2: Sign of q'2, -1 as printed.

    Returns:
        The conditions that hold at 300 random postures.

    Source:
        Nguyen 2021, eq. 8.
    """
    angles = conversion(sign_of_root * sqrt(under_root_1(exponent)), root_2()).angles()
    angles[1] *= -sign_of_q2
    points = np.random.default_rng(5).uniform(-3, 3, (300, 3))
    found = np.stack([evaluate(angle, [q1, q2, q3], points) for angle in angles])
    q, p = ca.SX.sym("q", 3), ca.SX.sym("p", 3)
    B, C = device_elbow_direction(q), human_elbow_direction(p)
    hold = []
    for name, (left, right) in _TARGETS.items():
        sides = [ca.DM(np.array(side, dtype=float)) for side in (left, right)]
        miss = ca.norm_fro(sides[0] @ B @ sides[1] - C)
        values = np.asarray(ca.Function("miss", [q, p], [miss])(points.T, found))
        if np.abs(values).max() < _CLOSE:
            hold.append(name)
    return hold


def agrees_with_simplified(reading: Conversion) -> bool:
    """Whether a reading gives the angles of the atan2 form, and that of `armik_sym.elbow`.

    Args:
        reading: Arguments of the arc tangents.

    Returns:
        True if so at 1,000 random postures, modulo full turns.

    Source:
        Nguyen 2021, eq. 8.
    """
    symbols = [q1, q2, q3]
    points = np.random.default_rng(6).uniform(-3, 3, (1_000, 3))
    wanted = np.stack([evaluate(angle, symbols, points) for angle in reading.angles()])
    shown = np.stack([evaluate(formula.right, symbols, points) for formula in simplified()])
    q = ca.SX.sym("q", 3)
    shipped = np.asarray(ca.Function("shipped", [q], [device_to_human(q, ca.SX(0))])(points.T))[:3]
    off = np.remainder(wanted - np.stack([shown, shipped]) + np.pi, 2 * np.pi) - np.pi
    return bool(np.abs(off).max() < _CLOSE)


def undefined_where_stated(reading: Conversion) -> bool:
    """Whether the half-angle form is 0/0 exactly where the ledger says.

    q'1: 0/0 at q2 = 0, cos q1 > 0, as its denominator is (1 + t²)(1 + u²) sin q2. q'3: it divides by B23,
    which is w·sin q'3. tan(q1/2) has its pole at 180°, u at q2 = -90°. The matrix itself: w = 0 at q1 = ±90°,
    q2 = 0.

    Args:
        reading: Arguments of the arc tangents, rational in tangents and w.

    Returns:
        True if proved.

    Source:
        Nguyen 2021, eq. 8.
    """
    numerator, denominator = sp.fraction(reading.x1)
    t, u = sp.tan(q1 / 2), sp.tan(q2 / 2 - sp.pi / 4)
    vanishes = denominator - (1 + t**2) * (1 + u**2) * sin(q2)
    both = numerator.subs({q2: 0, w: cos(q1)}, simultaneous=True)  # w = |cos q1| there
    below = sp.fraction(reading.x3)[1]
    factor = (1 + sin(q2)) / (cos(q1 / 2) * cos(q2 / 2) * cos(q3 / 2)) ** 2
    poles = t.subs(q1, sp.pi) is sp.zoo and u.subs(q2, -sp.pi / 2) is sp.zoo
    singular = all(ROOTS[w].subs({q1: side * sp.pi / 2, q2: 0}) == 0 for side in (1, -1))
    zeros = (vanishes, both, below + factor * device_B()[1, 2])
    return poles and singular and all(is_exactly_zero(zero) for zero in zeros)


def wrong_without_warning() -> bool:
    """Whether the half-angle form answers q'2 = 0 at q1 = 180°, q2 = 0.5, where q'2 is -90°.

    Returns:
        True if it does so in double precision.

    Source:
        Nguyen 2021, eq. 8.
    """
    (angle,) = evaluate(corrected().angles()[1], [q1, q2, q3], np.array([[np.pi, 0.5, 0.3]]))
    return abs(angle) < _CLOSE


def beyond_the_branch() -> bool:
    """Whether 120° of pure abduction comes out as flexion 180°, abduction 60°, rotation -180°.

    Returns:
        True if it does.

    Source:
        Nguyen 2021, eq. 8.
    """
    q = ca.SX.sym("q", 3)
    convert = ca.Function("convert", [q], [shoulder_angles(device_to_human(q, ca.SX(0))[:3])])
    found = np.rad2deg(np.asarray(convert(np.deg2rad([120, 0, 0]))).ravel())
    return bool(np.abs(np.remainder(found - [180, 60, 180] + 180, 360) - 180).max() < _CLOSE)


def _check() -> Evidence:
    readings = {
        (exponent, root, second): solved_by(exponent, root, second)
        for exponent, root, second in itertools.product((2, 1), (1, -1), (-1, 1))
    }
    if readings[2, 1, -1]:
        return Evidence(Verdict.HOLDS, f"as printed it solves {readings[2, 1, -1]}")
    proved = (
        roots_are_w()
        and proves(rational(), H * device_B() * H)
        and agrees_with_simplified(corrected())
        and undefined_where_stated(rational())
        and wrong_without_warning()
        and beyond_the_branch()
    )
    others = "; ".join(
        f"root {'+' if root > 0 else '-'}, q'2 {'as printed' if second < 0 else 'without its minus'}: "
        f"{' and '.join(hold)}"
        for (exponent, root, second), hold in readings.items()
        if exponent == 1
    )
    return Evidence(
        Verdict.CORRECTED if proved and readings[1, 1, -1] == ["H B H = C"] else Verdict.FALSE,
        "H B(q) H = C(q') reduced to zero over the rationals modulo s² + c² = 1 and w² = 1 - sin²q1 cos²q2; "
        "the atan2 form agrees at 1,000 random points. With the exponent mended, every choice of signs "
        f"solves one of four conditions ({others}); with the square no choice solves any",
        _counterexample(),
    )


def _counterexample() -> str:
    point = {q1: sp.Rational(1, 2), q2: sp.Rational(4, 5), q3: sp.Rational(3, 10)}
    wrong, right = (float(sp.re(sp.N(form.angles()[0].subs(point)))) for form in (printed(), corrected()))
    return f"at q1 = 0.5, q2 = 0.8, q3 = 0.3: printed q'1 = {wrong:.4f}, true {right:.4f}"


def simplified() -> tuple[Formula, ...]:
    """The same angles from two-argument arc tangents, read off H B H.

    Returns:
        One formula per angle.

    Source:
        Nguyen 2021, eq. 5, 7 and 8.
    """
    B = device_B()
    angles = (atan2(B[2, 1], B[0, 1]), -acos(B[1, 1]), atan2(B[1, 2], -B[1, 0]))
    return tuple(Formula(f"q'_{k + 1}", angle) for k, angle in enumerate(angles))


def _printed() -> tuple[Formula, ...]:
    """Eq. (8) with letters for what occurs often, so that it can be read."""
    t1, t2, t3, u = sp.symbols("t_1 t_2 t_3 u")
    halves = {sp.tan(q1 / 2): t1, sp.tan(q2 / 2): t2, sp.tan(q3 / 2): t3}
    # SymPy turns tan(x - π/4) into -cot(x + π/4).
    letters = {**halves, sp.cot(q2 / 2 + sp.pi / 4): -u}
    form = conversion(sp.Symbol("W"), sp.Symbol("V"))
    angles = [Formula(f"q'_{k + 1}", angle.subs(letters)) for k, angle in enumerate(form.angles())]
    return (
        *angles,
        Formula("W", sqrt(under_root_1(2)).subs(letters)),
        Formula("V", root_2()),
        *(Formula(str(letter), tangent) for tangent, letter in halves.items()),
        Formula("u", r"\tan\left(\frac{q_2}{2} - \frac{\pi}{4}\right)"),
    )


CLAIMS = (
    Claim(
        PAPER,
        "8",
        "human shoulder angles from device angles",
        Verdict.CORRECTED,
        "As printed it solves none of the four conditions below. With one exponent mended it solves "
        "H B(q) H = C(q'), H = diag(-1, 1, -1), and not \"B3 = C3\": the zero of q' is turned by half a turn "
        "about y in base and arm. It always takes the branch -180° < q'2 < 0, that is at most 90° of "
        "abduction: 120° of pure abduction, q = (120°, 0, 0), becomes flexion 180°, abduction 60°, rotation "
        "-180°, outside Table 2, although (0°, 120°, 0°) is inside. The half-angle tangents lose no "
        "quadrant, but are 0/0 for q2 = 0 with |q1| < 90° (the hanging arm included), for q'3 = 0, and at "
        "q1 = 180° or q2 = -90°; in double precision they then answer wrongly without a warning (q1 = 180°, "
        "q2 = 0.5: q'2 = 0 for -90°). Program the atan2 form. It too is undefined at the true singularity, "
        "the arm straight out to a side (q1 = ±90°, q2 = 0), where only q'1 ± q'3 is determined: "
        "`armik_sym.elbow` then keeps q'1 of a neighbour.",
        Check(_check, _printed(), simplified()),
        derivation="The second column of H B H against that of C gives q'1 and q'2, the second row q'3, with "
        "sin q'2 = -w. The two solutions are q' and (q'1 + 180°, -q'2, q'3 + 180°). The shipped form takes "
        "q'2 = -atan2(w, B22) with w = √(B12² + B32²), which keeps all digits near the singularity.",
        correction="under the root of q'1 write 4·tan(q1/2)·tan(q2/2 - π/4), not 4·tan(q1/2)²·…, twice; "
        'better, the quadrant-safe form below, which is `armik_sym.elbow.device_to_human`. For "B3 = C3" '
        "literally, drop the minus in front of q'2 as well",
        extraction='"tan(q2/2 - pi + ((" has lost "/4)": read tan(q2/2 - π/4) + ((…. Whether the exponent is '
        "the printer's or the extraction's cannot be told from the text",
        fault=Fault.MISPRINT,
    ),
)
