/* Newton steps over the coordinates of a curve that never leave their bounds. Needs curve_objective.h.
 *
 * With the Hessian H (five bands), coordinates at a bound that the gradient pushes outwards are held there; the
 * step over the others is -(H + shift) \ gradient with the smallest shift that makes the matrix positive, cut
 * to a longest step, and halved until the objective falls enough. */

#define DESCENT_LONGEST 0.5
#define DESCENT_ARMIJO 1e-4
#define DESCENT_HALVINGS 12
#define DESCENT_AT_BOUND 1e-12
#define DESCENT_SMALLEST_SHIFT 1e-6
#define DESCENT_LARGEST_SHIFT 1e6

/* Solves (diagonal + two bands) step = -gradient by L D L'; 0 if the matrix is not positive. */
static int descent_solve(ptrdiff_t n, const real *diagonal, const real *next, const real *after,
                         const real *gradient, real *d, real *l1, real *l2, real *step) {
  for (ptrdiff_t k = 0; k < n; ++k) {
    real pivot = diagonal[k];
    if (k > 0) pivot -= l1[k - 1] * l1[k - 1] * d[k - 1];
    if (k > 1) pivot -= l2[k - 2] * l2[k - 2] * d[k - 2];
    if (!(pivot > 0)) return 0;
    d[k] = pivot;
    if (k + 1 < n) {
      real below = next[k];
      if (k > 0) below -= l2[k - 1] * d[k - 1] * l1[k - 1];
      l1[k] = below / pivot;
    }
    if (k + 2 < n) l2[k] = after[k] / pivot;
  }
  for (ptrdiff_t k = 0; k < n; ++k) {
    step[k] = -gradient[k];
    if (k > 0) step[k] -= l1[k - 1] * step[k - 1];
    if (k > 1) step[k] -= l2[k - 2] * step[k - 2];
  }
  for (ptrdiff_t k = 0; k < n; ++k) step[k] /= d[k];
  for (ptrdiff_t k = n - 1; k >= 0; --k) {
    if (k + 1 < n) step[k] -= l1[k] * step[k + 1];
    if (k + 2 < n) step[k] -= l2[k] * step[k + 2];
  }
  return 1;
}

/* The step, in `step`; returns the shift it took. `room` has place for 8 n numbers. */
static real descent_step(ptrdiff_t n, const real *x, const real *lower, const real *upper, const real *gradient,
                         const real *bands, real shift, real *step, real *room) {
  real *diagonal = room, *next = room + n, *after = room + 2 * n, *g = room + 3 * n, *held = room + 4 * n;
  real *d = room + 5 * n, *l1 = room + 6 * n, *l2 = room + 7 * n;
  real typical = 1e-300, longest = 0;
  for (ptrdiff_t k = 0; k < n; ++k) {
    typical = fmax(typical, fabs(bands[k]));
    held[k] = (x[k] <= lower[k] + DESCENT_AT_BOUND && gradient[k] > 0) ||
              (x[k] >= upper[k] - DESCENT_AT_BOUND && gradient[k] < 0);
    g[k] = held[k] != 0 ? 0 : gradient[k];
  }
  for (ptrdiff_t k = 0; k < n; ++k) {
    next[k] = k + 1 < n && held[k] + held[k + 1] == 0 ? bands[n + k] : 0;
    after[k] = k + 2 < n && held[k] + held[k + 2] == 0 ? bands[2 * n + k] : 0;
  }
  for (;;) {
    for (ptrdiff_t k = 0; k < n; ++k) diagonal[k] = held[k] != 0 ? typical : bands[k] + shift * typical;
    if (descent_solve(n, diagonal, next, after, g, d, l1, l2, step)) break;
    if (shift > DESCENT_LARGEST_SHIFT) { /* not finite */
      for (ptrdiff_t k = 0; k < n; ++k) step[k] = 0;
      return shift;
    }
    shift = fmax(4 * shift, DESCENT_SMALLEST_SHIFT);
  }
  for (ptrdiff_t k = 0; k < n; ++k) longest = fmax(longest, fabs(step[k]));
  if (longest > DESCENT_LONGEST)
    for (ptrdiff_t k = 0; k < n; ++k) step[k] *= DESCENT_LONGEST / longest;
  return shift;
}

/* Begins at x and leaves the end there; returns the number of steps. `value` is the objective at the end. Ends
 * when a step promises a relative improvement below `enough`. `room` has place for 48 n numbers. */
EXPORT int armik_curve_descend(ptrdiff_t n, const int *chart, real *x, const real *parameters, const real *speed,
                               const real *bend, const real *hold, const real *aim, const real *lower,
                               const real *upper, int most, real enough, real *value, real *room) {
  real *q = room, *slope = room + 7 * n, *curvature = room + 14 * n, *force = room + 21 * n;
  real *gradient = room + 28 * n, *bands = room + 29 * n, *step = room + 32 * n, *tried = room + 33 * n;
  real shift = 0;
  if (most < 1) *value = armik_curve_value(n, chart, x, parameters, speed, bend, hold, aim, q);
  for (int done = 1; done <= most; ++done) {
    *value = armik_curve_derivatives(n, chart, x, parameters, speed, bend, hold, aim, q, slope, curvature, force,
                                     gradient, bands);
    shift = descent_step(n, x, lower, upper, gradient, bands, shift, step, room + 34 * n);
    real promised = 0;
    for (ptrdiff_t k = 0; k < n; ++k) promised -= gradient[k] * step[k];
    if (!(promised > enough * fabs(*value))) return done;
    real share = 1;
    int halvings = 0;
    for (; halvings < DESCENT_HALVINGS; ++halvings, share *= 0.5) {
      real along = 0;
      for (ptrdiff_t k = 0; k < n; ++k) {
        tried[k] = fmin(fmax(x[k] + share * step[k], lower[k]), upper[k]);
        along += gradient[k] * (tried[k] - x[k]);
      }
      const real there = armik_curve_value(n, chart, tried, parameters, speed, bend, hold, aim, q);
      if (there <= *value + DESCENT_ARMIJO * along) {
        *value = there;
        break;
      }
    }
    if (halvings == DESCENT_HALVINGS) {
      if (shift > DESCENT_LARGEST_SHIFT) return done;
      shift = fmax(10 * shift, DESCENT_SMALLEST_SHIFT);
      continue;
    }
    for (ptrdiff_t k = 0; k < n; ++k) x[k] = tried[k];
    shift *= 0.1;
  }
  return most < 1 ? 0 : most;
}
