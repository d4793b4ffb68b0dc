"""A chain of knots: what is left of the chain of samples when those between knots may be anywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.lower_bound.linearised import Objective

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

_STRETCH = 8.0


@dataclass(frozen=True, eq=False)
class Chain:
    """Σ_j [½·weight_j·|e_j|² + force_j·e_j] + Σ_j ½·stiffness_j·|e_{j+1} - e_j|² - sag at the knots.

    Attributes:
        knots: Samples, shape (J,).
        stiffness: Shape (J - 1,).
        weight: Shape (J,), not negative.
        force: Shape (J, dof).
        sag: Not negative: what the other samples gain at most by leaving their curves.
    """

    knots: Indices
    stiffness: Array
    weight: Array
    force: Array
    sag: float


def knots_within(objective: Objective, force: Array, budget: float, avoid: Mask) -> Indices:
    """Choose knots as far apart as a budget for the sag allows.

    The sag grows with the third power of the length of a block: every block takes as many samples as keep it
    within its share of the budget, or eight times that if only so it ends at a sample that need not be
    avoided. The first and the last sample are knots unless they are to be avoided.

    Args:
        objective: The objective.
        force: Linear terms, shape (n, dof).
        budget: Largest total of the sag, but for samples to be avoided; 0 makes the others knots.
        avoid: Samples that should rather not be knots, shape (n,).

    Returns:
        Samples, shape (J,), J ≥ 2.

    Source:
        None (this package).
    """
    n, share = len(force), budget / len(force)
    first = _from_the_end(objective.stiffness, objective.posture, force, avoid, _STRETCH * share)
    last = n - 1
    last -= _from_the_end(
        objective.stiffness[::-1], objective.posture[::-1], force[::-1], avoid[::-1], _STRETCH * share
    )
    if first >= last:
        first, last = 0, n - 1
    knots = [first]
    while knots[-1] < last:
        a = knots[-1]
        near = a + _block(objective, force, a, last, share).length
        good = np.flatnonzero(~avoid[a + 1 : near + 1])
        if not good.size:
            far = a + _block(objective, force, a, last, _STRETCH * share).length
            good = np.flatnonzero(~avoid[a + 1 : far + 1])[:1]
        knots.append(a + 1 + int(good[-1]) if good.size else near)
    return np.array(knots, dtype=np.int64)


def chain_at(objective: Objective, force: Array, knots: Indices) -> Chain:
    """Eliminate all samples but given knots.

    Args:
        objective: The objective.
        force: Linear terms, shape (n, dof).
        knots: Increasing samples, shape (J,); if they are not all samples, speed or posture must have a
            weight.

    Returns:
        The chain.

    Source:
        Gaussian elimination.
    """
    s, p = objective.stiffness, objective.posture
    weight, forces = p[knots], force[knots]
    pairs = zip(knots[:-1].tolist(), knots[1:].tolist(), strict=True)
    blocks = [_block(objective, force, a, b, np.inf) for a, b in pairs]
    for j, block in enumerate(blocks):
        for end in (0, 1):
            weight[j + end] += block.weight[end]
            forces[j + end] += block.force[end]
    sag = sum(block.sag for block in blocks)
    a, b = int(knots[0]), int(knots[-1])
    before = _end(s[:a], p[:a], force[:a])
    after = _end(s[b:][::-1], p[b + 1 :][::-1], force[b + 1 :][::-1])
    for j, free in ((0, before), (-1, after)):
        weight[j] += free.weight
        forces[j] += free.force
        sag += free.sag
    return Chain(knots, np.array([block.stiffness for block in blocks]), weight, forces, float(sag))


@dataclass(frozen=True, eq=False)
class _End:
    weight: float
    force: Array
    sag: float


def _end(s: Array, p: Array, force: Array) -> _End:
    """Eliminate samples from a free end on; s[i] ties sample i to the next, the last to the knot.

    As in `_block` with α = 0.
    """
    gamma, sag, kept, ratio = np.zeros(force.shape[1]), 0.0, 0.0, 0.0
    for i in range(len(force)):
        gamma = force[i] + ratio * gamma
        pivot = kept + s[i] + p[i]
        sag += 0.5 * float(gamma @ gamma) / pivot
        ratio = s[i] / pivot
        kept = s[i] - s[i] * ratio
    return _End(max(float(kept), 0.0), gamma * ratio, sag)


def _from_the_end(s: Array, p: Array, force: Array, avoid: Mask, share: float) -> int:
    """The first sample that need not be avoided, if those before it sag by no more than their share."""
    good = np.flatnonzero(~avoid)
    k = int(good[0]) if good.size else 0
    if k == 0 or not np.all(s[:k] + p[:k] > 0) or _end(s[:k], p[:k], force[:k]).sag > share * k:
        return 0
    return k


@dataclass(frozen=True, eq=False)
class _Block:
    length: int
    stiffness: float
    weight: tuple[float, float]
    force: tuple[Array, Array]
    sag: float


def _block(objective: Objective, force: Array, a: int, last: int, share: float) -> _Block:
    r"""The longest block from knot a, up to sample `last`, whose sag is at most its share per sample.

    Going to the right, sample i has the pivot d_i and the linear term γ_i - α_i·e_a:

        α_1 = s_0, γ_1 = g_1, d_1 = s_0 + s_1 + p_1,
        α_{i+1} = α_i·s_i/d_i,  γ_{i+1} = g_{i+1} + γ_i·s_i/d_i,
        d_{i+1} = s_i + s_{i+1} + p_{i+1} - s_i²/d_i,

    and leaves -½|γ_i - α_i·e_a|²/d_i. So a block that ends with sample m before the knot b couples its knots
    with α_m·s_m/d_m, pulls with Σ γ_i·α_i/d_i at a and γ_m·s_m/d_m at b, and sags by Σ ½|γ_i|²/d_i. Weights
    that are zero but for rounding become zero.
    """
    s, p = objective.stiffness, objective.posture
    nothing = np.zeros(force.shape[1])
    best = _Block(1, s[a], (0.0, 0.0), (nothing, nothing), 0.0)
    alpha, gamma, pull = s[a], nothing, nothing
    lost, sag, ratio, pivot = 0.0, 0.0, 0.0, s[a]
    for i in range(a + 1, last):
        gamma = force[i] + ratio * gamma
        pivot += s[i] + p[i]
        if pivot <= 0:
            return best
        sag += 0.5 * float(gamma @ gamma) / pivot
        if sag > share * (i - a):
            return best
        lost += alpha * alpha / pivot
        pull = pull + gamma * (alpha / pivot)
        ratio = s[i] / pivot
        alpha *= ratio
        ends = max(s[a] - lost - alpha, 0.0), max(s[i] - s[i] * ratio - alpha, 0.0)
        best = _Block(i + 1 - a, alpha, ends, (pull, gamma * ratio), sag)
        pivot = s[i] - s[i] * ratio
    return best
