"""How many postures reach a pose of the hand for a given φ."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from types import MappingProxyType

import numpy as np
from sympy import cos, diff, pi

from derivations.alfaiz.chain import L3, L4, Q, frame
from derivations.alfaiz.closed_form import Lengths, phi_of, pose, sine_of_theta3, solutions
from derivations.alfaiz.no_other_solutions import shoulder_and_elbow_count, wrist_counts
from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.exact_zero import is_exactly_zero

PAPER = "alfaiz"
_LENGTHS = (Lengths(), Lengths(0.25, 0.25), Lengths(0.20, 0.32))
_POSES = 300
_REACHED = 1e-6
_CLEAR = 1e-3
_POSTURE = (0.4, -0.3, 0.5, 0.8, 0.7, 0.2, -0.4)

GENERIC = "generic"
STRAIGHT = "straight or folded elbow (θ4 = 0 or π)"
FOLD = "φ at the end of its range (θ3 = ±90°)"
NO_PHI = "|r·cos φ| > |l3·cos θ4 + l4|"
TOO_FAR = "target out of reach"

COUNTS: Mapping[str, int] = MappingProxyType({GENERIC: 8, STRAIGHT: 4, FOLD: 4, NO_PHI: 0, TOO_FAR: 0})


def check_counts(stated: Mapping[str, int]) -> Evidence:
    """All branches at random poses and in the special cases, and the upper bound from algebra.

    Args:
        stated: Number of solutions stated for each case.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 4-47, corrected.
    """
    bounds = {shoulder_and_elbow_count() * wrist for wrist in wrist_counts()}
    if bounds != {stated[GENERIC]}:
        return Evidence(Verdict.FALSE, f"upper bounds {sorted(bounds)}", f"stated: {stated[GENERIC]}")
    if not _same_arm():
        return Evidence(Verdict.FALSE, "(θ2 + π, π - θ3, -θ4) moves the elbow")
    if not _infinitely_many():
        return Evidence(Verdict.FALSE, "the singular cases are not singular")
    miss = _first_miss(stated)
    if miss:
        return Evidence(Verdict.FALSE, "the branches are not as many as stated", miss)
    return Evidence(
        Verdict.ADDED,
        f"at most {stated[GENERIC]}: Gröbner bases leave {shoulder_and_elbow_count()} monomials for θ2, θ3, "
        "θ4 (k1, k2, dy, l3, l4 independent) and 2 for θ5, θ6, θ7 (three rational rotations), complex "
        f"solutions included; at least as many: {_POSES} random poses with four values of φ each, for upper "
        "arms longer than, equal to and shorter than the forearm, all branches different and all reaching "
        "the pose in CasADi; special cases counted at one posture each; that (θ2 + π, π - θ3, -θ4) leaves "
        "elbow and wrist in place is exact",
    )


def _same_arm() -> bool:
    """Exactly: turning θ2 by half a turn, θ3 into π - θ3 and θ4 into -θ4 moves neither elbow nor wrist."""
    twin = {Q[1]: Q[1] + pi, Q[2]: pi - Q[2], Q[3]: -Q[3]}
    places = (frame(4)[:3, 3], frame(5)[:3, 3])
    return all(is_exactly_zero(a - a.subs(twin, simultaneous=True)) for p in places for a in p)


def _infinitely_many() -> bool:
    """Whether the singular cases leave a joint free, exactly.

    The wrist on axis 2 does not move with q2; at θ6 = 90° q5 and q7 turn the hand alike; with
    l3·cos θ4 + l4 = 0 the wrist does not move with q3.
    """
    on_axis = diff(frame(5)[:3, 3], Q[1]).subs({Q[2]: pi / 2, Q[3]: 0})
    R = frame(7)[:3, :3]
    bent = (diff(R, Q[4]) - diff(R, Q[6])).subs(Q[5], pi / 2)
    level = diff(frame(5)[:3, 3].subs(L4, -L3 * cos(Q[3])), Q[2])
    return all(is_exactly_zero(entry) for entry in (*on_axis, *bent, *level))


def _first_miss(stated: Mapping[str, int]) -> str:
    rng = np.random.default_rng(0)
    for k, q in enumerate(itertools.islice(_postures(rng), _POSES)):
        lengths = _LENGTHS[k % len(_LENGTHS)]
        T = pose(q, lengths)
        own = phi_of(q, lengths)
        if not any(_same(q, x) for x in solutions(T, own, lengths)):
            return f"the posture {np.round(q, 3)} is not among its own solutions"
        for phi in (own, *rng.uniform(-np.pi, np.pi, 3)):
            sine = abs(sine_of_theta3(T[:3, 3], phi, lengths))
            if abs(sine - 1) > _CLEAR:
                miss = _miss(T, phi, lengths, stated[GENERIC if sine < 1 else NO_PHI])
                if miss:
                    return miss
    return _first_special_miss(stated)


def _postures(rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Random postures away from those in which branches meet."""
    while True:
        q = rng.uniform(-np.pi, np.pi, 7)
        if min(abs(np.sin(q[3])), abs(np.cos(q[2])), abs(np.cos(q[5]))) > 0.1:
            yield q


