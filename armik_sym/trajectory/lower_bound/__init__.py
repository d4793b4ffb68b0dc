r"""A certified lower bound of the trajectory objective, over every branch and every swivel angle.

**What is bounded.** Samples k = 0 … n-1, postures q_k in R^dof, and the objective of `TrajectoryOptions`

    f(q) = ½ Σ s_k |q_{k+1} - q_k|² + ½ Σ p_k |q_k - preferred|² + ½ qᵀ (K_a ⊗ I) q,

s_k = w_v/h_k, p_k = w_p·d_k, K_a the five bands of the squared acceleration. A trajectory is feasible if
every q_k puts the hand on its pose with all joints inside the range of motion: then q_k is on one of the
closed-form curves q(k, branch, ψ), with ψ in the feasible intervals of sample k. Rate limits and further
terms that are never negative only take trajectories away or make them dearer: the bound holds with them too.

**Step 1, everything relative to a reference** (`linearised`). Let q* be any trajectory, e = q - q*, g = K(q*
- preferred) the gradient, and u any trajectory. K_a has no negative eigenvalue, so ½ qᵀK_a q ≥ uᵀK_a q - ½
uᵀK_a u. The rest of f is a quadratic and equals its expansion at q*. With v = q* - u

    f(q) ≥ f(q*) - ½ vᵀK_a v + Σ (g - K_a v)_k·e_k + ½ Σ s_k |e_{k+1} - e_k|² + ½ Σ p_k |e_k|².

v = 0 loses nothing at q*; another v is smoother, or bounds trajectories far from q* better. What is left is a
chain: sample k meets only its neighbours. At a minimum g_k is at right angles to the curve, so close to q*
the linear terms are of second order in ψ.

**Step 2, knots** (`chain`). Some samples are knots. The postures of the others may be anything in R^dof (this
takes constraints away) and are eliminated exactly. The same kind of chain remains, with other numbers and a
constant loss, the sag.

**Step 3, cells** (`arcs`, `cells`, `triple_rates`). The feasible intervals at the knots are cut into arcs. On
an arc q = centre + tangent·x + ρ, -1 ≤ x ≤ 1, with a bound of ρ by Taylor's theorem and bounds of dq/dψ and
d²q/dψ² over the arc; next to the poles of shoulder or wrist a box instead. Such an enclosure is a cell. Where
the range of motion admits an angle with several whole turns, an arc has several cells.

**Step 4, dynamic programming** (`propagate`, `passes`). On each cell the least cost of all chains that end
there is bounded from below by a parabola v + g·x + ½η·x². From knot to knot every pair of cells has a
quadratic in (x, y) on a square, whose minimum has a closed form. Forwards and backwards together bound, for
each cell, every trajectory through it. Any pair of branches may follow each other: all cells of a knot are
tried with all of the next.

**Step 5, rounds** (`search`). A bound of a cell stays valid for its halves, and of several v each cell keeps
the best bound. Arcs with a bound of at least (1 - gap)·f(q*) are put aside. The others are halved, or bounded
with the v that fits the least chain found. A trajectory either passes through an arc put aside, and then
costs at least the bound that arc had, or, at every knot, through one that is left. So no trajectory costs
less than

    B = min( f(q*), least bound of the arcs put aside, max over knots of the least bound of the arcs left ).

All inequalities are exact in real arithmetic. They are computed in double precision; 1e-9·f(q*) is subtracted
for its rounding.
"""

from armik_sym.trajectory.lower_bound.certify import lower_bound

__all__ = ["lower_bound"]
