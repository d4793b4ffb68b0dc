/* Why a sample has no posture inside the range of motion: which joint blocks, and by how much. */

/* The posture of one side of the elbow that misses the range of motion least. */
typedef struct {
  real psi, missing;
  int64_t branch, joint;
} swivel_block;

/* Margin of the whole arm: the better branch of each triple, or the wanted one. */
static inline real swivel_whole_margin(real margins[4][SWIVEL_ARCS], int k, int triples, int wanted, real elbow) {
  real whole = elbow;
  for (int t = 0; t < triples; ++t) {
    const real first = margins[2 * t][k], second = margins[2 * t + 1][k];
    const int flipped = t + 1 < triples ? wanted >> 1 : wanted & 1;
    const real taken = wanted < 0 ? swivel_larger(first, second) : (flipped ? second : first);
    whole = swivel_smaller(whole, taken);
  }
  return whole;
}

/* What is missing at a swivel angle, and where; of joints that miss their limits alike the first. */
static inline swivel_block swivel_block_at(const swivel_arm *arm, const real *parts, real elbow, int wanted,
                                           real psi) {
  swivel_block block = {psi, 0, 0, 0};
  const int triples = (int)arm->triples;
  real taken[7], least = elbow;
  for (int t = 0; t < triples; ++t) {
    real margins[2][3];
    swivel_triple_margins(arm, t, parts + 27 * t, psi, margins);
    int flipped = swivel_smallest(margins[1]) > swivel_smallest(margins[0]);
    if (wanted >= 0) flipped = t + 1 < triples ? wanted >> 1 : wanted & 1;
    block.branch = 2 * block.branch + flipped;
    memcpy(taken + 3 * t, margins[flipped], sizeof margins[flipped]);
    least = swivel_smaller(least, swivel_smallest(margins[flipped]));
  }
  taken[3 * triples] = elbow;
  int k = 0;
  while (k < 3 * triples && taken[k] > least + SWIVEL_TIE) ++k;
  block.joint = k == 3 * triples ? 3 : k + (k >= 3);
  block.missing = -least;
  return block;
}

/* With every range widened by some angle, the arcs between the cuts tell exactly whether there is a posture;
 * the least such angle by bisection. `wanted` is a pair of branches of shoulder and wrist, or -1. */
static inline swivel_block swivel_least_missing(const swivel_arm *arm, const real *parts, real elbow,
                                                int wanted) {
  real least = -SWIVEL_PI, most = (real)INFINITY, best = 0;
  swivel_limits limits;
  for (int round = 0; round < SWIVEL_ROUNDS; ++round) {
    const real extra = most < (real)INFINITY ? 0.5 * (least + most) : 0;
    real cuts[SWIVEL_CUTS], psi[SWIVEL_ARCS], margins[4][SWIVEL_ARCS], margin = 0;
    swivel_limits_of(arm, extra, &limits);
    const int n = swivel_cuts(arm, &limits, parts, extra, cuts);
    int at = -1;
    swivel_middles(cuts, n, psi);
    swivel_margins(arm, parts, n, psi, margins);
    for (int k = 0; k < n; ++k) {
      const real whole = swivel_whole_margin(margins, k, (int)arm->triples, wanted, elbow);
      if (at >= 0 && !(whole > margin)) continue;
      margin = whole;
      at = k;
    }
    if (-margin < most) {
      most = -margin;
      best = psi[at];
    }
    if (-margin > extra) least = swivel_larger(least, extra);
  }
  swivel_block block = swivel_block_at(arm, parts, elbow, wanted, best);
  block.psi = best - SWIVEL_TURN * floor((best + SWIVEL_PI) / SWIVEL_TURN);
  return block;
}

/* What blocks n samples.
 *
 *   sides         curves with elbow side 1 and with -1
 *   sample        n: which samples
 *   wanted        only this branch; -1 for the best one
 *   branch, psi, joint, missing, shortfall    n each (out)
 */
EXPORT void armik_swivel_blocking(const swivel_arm *arm, const swivel_side *sides, ptrdiff_t n,
                                  const int64_t *sample, int64_t wanted, int64_t *branch, real *psi,
                                  int64_t *joint, real *missing, real *shortfall) {
  const int64_t pairs = (int64_t)1 << arm->triples;
  for (ptrdiff_t i = 0; i < n; ++i) {
    int taken = 0;
    for (int e = 0; e < 2; ++e) {
      if (wanted >= 0 && wanted / pairs != e) continue;
      const swivel_side *curve = sides + e;
      const ptrdiff_t k = (ptrdiff_t)sample[i];
      const real elbow = swivel_margin(arm, 3, curve->elbow[k * curve->elbow_step]);
      const int pair = wanted < 0 ? -1 : (int)(wanted % pairs);
      const swivel_block block = swivel_least_missing(arm, curve->parts + k * curve->parts_step, elbow, pair);
      if (taken && !(block.missing < missing[i])) continue;
      taken = 1;
      branch[i] = block.branch + e * pairs;
      psi[i] = block.psi;
      joint[i] = block.joint;
      missing[i] = block.missing;
      shortfall[i] = curve->shortfall[k * curve->shortfall_step];
    }
  }
}
