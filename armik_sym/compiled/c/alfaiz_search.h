/* The search of Al-Faiz along the curve of alfaiz_curve.h: the range of motion decides.
 *
 * Where a joint reaches a limit, a + b cos psi + c sin psi = 0. These cuts divide the circle into cells in
 * which every joint stays on one side of its limits: looking once into each cell misses nothing.
 */
#define ALFAIZ_ZOOM 16 /* swivel angles per refinement */
#define ALFAIZ_STEPS 8 /* Newton steps of alfaiz_follow */
#define ALFAIZ_VALLEYS 3 /* postures alfaiz_nearest follows */

/* What Python chooses. */
typedef struct {
  int grid;                /* swivel angles looked at, besides one per cell; at most 256 */
  int refinements;         /* times the surroundings of the best one are looked at more closely */
  int nearest;             /* 1: nearest to the posture before, 0: farthest from the limits */
  real near;               /* a posture within this of the one before is taken without looking round [rad] */
  real tolerance;          /* position [m] and rotation [rad] up to which a target counts as reached */
} alfaiz_settings;

/* Look at psi; keep it if it is better. Returns whether it was. */
static inline int alfaiz_try(alfaiz_problem *p, real psi, alfaiz_posture *best) {
  alfaiz_posture new_one;
  alfaiz_look(p, psi, &new_one);
  if (!(new_one.cost < best->cost)) return 0;
  *best = new_one;
  return 1;
}

/* The middle of the stretch after a cut. */
static inline real alfaiz_middle(const real *cuts, int n_cuts, int i) {
  return (real)0.5 * (cuts[i] + (i + 1 < n_cuts ? cuts[i + 1] : cuts[0] + ALFAIZ_TURN));
}

/* Index of the largest of n numbers. */
static inline int alfaiz_largest(int n, const real *x) {
  int best = 0;
  for (int i = 1; i < n; ++i)
    if (x[i] > x[best]) best = i;
  return best;
}

/* The swivel angle farthest from all limits: among a grid and one angle per cell, then more closely. */
static inline void alfaiz_farthest(alfaiz_problem *p, const alfaiz_settings *settings, const real *cuts,
                                   int n_cuts, alfaiz_posture *best) {
  real psi[ALFAIZ_MOST], margins[ALFAIZ_MOST];
  const int grid = settings->grid;
  psi[0] = margins[0] = 0;
  const real spacing = ALFAIZ_TURN / (real)grid;
  for (int i = 0; i < grid; ++i) psi[i] = spacing * (real)i - ALFAIZ_PI;
  for (int i = 0; i < n_cuts; ++i)
    psi[grid + i] = alfaiz_middle(cuts, n_cuts, i);
  alfaiz_margins(p, grid + n_cuts, psi, margins);
  int k = alfaiz_largest(grid + n_cuts, margins);
  real middle = psi[k], margin = margins[k], aside = spacing;
  if (k >= grid) aside = middle - cuts[k - grid];
  for (int round = 0; round < settings->refinements; ++round) {
    const real step = aside / (ALFAIZ_ZOOM / 2);
    for (int i = 0; i < ALFAIZ_ZOOM; ++i)
      psi[i] = middle + step * ((real)i - (real)0.5 * (ALFAIZ_ZOOM - 1));
    alfaiz_margins(p, ALFAIZ_ZOOM, psi, margins);
    k = alfaiz_largest(ALFAIZ_ZOOM, margins);
    if (margins[k] > margin) {
      middle = psi[k];
      margin = margins[k];
    }
    aside = step;
  }
  alfaiz_look(p, middle, best);
}

/* Gauss-Newton step in psi towards the posture before. */
static inline real alfaiz_step(const alfaiz_problem *p, const alfaiz_posture *at) {
  const real c = ALFAIZ_COS(at->psi), s = ALFAIZ_SIN(at->psi);
  real slope = 0, square = ALFAIZ_ROUNDING;
  for (int group = 0; group < 2; ++group) {
    real R[9], dR[9], rates[3];
    alfaiz_rotation(p->curve, group, c, s, R);
    for (int i = 0; i < 9; ++i)
      dR[i] = p->curve[19 + 27 * group + i] * c - p->curve[10 + 27 * group + i] * s;
    armik_alfaiz_rates(R, dR, p->pole[group], rates);
    for (int i = 0; i < 3; ++i) {
      const int j = 4 * group + i;
      const real sign = (real)((group == 0) != (i == 1 && at->flipped[group]) ? -1 : 1);
      slope += (at->q[j] - p->previous[j]) * sign * rates[i];
      square += rates[i] * rates[i];
    }
  }
  return -slope / square;
}

