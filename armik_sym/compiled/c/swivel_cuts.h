/* At which swivel angles joints are at their limits: the roots of a + b cos psi + c sin psi = 0.
 *
 * At most 24 cuts: six joints, two limits, two roots each. Where outer axes are parallel for every psi, the
 * four equations of these two joints have no roots, and two for their sum or difference take their place.
 */
#define SWIVEL_CUTS 24
#define SWIVEL_EQUATIONS 16 /* 12, two more per triple with parallel axes; whole vectors */

typedef struct {
  int n;
  real a[SWIVEL_EQUATIONS], b[SWIVEL_EQUATIONS], c[SWIVEL_EQUATIONS];
} swivel_equations;

/* Sines and cosines of the limits of the six joints, and which of them have limits at all. */
typedef struct {
  real sine[7][2], cosine[7][2];
  int free[7];
} swivel_limits;

/* Limits widened by `extra` at both ends; of the second joints with their offset. */
static void swivel_limits_of(const swivel_arm *arm, real extra, swivel_limits *limits) {
  for (int t = 0; t < arm->triples; ++t) {
    for (int k = 0; k < 3; ++k) {
      const int j = 4 * t + k;
      const real offset = k == 1 ? arm->offset[t] : 0;
      const real ends[2] = {arm->lower[j] - extra + offset, arm->upper[j] + extra + offset};
      limits->free[j] = arm->upper[j] - arm->lower[j] >= SWIVEL_TURN - SWIVEL_ROUNDING;
      for (int i = 0; i < 2; ++i) {
        limits->sine[j][i] = sin(ends[i]);
        limits->cosine[j][i] = cos(ends[i]);
      }
    }
  }
}

/* s * x - c * y = 0 for two entries x, y of Rz Ry Rz; x_sign multiplies x. */
static inline void swivel_add_equation(swivel_equations *e, const real *C, int x, real x_sign, int y, real s,
                                       real c) {
  const int n = e->n++;
  s *= x_sign;
  e->a[n] = s * C[x] - c * C[y];
  e->b[n] = s * C[9 + x] - c * C[9 + y];
  e->c[n] = s * C[18 + x] - c * C[18 + y];
}

/* Limits of alpha + gamma, or of alpha - gamma, where the outer axes are parallel for every psi. */
static void swivel_add_parallel(const swivel_arm *arm, int triple, const real *C, real extra,
                                       swivel_equations *e) {
  static const int outer[4] = {2, 5, 6, 7};
  const int j = 4 * triple;
  for (int p = 0; p < 3; ++p)
    for (int i = 0; i < 4; ++i)
      if (!(fabs(C[9 * p + outer[i]]) < SWIVEL_PARALLEL)) return;
  if (C[8] == 0) return;
  const real sign = C[8] > 0 ? 1 : -1;
  const real third[2] = {sign > 0 ? arm->lower[j + 2] : -arm->upper[j + 2],
                         sign > 0 ? arm->upper[j + 2] : -arm->lower[j + 2]};
  if (arm->upper[j] + third[1] - arm->lower[j] - third[0] >= SWIVEL_TURN - SWIVEL_ROUNDING) return;
  const real ends[2] = {arm->lower[j] + third[0] - 2 * extra, arm->upper[j] + third[1] + 2 * extra};
  for (int i = 0; i < 2; ++i) {
    const real s = sin(ends[i]), c = cos(ends[i]);
    const int n = e->n++;
    real *const out[3] = {e->a + n, e->b + n, e->c + n};
    for (int p = 0; p < 3; ++p) {
      const real *part = C + 9 * p;
      *out[p] = s * (sign * part[0] + part[4]) - c * (sign * part[3] - part[1]);
    }
  }
}

static void swivel_equations_of(const swivel_arm *arm, const swivel_limits *limits, const real *parts,
                                       real extra, swivel_equations *e) {
  e->n = 0;
  for (int t = 0; t < arm->triples; ++t) {
    const real *C = parts + 27 * t;
    for (int k = 0; k < 3; ++k) {
      const int j = 4 * t + k;
      if (limits->free[j]) continue;
      for (int i = 0; i < 2; ++i) {
        const real s = limits->sine[j][i], c = limits->cosine[j][i];
        if (k == 0) swivel_add_equation(e, C, 2, 1, 5, s, c);
        if (k == 2) swivel_add_equation(e, C, 6, -1, 7, s, c);
        if (k != 1) continue;
        const int n = e->n++;
        e->a[n] = C[8] - c;
        e->b[n] = C[17];
        e->c[n] = C[26];
      }
    }
    swivel_add_parallel(arm, t, C, extra, e);
  }
}

