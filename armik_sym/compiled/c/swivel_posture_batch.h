/* Several postures at once, one per lane of a vector. */
#if LANES > 1
/* Rz Ry Rz of one lane; every lane has a curve of its own. */
static inline void swivel_gather(const swivel_request *r, ptrdiff_t i, real c, real s, int lane,
                                 real Q[18][LANES]) {
  const swivel_side *curve = swivel_side_of(r, i);
  const real *C = curve->parts + swivel_sample_of(r, i) * curve->parts_step;
  real one[9];
  for (int t = 0; t < r->arm->triples; ++t) {
    swivel_rotation(C + 27 * t, c, s, one);
    for (int k = 0; k < 9; ++k) Q[9 * t + k][lane] = one[k];
  }
}

/* Largest integers not above x, x below 1e15. */
static inline lanes swivel_floor_lanes(lanes x) {
  const lanes nearest = (x + LANES_ROUNDER) - LANES_ROUNDER;
  return nearest - lanes_select((lane_bits)(nearest > x), lanes_of(1.0), lanes_of(0.0));
}

/* As swivel_nearest_in_range, with the wish already inside the range. */
static inline lanes swivel_nearest_lanes(const swivel_arm *arm, int j, lanes angle, lanes wish) {
  const real lower = arm->lower[j], upper = arm->upper[j];
  const lanes q = angle + SWIVEL_TURN * swivel_floor_lanes((wish - angle) / SWIVEL_TURN + 0.5);
  const lane_bits down = (lane_bits)(q > upper + SWIVEL_ROUNDING) &
                         (lane_bits)(lower - (q - SWIVEL_TURN) < q - upper);
  const lane_bits up = (lane_bits)(q < lower - SWIVEL_ROUNDING) &
                       (lane_bits)(q + SWIVEL_TURN - upper < lower - q);
  return q + lanes_select(up, lanes_of(SWIVEL_TURN), lanes_select(down, lanes_of(-SWIVEL_TURN), lanes_of(0.0)));
}

/* Three angles of one triple before they are moved by whole turns, and |sin| of the second. */
static inline lanes swivel_angles_in_lanes(const swivel_arm *arm, int triple, real Q[9][LANES],
                                           const real *branches, lanes *angles) {
  lanes rotation[9], yx[6], side;
  memcpy(rotation, Q, sizeof rotation);
  memcpy(&side, branches, sizeof side);
  armik_swivel_quotients_lanes(rotation, yx);
  const lanes size = lanes_sqrt(yx[2]);
  angles[0] = lanes_atan2(side * yx[0], side * yx[1]);
  angles[1] = lanes_atan2(side * size, yx[3]) - arm->offset[triple];
  angles[2] = lanes_atan2(side * yx[4], side * yx[5]);
  return size;
}

/* The wish for a joint, inside its range. */
static inline lanes swivel_wishes_in_lanes(const swivel_request *r, ptrdiff_t first, int count, int j) {
  const real lower = r->arm->lower[j], upper = r->arm->upper[j];
  lanes wish = lanes_of(0.5 * (lower + upper));
  if (r->wish)
    for (int i = 0; i < count; ++i) wish[i] = swivel_clipped(swivel_wish_of(r, first + i)[j], lower, upper);
  return wish;
}

/* The postures first to first + count - 1; where outer axes are parallel, one by one. */
static void swivel_postures_in_lanes(const swivel_request *r, ptrdiff_t first, int count, real *q,
                                            real *sines) {
  const swivel_arm *arm = r->arm;
  const int triples = (int)arm->triples, dof = (int)arm->dof;
  real Q[18][LANES], branches[LANES];
  lanes psi = lanes_of(0.0), angles[7], sine[2] = {lanes_of(1.0), lanes_of(1.0)};
  memset(Q, 0, sizeof Q);
  for (int i = 0; i < count; ++i) psi[i] = r->psi[first + i];
  const lanes c = lanes_cos(psi), s = lanes_sin(psi);
  for (int i = 0; i < count; ++i) swivel_gather(r, first + i, c[i], s[i], i, Q);
  for (int t = 0; t < triples; ++t) {
    for (int i = 0; i < LANES; ++i) branches[i] = i < count ? swivel_branch_of(r, first + i, t) : 1.0;
    sine[t] = swivel_angles_in_lanes(arm, t, Q + 9 * t, branches, angles + 4 * t);
  }
  angles[3] = lanes_of(0.0);
  for (int i = 0; i < count; ++i) {
    const swivel_side *curve = swivel_side_of(r, first + i);
    angles[3][i] = curve->elbow[swivel_sample_of(r, first + i) * curve->elbow_step];
  }
  for (int j = 0; j < 3 * triples + 1; ++j)
    angles[j] = swivel_nearest_lanes(arm, j, angles[j], swivel_wishes_in_lanes(r, first, count, j));
  for (int i = 0; i < count; ++i) {
    const real least = swivel_smaller(sine[0][i], sine[1][i]);
    if (!(least * least >= SWIVEL_NEAR) || !(fabs(r->psi[first + i]) <= LANES_LARGEST_ANGLE)) {
      swivel_posture(r, first + i, q + i * dof, sines + 2 * i);
      continue;
    }
    for (int j = 0; j < 3 * triples + 1; ++j) q[i * dof + j] = angles[j][i];
    for (int t = 0; t < 2; ++t) sines[2 * i + t] = sine[t][i];
    swivel_copy_rest(r, first + i, q + i * dof);
  }
}
#endif

/* n postures.
 *
 *   sides        curves with elbow side 1 and with -1
 *   sample       n: index of the sample; NULL for 0, 1, 2, ...
 *   branch       n: 2^triples per side, shoulder and wrist 1 before -1
 *   wish         wished postures, `wish_step` numbers apart (0: one for all); NULL for none
 *   q            n x dof (out)
 *   sines        n x 2 (out): |sin| of the second angle of shoulder and wrist
 */
EXPORT void armik_swivel_postures(const swivel_arm *arm, const swivel_side *sides, ptrdiff_t n,
                                  const int64_t *sample, const int64_t *branch, const real *psi,
                                  const real *wish, ptrdiff_t wish_step, real *q, real *sines) {
  const swivel_request request = {arm, sides, sample, branch, psi, wish, wish_step};
#if LANES > 1
  for (ptrdiff_t i = 0; i < n; i += LANES)
    swivel_postures_in_lanes(&request, i, n - i < LANES ? (int)(n - i) : LANES, q + i * arm->dof, sines + 2 * i);
#else
  (void)armik_swivel_quotients;
  for (ptrdiff_t i = 0; i < n; ++i) swivel_posture(&request, i, q + i * arm->dof, sines + 2 * i);
#endif
}
