"""The objective seen from a trajectory: quadratic chain, linear terms, acceleration linearised from below."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from numpy.typing import NDArray

from armik_sym.trajectory.rates import sample_durations, smoothness_matrix, smoothness_rows

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Time τ within which a trajectory follows postures at knots, in [s].
_NEAR = 0.04


@dataclass(frozen=True, eq=False)
class Objective:
    """½ (q - rest)ᵀ (K ⊗ I) (q - rest), split into a chain of neighbours and the acceleration.

    Attributes:
        rows: S with SᵀS = K, of `smoothness_rows`, shape (m, n).
        K: Matrix of everything, shape (n, n).
        acceleration: Matrix K_a of squared acceleration, shape (n, n).
        stiffness: s_k = w_v/h_k between samples k and k+1, shape (n - 1,), in [1/s].
        posture: p_k = w_p·d_k, shape (n,), in [1/s].
        durations: Share of time of each sample, shape (n,), in [s].
        speed_weight: w_v.
        rest: Posture that the posture term is drawn to, shape (dof,), in [rad].

    Source:
        `smoothness_matrix` (this package).
    """

    rows: sp.csr_array
    K: sp.csr_array
    acceleration: sp.csr_array
    stiffness: Array
    posture: Array
    durations: Array
    speed_weight: float
    rest: Array

    def value(self, q: Array) -> float:
        """The objective of a trajectory.

        Args:
            q: Joint angles, shape (n, dof), in [rad].

        Returns:
            Its objective.

        Source:
            None (definition).
        """
        return float(0.5 * np.square(self.rows @ (q - self.rest)).sum())

    def gradient(self, q: Array) -> Array:
        """The gradient K (q - rest).

        Args:
            q: Joint angles, shape (n, dof), in [rad].

        Returns:
            Shape (n, dof).

        Source:
            None (definition).
        """
        return np.asarray(self.K @ (q - self.rest))


def objective_of(time: Array, speed: float, acceleration: float, posture: float, rest: Array) -> Objective:
    """The quadratic objective of a trajectory and its parts.

    Args:
        time: Time stamps, shape (n,), in [s].
        speed: Weight of squared speed.
        acceleration: Weight of squared acceleration, in [s²].
        posture: Weight of the squared distance from `rest`, in [1/s²].
        rest: Posture, shape (dof,), in [rad].

    Returns:
        The objective.

    Source:
        `smoothness_matrix` (this package).
    """
    durations = sample_durations(time)
    return Objective(
        rows=smoothness_rows(time, speed, acceleration, posture),
        K=smoothness_matrix(time, speed, acceleration, posture),
        acceleration=smoothness_matrix(time, 0.0, acceleration, 0.0),
        stiffness=-smoothness_matrix(time, speed, 0.0, 0.0).diagonal(1),
        posture=posture * durations,
        durations=durations,
        speed_weight=speed,
        rest=rest,
    )


@dataclass(frozen=True, eq=False)
class Linearised:
    """f(q) ≥ f(q*) - loss + Σ force_k·e_k + ½ Σ s_k|e_{k+1} - e_k|² + ½ Σ p_k|e_k|², e = q - q*.

    Attributes:
        force: Shape (n, dof).
        loss: ½ vᵀ K_a v, not negative.
    """

    force: Array
    loss: float


def linearised(objective: Objective, gradient: Array, away: Array) -> Linearised:
    """Take the acceleration term from below by its tangent at the trajectory u = q* - v.

    ½ qᵀK_a q ≥ uᵀK_a q - ½ uᵀK_a u, so the force is g - K_a v and the loss at q* is ½ vᵀK_a v.

    Args:
        objective: The objective.
        gradient: g = its gradient at q*, shape (n, dof).
        away: v, shape (n, dof), in [rad].

    Returns:
        The linear terms and the loss.

    Source:
        Fenchel's inequality.
    """
    bent = objective.acceleration @ away
    return Linearised(gradient - bent, float(0.5 * np.sum(away * bent)))


def smoothed(objective: Objective, gradient: Array, away: Array, span: float) -> Array:
    """The v near a given one that makes forces smooth: noise of the path is in its fourth differences.

    A block of duration T under a force of density g_k/d_k sags by about T²·|g_k|²/(24·w_v·d_k) per sample.
    The least sum of loss and sag, ½ v'ᵀK_a v' + Σ T²|g' - K_a v'|²_k/(24·w_v·d_k) with g' = g - K_a v, is at
    (K_a + 12·w_v·d/T²) v' = g'.

    Args:
        objective: The objective.
        gradient: g, shape (n, dof).
        away: v, shape (n, dof), in [rad].
        span: T, in [s]; 0 changes nothing.

    Returns:
        v + v', shape (n, dof), in [rad].

    Source:
        None (this package).
    """
    if not span or not objective.speed_weight:
        return away
    keep = sp.diags_array(12 * objective.speed_weight / span**2 * objective.durations)
    return away + _solve(objective.acceleration + keep, gradient - objective.acceleration @ away)


def beside(objective: Objective, gradient: Array, knots: Indices, chain: Array) -> Array:
    """The trajectory of least objective near postures at knots, curves and limits left aside.

    Minimises g·e + ½ eᵀKe + ½ Σ_j W_j·|e_j - chain_j|² with W_j = w_v·(time between knots)/τ²: (K + W) e =
    W·chain - g.

    Args:
        objective: The objective, with a weight of speed.
        gradient: g = its gradient at q*, shape (n, dof).
        knots: Samples, shape (J,).
        chain: Postures minus q*, shape (J, dof), in [rad].

    Returns:
        e, shape (n, dof), in [rad].

    Source:
        The proximal point of Rockafellar (1976), on a trajectory.
    """
    weights, target = np.zeros(len(gradient)), np.zeros_like(gradient)
    spacing = np.gradient(np.cumsum(objective.durations)[knots])
    weights[knots] = spacing * objective.speed_weight / _NEAR**2
    target[knots] = chain
    return _solve(objective.K + sp.diags_array(weights), weights[:, None] * target - gradient)


def _solve(A: sp.sparray, right: Array) -> Array:
    return np.asarray(spl.splu(sp.csc_array(A)).solve(np.ascontiguousarray(right)))