/* Angles between -3 pi and 3 pi, in [-pi, pi). */
static inline real swivel_wrapped(real psi) {
  if (psi >= SWIVEL_PI) psi -= SWIVEL_TURN;
  if (psi < -SWIVEL_PI) psi += SWIVEL_TURN;
  return psi >= SWIVEL_PI ? -SWIVEL_PI : psi;
}

/* Sort an angle into n others. Returns their new number. */
static inline int swivel_insert(real psi, real *sorted, int n) {
  if (n == SWIVEL_CUTS) return n;
  int i = n;
  for (; i > 0 && sorted[i - 1] > psi; --i) sorted[i] = sorted[i - 1];
  sorted[i] = psi;
  return n + 1;
}

/* psi = towards -+ aside for every equation that has roots. */
static void swivel_roots(const swivel_equations *e, real *towards, real *aside, int *some) {
#if LANES > 1
  for (int start = 0; start < e->n; start += LANES) {
    lanes a, b, c;
    memcpy(&a, e->a + start, sizeof a);
    memcpy(&b, e->b + start, sizeof b);
    memcpy(&c, e->c + start, sizeof c);
    const lanes h = lanes_sqrt(b * b + c * c), square = (h - a) * (h + a);
    const lanes root = lanes_sqrt(-lanes_smaller(lanes_of(0.0), -square));
    const lanes middle = lanes_atan2(c, b), half = lanes_atan2(root, -a);
    memcpy(towards + start, &middle, sizeof a);
    memcpy(aside + start, &half, sizeof a);
    for (int i = 0; i < LANES; ++i)
      some[start + i] = h[i] > SWIVEL_ROUNDING && square[i] >= -SWIVEL_ROUNDING * h[i] * h[i];
  }
#else
  for (int i = 0; i < e->n; ++i) {
    const real a = e->a[i], b = e->b[i], c = e->c[i];
    const real h = sqrt(b * b + c * c), square = (h - a) * (h + a);
    some[i] = h > SWIVEL_ROUNDING && square >= -SWIVEL_ROUNDING * h * h;
    towards[i] = atan2(c, b);
    aside[i] = atan2(sqrt(square > 0 ? square : 0), -a);
  }
#endif
}

/* All cuts of one sample, sorted, SWIVEL_CUTS places. Returns how many; never none. Where an equation has no
 * roots, -pi is there twice, as in NumPy. */
static int swivel_cuts(const swivel_arm *arm, const swivel_limits *limits, const real *parts, real extra,
                              real *cuts) {
  swivel_equations e;
  real towards[SWIVEL_EQUATIONS], aside[SWIVEL_EQUATIONS];
  int some[SWIVEL_EQUATIONS], n = 0, missing = 0;
  memset(&e, 0, sizeof e);
  swivel_equations_of(arm, limits, parts, extra, &e);
  swivel_roots(&e, towards, aside, some);
  for (int i = 0; i < e.n; ++i) {
    if (!some[i]) {
      missing = 1;
      continue;
    }
    n = swivel_insert(swivel_wrapped(towards[i] - aside[i]), cuts, n);
    n = swivel_insert(swivel_wrapped(towards[i] + aside[i]), cuts, n);
  }
  for (int i = 0; i < (missing ? 2 : e.n == 0); ++i) n = swivel_insert(-SWIVEL_PI, cuts, n);
  return n;
}

/* The middle of every arc between a cut and the next; SWIVEL_ARCS places, zeros at the end. */
static inline void swivel_middles(const real *cuts, int n, real *psi) {
  for (int i = 0; i < SWIVEL_ARCS; ++i) psi[i] = 0;
  for (int i = 0; i + 1 < n; ++i) psi[i] = 0.5 * (cuts[i] + cuts[i + 1]);
  psi[n - 1] = 0.5 * (cuts[n - 1] + (cuts[0] + SWIVEL_TURN));
}
