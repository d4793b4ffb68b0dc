/* Where every joint is inside its range of motion: intervals of the swivel angle, for samples and branches.
 *
 * Runs of feasible arcs have arcs between them that are not, so 24 arcs make at most 12 intervals.
 */
#define SWIVEL_MOST_INTERVALS (SWIVEL_CUTS / 2)

/* Where the answers go, one entry per interval. */
typedef struct {
  ptrdiff_t count;
  int64_t *sample, *branch;
  real *start, *end;
} swivel_found;

/* Runs of ones among n bits that go around. */
static void swivel_runs(uint32_t feasible, int n, const real *cuts, ptrdiff_t sample, int branch,
                               swivel_found *found) {
  const int everywhere = feasible == (((uint32_t)1 << n) - 1);
  for (int k = 0; k < n && feasible; ++k) {
    const int before = k ? k - 1 : n - 1;
    if (!everywhere && (!(feasible >> k & 1) || (feasible >> before & 1))) continue;
    int last = k;
    real around = 0;
    while (!everywhere && (feasible >> (last + 1 < n ? last + 1 : 0) & 1)) {
      if (++last == n) {
        last = 0;
        around = SWIVEL_TURN;
      }
    }
    const real following = last + 1 < n ? cuts[last + 1] : cuts[0] + SWIVEL_TURN;
    const ptrdiff_t i = found->count++;
    found->sample[i] = sample;
    found->branch[i] = branch;
    found->start[i] = everywhere ? -SWIVEL_PI : cuts[k];
    found->end[i] = everywhere ? SWIVEL_PI : following + around;
    if (everywhere) return;
  }
}

/* One sample and side of the elbow; `first` is its first branch. */
static inline void swivel_intervals_of(const swivel_arm *arm, const swivel_limits *limits, const real *parts,
                                       ptrdiff_t sample, int first, swivel_found *found) {
  real cuts[SWIVEL_CUTS], psi[SWIVEL_ARCS], margins[4][SWIVEL_ARCS];
  uint32_t inside[4] = {0, 0, 0, 0};
  const int n = swivel_cuts(arm, limits, parts, 0, cuts), triples = (int)arm->triples;
  swivel_middles(cuts, n, psi);
  swivel_margins(arm, parts, n, psi, margins);
  for (int i = 0; i < 2 * triples; ++i)
    for (int k = 0; k < n; ++k) inside[i] |= (uint32_t)(margins[i][k] >= -SWIVEL_ROUNDING) << k;
  for (int pair = 0; pair < 1 << triples; ++pair) {
    const uint32_t feasible = triples == 2 ? inside[pair >> 1] & inside[2 + (pair & 1)] : inside[pair];
    swivel_runs(feasible, n, cuts, sample, first + pair, found);
  }
}

/* Intervals of n samples with both sides of the elbow, sorted by sample, branch and start.
 *
 *   first         number of the first sample
 *   sides         curves with elbow side 1 and with -1
 *   sample, branch, start, end    (out) room for SWIVEL_MOST_INTERVALS per sample and branch
 *   empty         n x branches (out): 1 where there is no interval
 *
 * Returns how many intervals there are.
 */
EXPORT ptrdiff_t armik_swivel_intervals(const swivel_arm *arm, const swivel_side *sides, ptrdiff_t first,
                                        ptrdiff_t n, int64_t *sample, int64_t *branch, real *start, real *end,
                                        unsigned char *empty) {
  swivel_found found = {0, sample, branch, start, end};
  swivel_limits limits;
  swivel_limits_of(arm, 0, &limits);
  const int pairs = 1 << arm->triples;
  memset(empty, 1, (size_t)n * 2 * (size_t)pairs);
  for (ptrdiff_t i = 0; i < n; ++i) {
    const ptrdiff_t before = found.count;
    for (int e = 0; e < 2; ++e) {
      const swivel_side *curve = sides + e;
      const ptrdiff_t k = first + i;
      if (!(curve->shortfall[k * curve->shortfall_step] <= SWIVEL_REACH)) continue;
      if (!(swivel_margin(arm, 3, curve->elbow[k * curve->elbow_step]) >= -SWIVEL_ROUNDING)) continue;
      swivel_intervals_of(arm, &limits, curve->parts + k * curve->parts_step, k, e * pairs, &found);
    }
    for (ptrdiff_t k = before; k < found.count; ++k) empty[i * 2 * pairs + branch[k]] = 0;
  }
  return found.count;
}
