/* The postures of Al-Faiz: one free number, every posture exact.
 *
 * For a pose, all seven angles are known once the swivel angle psi of the elbow and the branches are chosen;
 * phi of the paper is atan2(-dx, dz) - q1. Generated code, from the equations (4)-(47) corrected:
 *
 *   armik_alfaiz_curve(pose, lengths, side, out)    out[0] = q4 (6); then S(psi) and W(psi), the rotations
 *       of shoulder (R_0^3 turned half about x) and wrist (36), as C0 + C1 cos psi + C2 sin psi
 *   armik_alfaiz_sides(R, pole, out)        (y, x) of the three angles of W, or minus those of S (39)-(47)
 *   armik_alfaiz_rates(R, dR, pole, out)    their derivatives
 *   armik_alfaiz_quotients_lanes(curve, (cos psi, sin psi), out)    (y, x) of all six, for several psi at
 *       once, with the square of x6 in its place
 *   armik_alfaiz_shoulder(q, out)           S of a posture
 */
#include <stdint.h>
#ifndef REAL_IS_FLOAT
#define REAL_IS_FLOAT 0
#endif
#if REAL_IS_FLOAT
#define ALFAIZ_ROUNDING 1e-5f
#define ALFAIZ_FARTHEST 1e6f
#define ALFAIZ_SQRT sqrtf
#define ALFAIZ_ASIN asinf
#define ALFAIZ_ATAN2 atan2f
#define ALFAIZ_SIN sinf
#define ALFAIZ_COS cosf
#define ALFAIZ_FABS fabsf
#define ALFAIZ_FLOOR floorf
#else
#define ALFAIZ_ROUNDING 1e-12
#define ALFAIZ_FARTHEST 1e6
#define ALFAIZ_SQRT sqrt
#define ALFAIZ_ASIN asin
#define ALFAIZ_ATAN2 atan2
#define ALFAIZ_SIN sin
#define ALFAIZ_COS cos
#define ALFAIZ_FABS fabs
#define ALFAIZ_FLOOR floor
#endif
#define ALFAIZ_PI ((real)3.14159265358979323846)
#define ALFAIZ_TURN ((real)6.28318530717958647693)
#define ALFAIZ_CUTS 24         /* six joints, two limits, two cuts each */
#define ALFAIZ_MOST (2 * ALFAIZ_CUTS + 257) /* swivel angles looked at together */
#define ALFAIZ_OUTSIDE 10000   /* cost of leaving the range of motion: more than any distance inside */

/* The range of motion, with what does not change along a path. */
typedef struct {
  real lower[7], upper[7], middle[7], half[7], sine[7][2], cosine[7][2];
  int free[7]; /* the range covers a full turn: no limit is ever met */
} alfaiz_range;

typedef struct {
  real q[7], psi, margin, cost;
  int flipped[2]; /* second solution of shoulder, of wrist */
} alfaiz_posture;

/* One pose with one side of the elbow. */
typedef struct {
  const alfaiz_range *range;
  const real *previous; /* posture before, NULL if none counts */
  real curve[55], q4, margin4, pole[2][2];
  int64_t evaluations;
} alfaiz_problem;

static inline real alfaiz_smaller(real a, real b) { return a < b ? a : b; }

static inline alfaiz_range alfaiz_range_of(const real *lower, const real *upper) {
  alfaiz_range r;
  for (int j = 0; j < 7; ++j) {
    r.lower[j] = lower[j];
    r.upper[j] = upper[j];
    r.middle[j] = (real)0.5 * (lower[j] + upper[j]);
    r.half[j] = (real)0.5 * (upper[j] - lower[j]);
    r.free[j] = upper[j] - lower[j] >= ALFAIZ_TURN - ALFAIZ_ROUNDING;
    r.sine[j][0] = ALFAIZ_SIN(lower[j]);
    r.sine[j][1] = ALFAIZ_SIN(upper[j]);
    r.cosine[j][0] = ALFAIZ_COS(lower[j]);
    r.cosine[j][1] = ALFAIZ_COS(upper[j]);
  }
  return r;
}

/* Of all angle + 2 pi k the one inside the range and nearest to a wish; if none is inside, the one that
 * leaves it least. */
static inline real alfaiz_fitted(real angle, real lower, real upper, real wish) {
  const real q = angle + ALFAIZ_TURN * ALFAIZ_FLOOR((wish - angle) * (1 / ALFAIZ_TURN) + (real)0.5);
  if (q > upper + ALFAIZ_ROUNDING) return lower - (q - ALFAIZ_TURN) < q - upper ? q - ALFAIZ_TURN : q;
  if (q < lower - ALFAIZ_ROUNDING) return q + ALFAIZ_TURN - upper < lower - q ? q + ALFAIZ_TURN : q;
  return q;
}

