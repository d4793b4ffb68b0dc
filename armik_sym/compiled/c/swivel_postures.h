/* Postures for samples, branches and swivel angles in any order. */

/* What is asked for; see armik_swivel_postures. */
typedef struct {
  const swivel_arm *arm;
  const swivel_side *sides;
  const int64_t *sample, *branch;
  const real *psi, *wish;
  ptrdiff_t wish_step;
} swivel_request;

static inline const swivel_side *swivel_side_of(const swivel_request *r, ptrdiff_t i) {
  return r->sides + (r->branch[i] >= (int64_t)1 << r->arm->triples);
}

static inline ptrdiff_t swivel_sample_of(const swivel_request *r, ptrdiff_t i) {
  return r->sample ? (ptrdiff_t)r->sample[i] : i;
}

/* Branch of a triple: 1 or -1. */
static inline real swivel_branch_of(const swivel_request *r, ptrdiff_t i, int triple) {
  const int64_t flipped = triple + 1 < r->arm->triples ? r->branch[i] >> 1 & 1 : r->branch[i] & 1;
  return flipped ? -1.0 : 1.0;
}

static inline const real *swivel_wish_of(const swivel_request *r, ptrdiff_t i) {
  return r->wish ? r->wish + i * r->wish_step : NULL;
}

/* Angles of the joints after the elbow that the caller gave. */
static inline void swivel_copy_rest(const swivel_request *r, ptrdiff_t i, real *q) {
  const swivel_side *curve = swivel_side_of(r, i);
  if (!curve->rest) return;
  const real *rest = curve->rest + swivel_sample_of(r, i) * curve->rest_step;
  for (int j = 4; j < r->arm->dof; ++j) q[j] = rest[j - 4];
}

/* One posture. */
static void swivel_posture(const swivel_request *r, ptrdiff_t i, real *q, real *sines) {
  const swivel_arm *arm = r->arm;
  const swivel_side *curve = swivel_side_of(r, i);
  const ptrdiff_t sample = swivel_sample_of(r, i);
  const real *C = curve->parts + sample * curve->parts_step, *wish = swivel_wish_of(r, i);
  const real c = cos(r->psi[i]), s = sin(r->psi[i]);
  const int triples = (int)arm->triples;
  real angles[7] = {0};
  angles[3] = curve->elbow[sample * curve->elbow_step];
  sines[1] = 1;
  for (int t = 0; t < triples; ++t) {
    real Q[9];
    swivel_rotation(C + 27 * t, c, s, Q);
    sines[t] = fabs(swivel_triple_angles(arm, t, Q, swivel_branch_of(r, i, t), wish ? wish + 4 * t : NULL,
                                         angles + 4 * t));
  }
  for (int j = 0; j < 3 * triples + 1; ++j) {
    const real wished = wish ? wish[j] : 0.5 * (arm->lower[j] + arm->upper[j]);
    q[j] = swivel_nearest_in_range(arm, j, angles[j], wished);
  }
  swivel_copy_rest(r, i, q);
}
