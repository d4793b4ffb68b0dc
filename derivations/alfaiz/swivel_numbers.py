"""φ of Al-Faiz and the swivel angle ψ of the elbow at random postures, in both directions."""

from __future__ import annotations

import numpy as np
import sympy as sp

from derivations.alfaiz.closed_form import Lengths, elbow_frame, phi_of, pose, sine_of_theta3, solutions
from derivations.alfaiz.swivel_geometry import ElbowCircle
from derivations.random_points import evaluate

PSI, BETA, GAMMA = sp.symbols("psi beta gamma", real=True)
POINTS = 300
_LENGTHS = (Lengths(), Lengths(0.20, 0.32))
_CLOSE = 1e-8
_FLEXED = 0.2


def first_miss(above: sp.Expr, below: sp.Expr) -> str:
    """The first random posture at which tan φ = above/below, the range of φ or the two elbows fail.

    Args:
        above: Numerator of tan φ in ψ, β, γ.
        below: Denominator.

    Returns:
        What fails, in words; empty if nothing does.

    Source:
        None (random testing).
    """
    rng = np.random.default_rng(0)
    for k in range(POINTS):
        lengths, q = _posture(k, rng)
        T = pose(q, lengths)
        circle = ElbowCircle(T[:3, 3], lengths)
        own, other = circle.psi(elbow_frame(q, lengths)[:3, 3]), rng.uniform(-np.pi, np.pi)
        point = np.array([[own, circle.beta, circle.gamma], [other, circle.beta, circle.gamma]])
        names = [PSI, BETA, GAMMA]
        own_phi, other_phi = np.arctan2(evaluate(above, names, point), evaluate(below, names, point))
        where = f"at posture {k}, ψ = {own:.3f}, β = {circle.beta:.3f}, γ = {circle.gamma:.3f}"
        if abs(np.sin(own_phi - phi_of(q, lengths))) > _CLOSE:
            return f"φ is {phi_of(q, lengths):.3f}, stated {own_phi:.3f} or its opposite, {where}"
        miss = _miss_of_elbows(T, other, other_phi, circle) or _miss_of_range(T, rng, circle)
        if miss:
            return f"{miss}, {where}"
    return ""


def first_miss_of_gamma(tangent: sp.Expr, theta4: sp.Symbol, lengths: tuple[sp.Symbol, sp.Symbol]) -> str:
    """The first random posture at which tan γ is not that of the triangle shoulder, elbow, wrist.

    Args:
        tangent: tan γ.
        theta4: The elbow angle in it.
        lengths: Upper arm and forearm in it.

    Returns:
        What fails, in words; empty if nothing does.

    Source:
        None (random testing).
    """
    rng = np.random.default_rng(0)
    for k in range(POINTS):
        arm, q = _posture(k, rng)
        (stated,) = evaluate(tangent, [theta4, *lengths], np.array([[q[3], arm.l4, arm.l3]]))
        gamma = ElbowCircle(pose(q, arm)[:3, 3], arm).gamma
        if abs(stated * np.cos(gamma) - np.sin(gamma)) > _CLOSE:
            return f"tan γ is {np.tan(gamma):.3f}, stated {stated:.3f}, at θ4 = {q[3]:.3f}"
    return ""


def _posture(k: int, rng: np.random.Generator) -> tuple[Lengths, np.ndarray]:
    """Lengths and a random posture; θ4 of either sign."""
    q = rng.uniform(-np.pi, np.pi, 7)
    q[3] = rng.choice([-1, 1]) * rng.uniform(_FLEXED, np.pi - _FLEXED)
    return _LENGTHS[k % len(_LENGTHS)], q


def _miss_of_elbows(T: np.ndarray, psi: float, phi: float, circle: ElbowCircle) -> str:
    """Both φ of a swivel angle lead to its elbow and to its mirror image."""
    for angle in (phi, phi + np.pi):
        sine = sine_of_theta3(T[:3, 3], angle, circle.lengths)
        if abs(abs(sine) - 1) < 1e-6:
            continue
        found = [(q, elbow_frame(q, circle.lengths)[:3, 3]) for q in solutions(T, angle, circle.lengths)]
        if not found:
            return f"no solution for φ = {angle:.3f}, which belongs to ψ = {psi:.3f}"
        wanted = circle.elbow(psi)
        n = np.array([-np.sin(found[0][0][0]), 0.0, np.cos(found[0][0][0])])
        normal = np.cross(T[:3, 3], n)
        mirrored = wanted - 2 * (wanted @ normal) / (normal @ normal) * normal
        off = [min(np.linalg.norm(e - wanted), np.linalg.norm(e - mirrored)) for _, e in found]
        met = [min(np.linalg.norm(e - target) for _, e in found) for target in (wanted, mirrored)]
        if max(off + met) > _CLOSE:
            return f"the elbows for φ = {angle:.3f} are not that of ψ = {psi:.3f} and its mirror image"
    return ""


def _miss_of_range(T: np.ndarray, rng: np.random.Generator, circle: ElbowCircle) -> str:
    """Solutions exist if and only if |cos φ|·cos β ≤ cos γ (in absolute value)."""
    phi = rng.uniform(-np.pi, np.pi)
    margin = abs(np.cos(circle.gamma)) - abs(np.cos(phi)) * np.cos(circle.beta)
    exists = len(solutions(T, phi, circle.lengths)) > 0
    return "" if abs(margin) < 1e-6 or exists == (margin > 0) else f"range of φ wrong at φ = {phi:.3f}"