def _first_special_miss(stated: Mapping[str, int]) -> str:
    lengths = _LENGTHS[0]
    cases = ((STRAIGHT, {3: 0.0}), (STRAIGHT, {3: np.pi}), (FOLD, {2: np.pi / 2}), (FOLD, {2: -np.pi / 2}))
    for name, changes in cases:
        q = np.array(_POSTURE)
        for joint, value in changes.items():
            q[joint] = value
        miss = _miss(pose(q, lengths), phi_of(q, lengths), lengths, stated[name])
        if miss:
            return f"{name}: {miss}"
    T = pose(np.array(_POSTURE), lengths)
    T[:3, 3] *= 2
    return _miss(T, 0.3, lengths, stated[TOO_FAR])


def _miss(T: np.ndarray, phi: float, lengths: Lengths, expected: int) -> str:
    found = solutions(T, phi, lengths)
    if len(found) != expected:
        return f"{len(found)} solutions at φ = {phi:.3f}, wrist {np.round(T[:3, 3], 3)}, stated: {expected}"
    if any(np.abs(pose(q, lengths) - T).max() > _REACHED for q in found):
        return f"a branch misses the pose at φ = {phi:.3f}, wrist {np.round(T[:3, 3], 3)}"
    return ""


def _same(left: np.ndarray, right: np.ndarray) -> bool:
    return bool(np.abs(np.remainder(left - right + np.pi, 2 * np.pi) - np.pi).max() < _REACHED)


CLAIMS = (
    Claim(
        PAPER,
        "solutions",
        "number of solutions for a given pose and φ",
        Verdict.ADDED,
        "Not in the paper, whose formulas give one. A reachable pose and a φ in range have 8 solutions: two "
        "signs of θ4, times two θ3, times two wrists; 4 if the elbow only flexes, of which 2 have "
        "|θ6| ≤ 90°. All 8 share two places of the elbow; with a flexing elbow the two θ3 tell them apart.",
        Check(
            lambda: check_counts(COUNTS),
            printed=tuple(Formula(rf"\text{{{case}}}", str(n), ":") for case, n in COUNTS.items()),
        ),
        derivation="With r ≥ 0: θ1 follows from φ by (20). The distance fixes cos θ4, hence ±θ4. Both "
        "signs give the same sin θ3 in (22), hence θ3 and π - θ3. Each of the four has one θ2 by (33), "
        "(34), and each rotation of the wrist two triples: (θ5, θ6, θ7) and (θ5 + π, π - θ6, θ7 + π). "
        "Every step is necessary, so there are no others. (θ2 + π, π - θ3, -θ4) is the same arm as (θ2, "
        "θ3, θ4). Infinitely many solutions exist if the wrist lies on the axis of joint 2 (θ2 free), if "
        "cos θ6 = 0 (only θ5 + θ7 or θ5 - θ7 is fixed) and if l3·cos θ4 + l4 = 0 = r·cos φ (θ3 free). If "
        "the wrist lies on the axis of joint 1, φ is not defined.",
    ),
)