/* Three angles put into the range: their smallest margin and their distance from the wish, squared. */
static inline void alfaiz_fit_three(const alfaiz_range *r, int first, const real *angles, const real *wish,
                                    real *q, real *margin, real *distance) {
  *margin = ALFAIZ_OUTSIDE;
  *distance = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = first + i;
    q[i] = alfaiz_fitted(angles[i], r->lower[j], r->upper[j], wish[j]);
    *margin = alfaiz_smaller(*margin, alfaiz_smaller(q[i] - r->lower[j], r->upper[j] - q[i]));
    *distance += (q[i] - wish[j]) * (q[i] - wish[j]);
  }
}

/* Rotation of shoulder (0) or wrist (1) at a swivel angle. */
static inline void alfaiz_rotation(const real *curve, int group, real c, real s, real *R) {
  const real *a = curve + 1 + 27 * group;
  for (int i = 0; i < 9; ++i) R[i] = a[i] + a[9 + i] * c + a[18 + i] * s;
}

/* Six angles from sines and cosines, each pair times a positive number. */
static inline void alfaiz_arc_tangents(const real *sides, real *angles) {
#if defined(LANES) && LANES > 1 && !REAL_IS_FLOAT
  for (int start = 0; start < 6; start += LANES) {
    const int count = 6 - start < LANES ? 6 - start : LANES;
    lanes y = lanes_of(0.0), x = lanes_of(1.0);
    for (int i = 0; i < count; ++i) {
      y[i] = sides[2 * (start + i)];
      x[i] = sides[2 * (start + i) + 1];
    }
    const lanes angle = lanes_atan2(y, x);
    for (int i = 0; i < count; ++i) angles[start + i] = angle[i];
  }
#else
  for (int i = 0; i < 6; ++i) angles[i] = ALFAIZ_ATAN2(sides[2 * i], sides[2 * i + 1]);
#endif
}

/* The best branches at a swivel angle: shoulder and wrist choose independently. */
static inline void alfaiz_look(alfaiz_problem *p, real psi, alfaiz_posture *out) {
  const real c = ALFAIZ_COS(psi), s = ALFAIZ_SIN(psi);
  const real *wish = p->previous ? p->previous : p->range->middle;
  real distance = (p->q4 - wish[3]) * (p->q4 - wish[3]), margin = ALFAIZ_OUTSIDE;
  real R[9], sides[12], angles[6];
  for (int group = 0; group < 2; ++group) {
    alfaiz_rotation(p->curve, group, c, s, R);
    armik_alfaiz_sides(R, p->pole[group], sides + 6 * group);
  }
  alfaiz_arc_tangents(sides, angles);
  for (int i = 0; i < 3; ++i) angles[i] = -angles[i];
  for (int group = 0; group < 2; ++group) {
    const real *one = angles + 3 * group;
    const real other[3] = {one[0] + ALFAIZ_PI, ALFAIZ_PI - one[1], one[2] + ALFAIZ_PI};
    real q[2][3], margins[2], distances[2];
    alfaiz_fit_three(p->range, 4 * group, one, wish, q[0], margins, distances);
    alfaiz_fit_three(p->range, 4 * group, other, wish, q[1], margins + 1, distances + 1);
    const int inside = margins[0] >= -ALFAIZ_ROUNDING && margins[1] >= -ALFAIZ_ROUNDING;
    const int k = p->previous && inside ? distances[1] < distances[0] : margins[1] > margins[0];
    for (int i = 0; i < 3; ++i) out->q[4 * group + i] = q[k][i];
    out->flipped[group] = k;
    margin = alfaiz_smaller(margin, margins[k]);
    distance += distances[k];
  }
  p->evaluations++;
  out->q[3] = p->q4;
  out->psi = psi;
  out->margin = margin;
  out->cost = p->previous && margin >= -ALFAIZ_ROUNDING ? distance : -margin;
  if (p->previous && margin < -ALFAIZ_ROUNDING) out->cost += ALFAIZ_OUTSIDE;
}

/* Sort a swivel angle into n others. Returns their new number. */
static inline int alfaiz_insert(real psi, real *sorted, int n) {
  if (psi >= ALFAIZ_PI) psi -= ALFAIZ_TURN;
  if (psi < -ALFAIZ_PI) psi += ALFAIZ_TURN;
  int i = n;
  for (; i > 0 && sorted[i - 1] > psi; --i) sorted[i] = sorted[i - 1];
  sorted[i] = psi;
  return n + 1;
}

