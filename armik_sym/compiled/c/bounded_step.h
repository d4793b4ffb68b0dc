/* The damped least-squares step that stays inside the range of motion:
 *
 *   min |J d - e|^2 + damping |d|^2   subject to   lower <= q + d <= upper.
 *
 * Without a limit in the way it is (J^T J + damping I)^-1 J^T e: Al-Faiz, eq. 62, with e = target - F and
 * J = dF/dq. Otherwise an active set: go towards the minimum of the free joints up to the first limit, fix
 * the joint that meets it, and let go a fixed joint where that lowers the objective. Every round lowers
 * the objective, so a step that stops at the limit of rounds still leads downhill.
 */
typedef struct {
  real A[SMALL][SMALL];
  real right[SMALL];
  real left[SMALL]; /* e - J d of the fixed joints */
  real columns[SMALL][DOF];
  real towards[DOF];
  real lowest[DOF], highest[DOF];
  int free_joints[DOF]; /* their indices */
  signed char side[DOF]; /* -1, 1: fixed at its lower, upper limit; 0: free */
} step_workspace;

/* Most rounds of a step; one or two are the rule. */
#define STEP_ROUNDS (4 * DOF)

/* The minimum over the free joints; `towards` of fixed joints stays at their d. Returns 0 on failure. */
static inline int armik_free_minimum(const real *J, const real *e, int m, real damping, const real *d,
                                     step_workspace *w) {
  int n = 0;
  for (int i = 0; i < m; ++i) w->left[i] = e[i];
  for (int j = 0; j < DOF; ++j) {
    if (!w->side[j]) {
      w->free_joints[n++] = j;
      continue;
    }
    w->towards[j] = d[j];
    for (int i = 0; i < m; ++i) w->left[i] -= J[i * DOF + j] * d[j];
  }
  if (n == 0) return 1;
  if (m < n) { /* dual form: d = A^T (A A^T + damping I)^-1 left; columns of fixed joints are zeros */
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < DOF; ++j) w->columns[i][j] = w->side[j] ? 0 : J[i * DOF + j];
      for (int k = 0; k <= i; ++k) {
        real sum = i == k ? damping : 0;
        for (int j = 0; j < DOF; ++j) sum += w->columns[i][j] * w->columns[k][j];
        w->A[i][k] = sum;
      }
      w->right[i] = w->left[i];
    }
    if (!armik_small_solve(m, w->A, w->right)) return 0;
    for (int j = 0; j < DOF; ++j) {
      if (w->side[j]) continue;
      real sum = 0;
      for (int i = 0; i < m; ++i) sum += w->columns[i][j] * w->right[i];
      w->towards[j] = sum;
    }
    return 1;
  }
  for (int f = 0; f < n; ++f) { /* d = (A^T A + damping I)^-1 A^T left */
    const int j = w->free_joints[f];
    for (int g = 0; g <= f; ++g) {
      real sum = f == g ? damping : 0;
      for (int i = 0; i < m; ++i) sum += J[i * DOF + j] * J[i * DOF + w->free_joints[g]];
      w->A[f][g] = sum;
    }
    w->right[f] = 0;
    for (int i = 0; i < m; ++i) w->right[f] += J[i * DOF + j] * w->left[i];
  }
  if (!armik_small_solve(n, w->A, w->right)) return 0;
  for (int f = 0; f < n; ++f) w->towards[w->free_joints[f]] = w->right[f];
  return 1;
}

/* Move d towards the minimum of the free joints, up to the first limit. Returns whether it got there. */
static inline int armik_go_up_to_limit(real *d, step_workspace *w) {
  real share = 1;
  int stopped = -1;
  for (int j = 0; j < DOF; ++j) {
    const real end = w->towards[j];
    if (w->side[j] || (end >= w->lowest[j] && end <= w->highest[j])) continue;
    const real limit = end < w->lowest[j] ? w->lowest[j] : w->highest[j];
    const real possible = (limit - d[j]) / (end - d[j]);
    if (stopped >= 0 && possible >= share) continue;
    share = possible > 0 ? possible : 0;
    stopped = j;
  }
  for (int j = 0; j < DOF; ++j)
    if (!w->side[j]) d[j] = stopped < 0 ? w->towards[j] : d[j] + share * (w->towards[j] - d[j]);
  if (stopped < 0) return 1;
  w->side[stopped] = w->towards[stopped] < w->lowest[stopped] ? -1 : 1;
  d[stopped] = w->side[stopped] < 0 ? w->lowest[stopped] : w->highest[stopped];
  return 0;
}

/* Let go the fixed joint that pulls hardest back into its range. Returns whether there was one. */
static inline int armik_let_go(const real *J, int m, real damping, const real *d, step_workspace *w) {
  real hardest = 0;
  int found = -1, fixed = 0;
  for (int j = 0; j < DOF; ++j) fixed |= w->side[j];
  if (!fixed) return 0;
  for (int i = 0; i < m; ++i) { /* left = e - J d, also of the free joints */
    for (int j = 0; j < DOF; ++j)
      if (!w->side[j]) w->left[i] -= J[i * DOF + j] * d[j];
  }
  for (int j = 0; j < DOF; ++j) {
    if (!w->side[j] || !(w->lowest[j] < w->highest[j])) continue;
    real pull = -damping * d[j]; /* minus half the slope of the objective */
    for (int i = 0; i < m; ++i) pull += J[i * DOF + j] * w->left[i];
    pull = w->side[j] < 0 ? pull : -pull;
    if (pull > hardest) {
      hardest = pull;
      found = j;
    }
  }
  if (found < 0) return 0;
  w->side[found] = 0;
  return 1;
}

/* One damped step.
 *
 *   J       m rows of DOF numbers, m <= 6         e      residual, target minus current, m numbers
 *   damping > 0                                   q      posture with lower <= q <= upper
 *   d       the step, DOF numbers (out)           w      caller's memory, needs no preparation
 *
 * Returns the rounds spent, or 0 with d = 0 if the numbers allow no step (a NaN, or damping too small).
 */
static inline int armik_damped_step(const real *J, const real *e, int m, real damping, const real *q,
                                    const real *lower, const real *upper, real *d, step_workspace *w) {
  for (int j = 0; j < DOF; ++j) {
    w->lowest[j] = lower[j] - q[j];
    w->highest[j] = upper[j] - q[j];
    w->side[j] = 0;
    d[j] = 0;
    if (w->lowest[j] < 0 && w->highest[j] > 0) continue;
    /* At a limit: fixed at once if it pulls outwards. */
    real pull = 0;
    for (int i = 0; i < m; ++i) pull += J[i * DOF + j] * e[i];
    if (!(w->lowest[j] < 0) && pull <= 0) w->side[j] = -1;
    if (!(w->highest[j] > 0) && pull >= 0) w->side[j] = 1;
  }
  for (int round = 1; round <= STEP_ROUNDS; ++round) {
    if (!armik_free_minimum(J, e, m, damping, d, w)) {
      if (round == 1)
        for (int j = 0; j < DOF; ++j) d[j] = 0;
      return round - 1;
    }
    if (armik_go_up_to_limit(d, w) && !armik_let_go(J, m, damping, d, w)) return round;
  }
  return STEP_ROUNDS;
}
