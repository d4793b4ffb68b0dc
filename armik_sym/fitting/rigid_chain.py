"""How well a chain of rigid segments can explain recorded points: the best one, found by least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MOST_STEPS = 60
# The search ends when a step lowers the sum of squares by less than this share, or it is rounding.
_ENOUGH = 1e-10
_ROUNDING_M2 = 1e-28
_TINY = 1e-12
# Singular values of the normal matrix below this share of the largest are directions nothing depends on
# (the base of an arm that does not move); they keep their starting values.
_UNSEEN = 1e-8


@dataclass(frozen=True, eq=False)
class RigidChain:
    """Segments of fixed length, one after another from a base, freely turned in every sample.

    Attributes:
        base: Where the chain begins, shape (3,) or (n, 3), in [m].
        lengths: Segment lengths, shape (k,), in [m].
        joints: End of each segment in each sample, shape (n, k, 3), in [m].
    """

    base: Array
    lengths: Array
    joints: Array


def best_rigid_chain(points: Array, base: Array, free_base: bool) -> RigidChain:
    """The chain of rigid segments nearest to recorded points.

    min Σ_i Σ_k |p_ik - x_ik|² over lengths ℓ, directions u_ik and, if it is free, the base c, with
    x_ik = c + Σ_{j ≤ k} ℓ_j u_ij. Levenberg-Marquardt; the directions of each sample are eliminated (Schur
    complement), so that the time grows with the number of samples only. No other fixed chain, whatever its
    joint angles, comes nearer (up to local minima, from a start at the recorded directions).

    Args:
        points: Recorded points after the base, such as elbow, wrist and hand, shape (n, k, 3), in [m].
        base: Start for the base, shape (3,), or the base itself over time, shape (n, 3), in [m].
        free_base: Whether the base is looked for.

    Returns:
        The chain.

    Source:
        Triggs et al. (2000), Bundle adjustment - a modern synthesis, §6.1 (Schur complement); Moré (1978).
    """
    n, k, _ = points.shape
    start = np.broadcast_to(base, (n, 3))
    segments = np.diff(np.concatenate([start[:, None], points], axis=1), axis=1)
    sizes = np.linalg.norm(segments, axis=2)
    # A segment without a length has any direction.
    u = np.where(sizes[:, :, None] > _TINY, segments / np.maximum(sizes, _TINY)[:, :, None], [1.0, 0.0, 0.0])
    lengths, c = sizes.mean(axis=0), np.array(base, dtype=np.float64)
    damping = 1e-4
    residual = points - _ends(c, lengths, u)
    cost = float(np.sum(residual**2))
    for _ in range(_MOST_STEPS):
        tangent = _tangents(u)
        local, shared = _jacobians(u, lengths, tangent, free_base)
        turn, change = _step(local, shared, residual.reshape(n, 3 * k), damping)
        tried = u + np.einsum("nkij,nkj->nki", tangent, turn.reshape(n, k, 2))
        tried /= np.linalg.norm(tried, axis=2, keepdims=True)
        tried_lengths, tried_c = lengths + change[:k], c + change[k:] if free_base else c
        new = points - _ends(tried_c, tried_lengths, tried)
        new_cost = float(np.sum(new**2))
        if new_cost < cost:
            done = cost - new_cost <= _ENOUGH * cost
            u, lengths, c, residual, cost = tried, tried_lengths, tried_c, new, new_cost
            damping = max(damping / 10, 1e-12)
            if done:
                break
        elif damping > 1e6:
            break
        else:
            damping *= 10
        if cost < _ROUNDING_M2 * n:
            break
    return RigidChain(c, lengths, _ends(c, lengths, u))


def _ends(base: Array, lengths: Array, u: Array) -> Array:
    """Ends of the segments, shape (n, k, 3)."""
    return np.asarray(np.reshape(base, (-1, 1, 3)) + np.cumsum(lengths[:, None] * u, axis=1))


def _tangents(u: Array) -> Array:
    """Two directions at right angles to each unit vector, shape (n, k, 3, 2)."""
    helper = np.eye(3)[np.argmin(np.abs(u), axis=2)]
    first = np.cross(u, helper)
    first /= np.linalg.norm(first, axis=2, keepdims=True)
    return np.stack([first, np.cross(u, first)], axis=3)


def _jacobians(u: Array, lengths: Array, tangent: Array, free_base: bool) -> tuple[Array, Array]:
    """How the ends move with the directions, (n, 3k, 2k), and with lengths and base, (n, 3k, k or k + 3)."""
    n, k, _ = u.shape
    local = np.zeros((n, k, 3, k, 2))
    shared = np.zeros((n, k, 3, k + 3 * free_base))
    for end in range(k):
        for segment in range(end + 1):
            local[:, end, :, segment] = lengths[segment] * tangent[:, segment]
            shared[:, end, :, segment] = u[:, segment]
        if free_base:
            shared[:, end, :, k:] = np.eye(3)
    return local.reshape(n, 3 * k, 2 * k), shared.reshape(n, 3 * k, -1)


def _step(local: Array, shared: Array, residual: Array, damping: float) -> tuple[Array, Array]:
    """Damped Gauss-Newton step of the directions, (n, 2k), and of lengths and base."""
    transposed = np.swapaxes(local, 1, 2)
    normal = transposed @ local
    size = np.arange(normal.shape[1])
    normal[:, size, size] *= 1.0 + damping
    normal[:, size, size] += 1e-15
    solved = np.linalg.solve(normal, transposed @ np.concatenate([shared, residual[:, :, None]], axis=2))
    by_shared, by_residual = solved[:, :, :-1], solved[:, :, -1]
    schur = np.einsum("nri,nrj->ij", shared, shared - local @ by_shared)
    schur[np.diag_indices(len(schur))] *= 1.0 + damping
    right = np.einsum("nri,nr->i", shared, residual - np.einsum("nrj,nj->nr", local, by_residual))
    change = np.linalg.lstsq(schur, right, rcond=_UNSEEN)[0]
    return by_residual - by_shared @ change, change
