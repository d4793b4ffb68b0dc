"""The whole-trajectory problem in full space: every joint angle of every sample is a variable.

    minimise   ½ xᵀ P x + cᵀ x + Σ_k w_k·ℓ(q_k)     (smoothness, posture, soft tracking; clearance, elbow)
    subject to r(q_k, target_k) - e_k = 0           for every sample k (e = 0 for exact tracking)
               -v ≤ D q ≤ v,  -a ≤ D2 q ≤ a         if asked for
               lower ≤ q_k ≤ upper                  as variable bounds

The tracking equations, the cost ℓ of a posture and their derivatives are called sample by sample as
compiled functions; everything else is constant sparse matrices. So building costs little, and no length
compiles anew.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from armik_sym.compiled.stage_functions import StageFunctions
from armik_sym.trajectory.posture_cost import PostureCost

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class QuadraticCost:
    """½ xᵀ P x + cᵀ x.

    Attributes:
        P: Symmetric sparse matrix, shape (n_x, n_x).
        c: Shape (n_x,).
        scale: Factor by which the user's objective was multiplied to get here.
    """

    P: sp.csc_array
    c: Array
    scale: float = 1.0


@dataclass(frozen=True, eq=False)
class SampleCost:
    """Σ_k w_k·ℓ(q_k).

    Attributes:
        posture: ℓ, the cost of one posture.
        weights: w, shape (n,): the time each sample stands for in [s], times the scale of the objective.
    """

    posture: PostureCost
    weights: Array


@dataclass(frozen=True, eq=False)
class FullSpaceProblem:
    """A nonlinear program as CasADi functions of x, with exact sparse derivatives.

    Attributes:
        x: Variables, MX: angles sample by sample, then tracking errors if tracking is soft.
        f: Objective, MX.
        g: Constraints, MX: tracking sample by sample, then rate rows.
        gradient: Function (x, p) → (f, df/dx).
        jacobian: Function (x, p) → (g, dg/dx).
        hessian: Function (x, p, λ_f, λ_g) → upper triangle of the Lagrangian's Hessian.
        scale: Factor by which the user's objective was multiplied.
    """

    x: ca.MX
    f: ca.MX
    g: ca.MX
    gradient: ca.Function
    jacobian: ca.Function
    hessian: ca.Function
    scale: float = 1.0


def full_space_problem(
    stage: StageFunctions,
    lengths: Array,
    targets: Array,
    dof: int,
    cost: QuadraticCost,
    rate_rows: sp.csr_array,
    *,
    soft: bool,
    sample_cost: SampleCost | None = None,
) -> FullSpaceProblem:
    """Assemble the problem from compiled stage functions and constant matrices.

    Args:
        stage: Tracking equations of one sample.
        lengths: Segment lengths, shape (n_lengths,), in [m].
        targets: Targets, shape (n, target_size).
        dof: Joints per sample.
        cost: Quadratic objective over all variables.
        rate_rows: Rows on the angles, shape (n_rates, n·dof).
        soft: True if tracking errors e are variables.
        sample_cost: Further objective, sample by sample.

    Returns:
        The problem.

    Source:
        None (direct transcription).
    """
    n = len(targets)
    equations = stage.residual.numel_out(0)
    x = ca.MX.sym("x", cost.P.shape[0])
    q = ca.reshape(x[: n * dof], dof, n)
    fixed = (ca.DM(lengths), ca.DM(targets.T))

    P = to_casadi(cost.P)
    Px = ca.mtimes(P, x)
    f = 0.5 * ca.dot(x, Px) + ca.dot(ca.DM(cost.c), x)
    slope = Px + ca.DM(cost.c)
    residual = ca.vec(for_all_samples(stage.residual, n)(q, *fixed))
    if soft:
        residual = residual - x[n * dof :]
    A = to_casadi(rate_rows)
    g = ca.vertcat(residual, ca.mtimes(A, x[: n * dof]))

    J = ca.MX(_block_diagonal(equations, dof, n), ca.vec(for_all_samples(stage.jacobian, n)(q, *fixed)))
    J = ca.vertcat(J, A)
    if soft:
        below = ca.DM(A.shape[0], n * equations)
        J = ca.horzcat(J, ca.vertcat(-ca.DM.eye(n * equations), below))

    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.shape[0])
    multipliers = ca.reshape(lam_g[: n * equations], equations, n)
    curvature = ca.vec(for_all_samples(stage.hessian, n)(q, *fixed, multipliers))
    if sample_cost is not None:
        value, gradient, hessian = _sample_cost(sample_cost, q)
        f = f + value
        slope = slope + ca.vertcat(gradient, ca.DM.zeros(x.shape[0] - n * dof))
        curvature = curvature + lam_f * hessian
    H = ca.triu(ca.MX(_block_diagonal(dof, dof, n), curvature))
    if soft:
        H = ca.diagcat(H, ca.DM(n * equations, n * equations))
    H = H + lam_f * ca.triu(P)

    p = ca.MX.sym("p", 0)
    return FullSpaceProblem(
        x=x,
        f=f,
        g=g,
        gradient=ca.Function("grad_f", [x, p], [f, slope]),
        jacobian=ca.Function("jac_g", [x, p], [g, J]),
        hessian=ca.Function("hess_lag", [x, p, lam_f, lam_g], [H]),
        scale=cost.scale,
    )


def to_casadi(matrix: sp.sparray) -> ca.DM:
    """A SciPy sparse matrix as a CasADi one, explicit zeros removed.

    Args:
        matrix: Sparse matrix, shape (m, n).

    Returns:
        DM of shape (m, n).

    Source:
        None (both store compressed columns).
    """
    csc = sp.csc_array(matrix)
    csc.eliminate_zeros()
    csc.sort_indices()
    sparsity = ca.Sparsity(*csc.shape, csc.indptr.tolist(), csc.indices.tolist())
    return ca.DM(sparsity, csc.data)


def _sample_cost(cost: SampleCost, q: ca.MX) -> tuple[ca.MX, ca.MX, ca.MX]:
    """Value (1, 1), gradient (n·dof, 1) and the Hessian's blocks, one after another, (n·dof·dof, 1)."""
    n, dof, posture = q.shape[1], q.shape[0], cost.posture
    fixed = (ca.DM(posture.lengths), ca.DM(posture.parameters))
    value, gradient, hessian = (
        for_all_samples(function, n, alike=(1, 2))(q, *fixed)
        for function in (posture.value, posture.gradient, posture.hessian)
    )
    weights = ca.DM(cost.weights)
    return (
        ca.mtimes(value, weights),
        ca.vec(gradient) * ca.DM(np.repeat(cost.weights, dof)),
        ca.vec(hessian) * ca.DM(np.repeat(cost.weights, dof * dof)),
    )


def for_all_samples(function: ca.Function, n: int, alike: tuple[int, ...] = (1,)) -> ca.Function:
    """A stage function evaluated for n samples; some arguments are the same for all.

    Args:
        function: Stage function (q, lengths, …) → vector.
        n: Number of samples.
        alike: Arguments that are the same for all samples, by default the segment lengths.

    Returns:
        Function of matrices with one column per sample, and of the arguments that are alike.

    Source:
        None (CasADi's map).
    """
    return function.map(f"{function.name()}_map", "serial", n, list(alike), [])


def _block_diagonal(rows: int, columns: int, n: int) -> ca.Sparsity:
    """Dense blocks on the diagonal; nonzeros then run block by block, each column by column."""
    column_pointers = np.arange(n * columns + 1) * rows
    row_indices = (np.arange(n)[:, None, None] * rows + np.arange(rows)).repeat(columns, axis=1).ravel()
    return ca.Sparsity(n * rows, n * columns, column_pointers.tolist(), row_indices.tolist())