/* psi with a + b cos psi + c sin psi = 0, sorted into the others. */
static inline int alfaiz_add_cuts(real a, real b, real c, real *cuts, int n) {
  const real h = ALFAIZ_SQRT(b * b + c * c), square = (h - a) * (h + a);
  if (!(h > ALFAIZ_ROUNDING) || square < -ALFAIZ_ROUNDING * h * h) return n;
  const real towards = ALFAIZ_ATAN2(c, b);
  const real aside = ALFAIZ_ATAN2(square > 0 ? ALFAIZ_SQRT(square) : 0, -a);
  n = alfaiz_insert(towards + aside, cuts, n);
  return alfaiz_insert(towards - aside, cuts, n);
}

/* All psi at which a joint other than the elbow is at a limit, or half a turn from it; sorted.
 *
 * With r_ij of (37): c6 sin(limit - q5) = sin r13 + cos r33 (41), (42); r23 = sin q6 (39);
 * c6 sin(limit - q7) = -(sin r21 + cos r22) (45), (46). The shoulder has the same with angles reversed.
 */
static inline int alfaiz_cuts(const alfaiz_problem *p, real *cuts) {
  int n = 0;
  for (int group = 0; group < 2; ++group) {
    const real *a = p->curve + 1 + 27 * group;
    for (int limit = 0; limit < 2; ++limit) {
      for (int i = 0; i < 3; ++i) {
        const int j = 4 * group + i;
        if (p->range->free[j]) continue;
        const real s = group ? p->range->sine[j][limit] : -p->range->sine[j][limit];
        const real c = p->range->cosine[j][limit];
        if (i == 1) {
          n = alfaiz_add_cuts(a[5] - s, a[14], a[23], cuts, n);
          continue;
        }
        const int u = i ? 3 : 2, v = i ? 4 : 8; /* r21 and r22, or r13 and r33 */
        n = alfaiz_add_cuts(s * a[u] + c * a[v], s * a[9 + u] + c * a[9 + v], s * a[18 + u] + c * a[18 + v],
                            cuts, n);
      }
    }
  }
  return n;
}

/* Smallest margin at n swivel angles, with the best branches: half the range minus the distance from its
 * middle. */
static inline void alfaiz_margins(alfaiz_problem *p, int n, const real *psi, real *margins) {
  (void)armik_alfaiz_quotients; /* one of the two serves */
#if defined(LANES) && LANES > 1 && !REAL_IS_FLOAT
  const alfaiz_range *r = p->range;
  lanes curve[55], turn[2], sides[12];
  for (int i = 0; i < 55; ++i) curve[i] = lanes_of(p->curve[i]);
  for (int start = 0; start < n; start += LANES) {
    const int count = n - start < LANES ? n - start : LANES;
    lanes angle = lanes_of(0.0), margin = lanes_of((real)ALFAIZ_OUTSIDE);
    for (int i = 0; i < count; ++i) angle[i] = psi[start + i];
    turn[0] = lanes_cos(angle);
    turn[1] = lanes_sin(angle);
    armik_alfaiz_quotients_lanes(curve, turn, sides);
    for (int group = 0; group < 2; ++group) {
      lanes best[2] = {lanes_of((real)ALFAIZ_OUTSIDE), lanes_of((real)ALFAIZ_OUTSIDE)};
      for (int i = 0; i < 3; ++i) {
        const lanes *yx = sides + 6 * group + 2 * i;
        const int j = 4 * group + i;
        const lanes q = lanes_atan2(yx[0], i == 1 ? lanes_sqrt(yx[1]) : yx[1]);
        const real middle = group ? r->middle[j] : -r->middle[j];
        for (int k = 0; k < 2; ++k) {
          const lanes branch = k == 0 ? q : (i == 1 ? ALFAIZ_PI - q : q + ALFAIZ_PI);
          best[k] = lanes_smaller(best[k], r->half[j] - lanes_turned_away(branch - middle));
        }
      }
      margin = lanes_smaller(margin, -lanes_smaller(-best[0], -best[1]));
    }
    for (int i = 0; i < count; ++i) margins[start + i] = margin[i];
  }
  p->evaluations += n;
#else
  alfaiz_posture at;
  for (int i = 0; i < n; ++i) {
    alfaiz_look(p, psi[i], &at);
    margins[i] = at.margin;
  }
#endif
}