/* Move psi to where the posture is nearest to the one before, without leaving the range of motion. */
static inline void alfaiz_follow(alfaiz_problem *p, alfaiz_posture *best) {
  for (int k = 0; k < ALFAIZ_STEPS; ++k) {
    real step = alfaiz_step(p, best);
    if (!(ALFAIZ_FABS(step) > ALFAIZ_ROUNDING)) return;
    if (ALFAIZ_FABS(step) > (real)0.5) step = step > 0 ? (real)0.5 : (real)-0.5;
    if (ALFAIZ_FABS(step) < (real)1e-4) { /* too small to be judged by the cost */
      alfaiz_posture new_one;
      alfaiz_look(p, best->psi + step, &new_one);
      if (!(new_one.margin >= -ALFAIZ_ROUNDING && new_one.cost <= best->cost + (real)1e-8)) return;
      if (new_one.flipped[0] != best->flipped[0] || new_one.flipped[1] != best->flipped[1]) return;
      *best = new_one;
      continue;
    }
    int better = 0;
    for (int i = 0; i < ALFAIZ_STEPS && !better; ++i, step *= (real)0.5)
      better = alfaiz_try(p, best->psi + step, best);
    if (!better) return;
  }
}

/* The swivel angle at which the upper arm is turned most like before. */
static inline real alfaiz_swivel_before(const alfaiz_problem *p) {
  real S[9], c = 0, s = 0;
#ifdef HAS_LANES_OF_alfaiz_shoulder
#if LANES > 1
  (void)armik_alfaiz_shoulder_lanes;
#endif
#endif
  armik_alfaiz_shoulder(p->previous, S);
  for (int i = 0; i < 9; ++i) {
    c += p->curve[10 + i] * S[i];
    s += p->curve[19 + i] * S[i];
  }
  return ALFAIZ_ATAN2(s, c);
}

/* The posture nearest to the one before: a grid, the swivel angle before, the cuts and the middles between
 * them, then downhill from the best few that are better than their neighbours. Returns whether one is inside the range of motion. */
static inline int alfaiz_nearest(alfaiz_problem *p, const alfaiz_settings *settings, const real *cuts,
                                 int n_cuts, alfaiz_posture *best) {
  real psi[ALFAIZ_MOST], costs[ALFAIZ_MOST], heights[ALFAIZ_MOST];
  alfaiz_posture at;
  int n = settings->grid, found = 0;
  const real spacing = ALFAIZ_TURN / (real)n;
  for (int i = 0; i < n; ++i) psi[i] = spacing * (real)i - ALFAIZ_PI;
  n = alfaiz_insert(alfaiz_swivel_before(p), psi, n);
  for (int i = 0; i < n_cuts; ++i) {
    n = alfaiz_insert(cuts[i], psi, n);
    n = alfaiz_insert(alfaiz_middle(cuts, n_cuts, i), psi, n);
  }
  for (int i = 0; i < n; ++i) {
    alfaiz_look(p, psi[i], &at);
    costs[i] = at.cost;
  }
  for (int i = 0; i < n; ++i) {
    const int valley = costs[i] < costs[i ? i - 1 : n - 1] && costs[i] <= costs[i + 1 < n ? i + 1 : 0];
    heights[i] = valley ? -costs[i] : -ALFAIZ_OUTSIDE;
  }
  for (int k = 0; k < ALFAIZ_VALLEYS; ++k) {
    const int i = alfaiz_largest(n, heights);
    if (!(heights[i] > -ALFAIZ_OUTSIDE)) break;
    heights[i] = -ALFAIZ_OUTSIDE;
    alfaiz_look(p, psi[i], &at);
    alfaiz_follow(p, &at);
    if (!found || at.cost < best->cost) *best = at;
    found = 1;
  }
  return found;
}

/* The best posture on the whole circle. */
static inline void alfaiz_search(alfaiz_problem *p, const alfaiz_settings *settings, alfaiz_posture *best) {
  real cuts[ALFAIZ_CUTS];
  const int n = alfaiz_cuts(p, cuts);
  if (p->previous && alfaiz_nearest(p, settings, cuts, n, best)) return;
  alfaiz_farthest(p, settings, cuts, n, best);
  /* Where only single postures are inside, they are at cuts. */
  if (best->margin < 0)
    for (int i = 0; i < n; ++i) alfaiz_try(p, cuts[i], best);
  if (p->previous && best->margin >= -ALFAIZ_ROUNDING) alfaiz_follow(p, best);
}

static inline void alfaiz_prepare(alfaiz_problem *p, const alfaiz_range *range, const real *target,
                                  const real *lengths, real side, const real *previous) {
  p->range = range;
  p->previous = previous;
  p->evaluations = 0;
  armik_alfaiz_curve(target, lengths, &side, p->curve);
  const real *wish = previous ? previous : range->middle;
  p->q4 = alfaiz_fitted(p->curve[0], range->lower[3], range->upper[3], wish[3]);
  p->margin4 = alfaiz_smaller(p->q4 - range->lower[3], range->upper[3] - p->q4);
  for (int group = 0; group < 2; ++group) {
    const real free_angle = group ? wish[4] : -wish[0];
    p->pole[group][0] = ALFAIZ_COS(free_angle);
    p->pole[group][1] = ALFAIZ_SIN(free_angle);
  }
}

