/* How far the joints of shoulder and wrist are inside their ranges at many swivel angles, on both branches. */
#define SWIVEL_ARCS 40 /* room for swivel angles looked at together: 24, and whole vectors */

/* Margins of three joints at one swivel angle: branch 1, then branch -1. */
static void swivel_triple_margins(const swivel_arm *arm, int triple, const real *C, real psi,
                                         real margins[2][3]) {
  real Q[9], angles[3];
  swivel_rotation(C, cos(psi), sin(psi), Q);
  swivel_triple_angles(arm, triple, Q, 1.0, NULL, angles);
  /* Where the axes are parallel both branches are one. */
  const real half_turn = Q[2] * Q[2] + Q[5] * Q[5] < SWIVEL_POLE ? 0 : SWIVEL_PI;
  const real offset = arm->offset[triple];
  const real other[3] = {angles[0] + half_turn, -(angles[1] + offset) - offset, angles[2] + half_turn};
  for (int i = 0; i < 3; ++i) {
    margins[0][i] = swivel_margin(arm, 4 * triple + i, angles[i]);
    margins[1][i] = swivel_margin(arm, 4 * triple + i, other[i]);
  }
}

/* The smallest of three. */
static inline real swivel_smallest(const real *x) {
  return swivel_smaller(x[0], swivel_smaller(x[1], x[2]));
}

static inline void swivel_margins_one_by_one(const swivel_arm *arm, int triple, const real *C, int n,
                                             const real *psi, real *first, real *second) {
  real margins[2][3];
  for (int i = 0; i < n; ++i) {
    swivel_triple_margins(arm, triple, C, psi[i], margins);
    first[i] = swivel_smallest(margins[0]);
    second[i] = swivel_smallest(margins[1]);
  }
}

#if LANES > 1
static inline lanes swivel_margin_lanes(const swivel_arm *arm, int j, lanes angle) {
  const real middle = 0.5 * (arm->lower[j] + arm->upper[j]), half = 0.5 * (arm->upper[j] - arm->lower[j]);
  return half - lanes_turned_away(angle - middle);
}

/* The same for LANES swivel angles, given by (cos psi, sin psi). Returns whether an axis is parallel to
 * another: then the answer does not count. */
static inline int swivel_margins_in_lanes(const swivel_arm *arm, int triple, const lanes *C, const lanes *turn,
                                          lanes *first, lanes *second) {
  const int j = 4 * triple;
  const real offset = arm->offset[triple];
  lanes Q[9], yx[6];
  swivel_rotation_lanes(C, turn[0], turn[1], Q);
  armik_swivel_quotients_lanes(Q, yx);
  const lanes a = lanes_atan2(yx[0], yx[1]), c = lanes_atan2(yx[4], yx[5]);
  const lanes b = lanes_atan2(lanes_sqrt(yx[2]), yx[3]);
  *first = lanes_smaller(swivel_margin_lanes(arm, j, a), swivel_margin_lanes(arm, j + 2, c));
  *first = lanes_smaller(*first, swivel_margin_lanes(arm, j + 1, b - offset));
  *second = lanes_smaller(swivel_margin_lanes(arm, j, a + SWIVEL_PI),
                          swivel_margin_lanes(arm, j + 2, c + SWIVEL_PI));
  *second = lanes_smaller(*second, swivel_margin_lanes(arm, j + 1, -b - offset));
  int parallel = 0;
  for (int i = 0; i < LANES; ++i) parallel |= !(yx[2][i] >= SWIVEL_POLE);
  return parallel;
}
#endif

/* Smallest margin of each triple on each branch at n swivel angles; margins[2 * triple + branch]. `psi` must
 * have SWIVEL_ARCS entries that are numbers. */
static void swivel_margins(const swivel_arm *arm, const real *parts, int n, const real *psi,
                                  real margins[4][SWIVEL_ARCS]) {
#if LANES > 1
  lanes C[2][27];
  for (int t = 0; t < arm->triples; ++t)
    for (int i = 0; i < 27; ++i) C[t][i] = lanes_of(parts[27 * t + i]);
  for (int start = 0; start < n; start += LANES) {
    lanes angle, turn[2];
    memcpy(&angle, psi + start, sizeof angle);
    turn[0] = lanes_cos(angle);
    turn[1] = lanes_sin(angle);
    for (int t = 0; t < arm->triples; ++t) {
      lanes both[2];
      real *first = margins[2 * t] + start, *second = margins[2 * t + 1] + start;
      if (swivel_margins_in_lanes(arm, t, C[t], turn, both, both + 1)) {
        const int count = n - start < LANES ? n - start : LANES;
        swivel_margins_one_by_one(arm, t, parts + 27 * t, count, psi + start, first, second);
        continue;
      }
      memcpy(first, both, sizeof angle);
      memcpy(second, both + 1, sizeof angle);
    }
  }
#else
  for (int t = 0; t < arm->triples; ++t)
    swivel_margins_one_by_one(arm, t, parts + 27 * t, n, psi, margins[2 * t], margins[2 * t + 1]);
#endif
}