/* Whether a posture near the one before was found by following it. */
static inline int alfaiz_follow_from_before(alfaiz_problem *p, real near, alfaiz_posture *best) {
  alfaiz_look(p, alfaiz_swivel_before(p), best);
  if (best->margin < -ALFAIZ_ROUNDING) return 0;
  alfaiz_follow(p, best);
  for (int j = 0; j < 7; ++j)
    if (!(ALFAIZ_FABS(best->q[j] - p->previous[j]) <= near)) return 0;
  return 1;
}

/* One pose. Returns the margin of the best posture, the elbow's included. */
static inline real alfaiz_solve(const alfaiz_settings *settings, const alfaiz_range *range, const real *target,
                                const real *lengths, const real *previous, real *q, int64_t *evaluations) {
  alfaiz_problem p;
  alfaiz_posture best;
  real margin = -ALFAIZ_OUTSIDE, cost = 0;
  int found = 0;
  for (int follow = previous != NULL; follow >= 0 && !found; --follow) {
    for (int side = 1; side >= -1; side -= 2) {
      alfaiz_prepare(&p, range, target, lengths, (real)side, previous);
      const int bent_inside = p.margin4 >= -ALFAIZ_ROUNDING;
      if (follow) {
        if (!bent_inside || !alfaiz_follow_from_before(&p, settings->near, &best)) {
          *evaluations += p.evaluations;
          continue;
        }
      } else {
        /* The side that is outside counts only if nothing else is left. */
        if (!bent_inside && margin > -ALFAIZ_OUTSIDE && p.margin4 < margin) continue;
        alfaiz_search(&p, settings, &best);
      }
      *evaluations += p.evaluations;
      const real least = alfaiz_smaller(best.margin, p.margin4);
      const int inside = least >= -ALFAIZ_ROUNDING;
      const real new_cost = inside && previous ? best.cost : (inside ? -least : ALFAIZ_OUTSIDE - least);
      if (margin > -ALFAIZ_OUTSIDE && !(new_cost < cost)) continue;
      margin = least;
      cost = new_cost;
      found = 1;
      for (int j = 0; j < 7; ++j) q[j] = best.q[j];
    }
  }
  return margin;
}

/* Whether the hand is where it should be. |R - R*| (Frobenius) = 2 sqrt(2) sin(angle / 2). */
static inline int alfaiz_arrived(const alfaiz_settings *settings, const real *target, const real *q,
                                 const real *lengths) {
  real pose[12], shift = 0, turn = 0;
  armik_pose(q, lengths, pose);
  for (int i = 0; i < 3; ++i) shift += (pose[i] - target[i]) * (pose[i] - target[i]);
  for (int i = 3; i < 12; ++i) turn += (pose[i] - target[i]) * (pose[i] - target[i]);
  turn = alfaiz_smaller(1, ALFAIZ_SQRT(turn / 8));
  return ALFAIZ_SQRT(shift) <= settings->tolerance && 2 * ALFAIZ_ASIN(turn) <= settings->tolerance;
}

static inline int alfaiz_is_sound(const real *target) {
  for (int i = 0; i < 12; ++i)
    if (!(ALFAIZ_FABS(target[i]) <= ALFAIZ_FARTHEST)) return 0;
  return 1;
}

/* Postures for n poses.
 *
 *   targets      n x 12: position [m], rotation row by row
 *   starts       chain = 1: one posture, each pose starts from the posture before; chain = 0: n postures;
 *                NULL if none is known
 *   q            n x 7 (out), inside the range of motion
 *   reached      n (out): 1 if inside the range of motion and at the target
 *   evaluations  n (out): postures looked at
 */
EXPORT void armik_alfaiz_path(const alfaiz_settings *settings, ptrdiff_t n, const real *targets,
                              const real *lengths, const real *lower, const real *upper, const real *starts,
                              int chain, real *q, unsigned char *reached, int64_t *evaluations) {
  const alfaiz_range range = alfaiz_range_of(lower, upper);
  for (ptrdiff_t i = 0; i < n; ++i) {
    const real *before = chain && i ? q + 7 * (i - 1) : (starts && !chain ? starts + 7 * i : starts);
    const real *target = targets + 12 * i, *previous = settings->nearest ? before : NULL;
    real *out = q + 7 * i, margin = -ALFAIZ_OUTSIDE;
    evaluations[i] = 0;
    if (alfaiz_is_sound(target))
      margin = alfaiz_solve(settings, &range, target, lengths, previous, out, evaluations + i);
    else
      for (int j = 0; j < 7; ++j) out[j] = before ? before[j] : range.middle[j];
    for (int j = 0; j < 7; ++j) out[j] = out[j] < lower[j] ? lower[j] : (out[j] > upper[j] ? upper[j] : out[j]);
    reached[i] = margin >= -ALFAIZ_ROUNDING && alfaiz_arrived(settings, target, out, lengths);
  }
}
