/* One generation of ISADE: mutation (9)-(11), scale factors (12)-(14), crossover with CR (15), selection. */

/* Rows as vectors where the compiler has them: several joints at once, and no branch to guess. */
#if LANES > 1
typedef lanes isade_part __attribute__((aligned(8), may_alias));
typedef lane_bits isade_bits __attribute__((aligned(8), may_alias));
#define ISADE_STEP LANES
#define ISADE_ALL(x) lanes_of(x)
#define ISADE_PART(row) (*(const isade_part *)(row))
#define ISADE_PUT(row, value) (*(isade_part *)(row) = (value))
#define ISADE_WHERE(yes, a, b) \
  ((lanes)(((lane_bits)(a) & (lane_bits)(yes)) | ((lane_bits)(b) & ~(lane_bits)(yes))))
/* Below 2^53, so the sign of the difference tells. */
#define ISADE_CROSSED(words, rate, forced) \
  (-((((*(const isade_bits *)(words)) >> 11) - (rate)) >> 63) | *(const isade_bits *)(forced))
#else
typedef real isade_part;
#define ISADE_STEP 1
#define ISADE_ALL(x) (x)
#define ISADE_PART(row) (*(row))
#define ISADE_PUT(row, value) (*(row) = (value))
#define ISADE_WHERE(yes, a, b) ((yes) ? (a) : (b))
#define ISADE_CROSSED(words, rate, forced) ((*(words) >> 11) < (rate) || *(forced))
#endif

/* Eq. (12) for the ranks 1 ... NP. */
static inline void isade_factors_by_rank(struct isade_search *search) {
  const struct isade_settings *settings = search->settings;
  const double n = settings->population;
  for (int i = 0; i < settings->population; ++i) {
    const double place = ((i + 1) - n / 2) / n;
    search->by_rank[i] = (real)(1 / (1 + exp((double)settings->alpha * place)));
  }
}

/* Eq. (13); iter = 1 ... iter_max. */
static inline real isade_mean_factor(const struct isade_settings *settings, int iter) {
  const double left = (double)(settings->iter_max - iter) / (double)settings->iter_max;
  return settings->f_min + (settings->f_max - settings->f_min) * (real)pow(left, (double)settings->n_iter);
}

/* Rank - 1 of a cost: how many of the population are lower; equal ones share a rank. Costs of rows that only
 * fill up a block are infinite. */
static inline int isade_rank(const real *cost, int population, real own) {
#if LANES > 1
  lane_bits below = {0};
  int better = 0;
  for (int k = 0; k < population; k += LANES) below -= (lane_bits)(ISADE_PART(cost + k) < ISADE_ALL(own));
  for (int i = 0; i < LANES; ++i) better += (int)below[i];
#else
  int better = 0;
  for (int k = 0; k < population; ++k) better += cost[k] < own;
#endif
  return better;
}

#define ISADE_SORT(a, b)                 \
  do {                                   \
    const int low = (a) < (b) ? (a) : (b); \
    (b) = (a) < (b) ? (b) : (a);         \
    (a) = low;                           \
  } while (0)

/* Four rows, different from each other and from row i: each is a number below what is left, counted past
 * the rows that are taken, from the lowest. */
static inline void isade_partners(const uint64_t *words, int population, int i, int r[4]) {
  int t0 = i, t1, t2, t3; /* taken, ascending */
  r[0] = random_below((uint32_t)(words[0] >> 32), population - 1);
  r[0] += r[0] >= t0;
  t1 = r[0];
  ISADE_SORT(t0, t1);
  r[1] = random_below((uint32_t)words[0], population - 2);
  r[1] += r[1] >= t0;
  r[1] += r[1] >= t1;
  t2 = r[1];
  ISADE_SORT(t1, t2);
  ISADE_SORT(t0, t1);
  r[2] = random_below((uint32_t)(words[1] >> 32), population - 3);
  r[2] += r[2] >= t0;
  r[2] += r[2] >= t1;
  r[2] += r[2] >= t2;
  t3 = r[2];
  ISADE_SORT(t2, t3);
  ISADE_SORT(t1, t2);
  ISADE_SORT(t0, t1);
  r[3] = random_below((uint32_t)words[1], population - 4);
  r[3] += r[3] >= t0;
  r[3] += r[3] >= t1;
  r[3] += r[3] >= t2;
  r[3] += r[3] >= t3;
}

/* Mutant = base + F ((A - B) + (C - D)), by indices into r1, r2, r3, r4, best. */
static const unsigned char isade_terms[3][5] = {
    {4, 0, 1, 2, 2}, /* (9)  best + F (r1 - r2) */
    {4, 0, 1, 2, 3}, /* (10) best + F (r1 - r2 + r3 - r4) */
    {0, 4, 0, 1, 2}, /* (11) r1 + F (best - r1 + r2 - r3) */
};

/* Where a mutant left the bounds, another value; what is still outside goes to the bound afterwards. */
static inline void isade_repair(const struct isade_search *search, const real *base, uint64_t counter,
                                real *mutant) {
  const real *lower = search->lower, *upper = search->upper;
  for (int j = 0; j < DOF; ++j) {
    if (mutant[j] >= lower[j] && mutant[j] <= upper[j]) continue;
    const real bound = mutant[j] < lower[j] ? lower[j] : upper[j];
    if (search->settings->repair == ISADE_REFLECT) {
      mutant[j] = 2 * bound - mutant[j];
    } else if (search->settings->repair == ISADE_MIDPOINT) {
      mutant[j] = (bound + base[j]) / 2;
    } else {
      const uint64_t bits = random_bits(search->key_of_repairs, counter * DOF + (uint64_t)j);
      mutant[j] = lower[j] + random_unit(bits) * (upper[j] - lower[j]);
    }
  }
}

/* Read from entry ISADE_ROW - j on, all bits of entry j are set: the joint that always crosses. */
static const uint64_t isade_forced[2 * ISADE_ROW] = {[ISADE_ROW] = ~UINT64_C(0)};

/* The trial of individual i; `words` are its random words, `counter` counts trials since the search began. */
static inline void isade_trial(const struct isade_search *search, int i, real F, const uint64_t *words,
                               uint64_t counter, real *restrict trial) {
  const struct isade_settings *settings = search->settings;
  const real *rows = search->population, *own = rows + (ptrdiff_t)i * ISADE_ROW;
  const int strategy = random_below((uint32_t)(words[0] >> 32), 3);
  const uint64_t *forced = isade_forced + ISADE_ROW - random_below((uint32_t)words[0], DOF);
  const uint64_t rate = search->rate[i];
  int r[5];
  isade_partners(words + 1, settings->population, i, r);
  r[4] = search->best;
  const real *term[5];
  for (int k = 0; k < 5; ++k) term[k] = rows + (ptrdiff_t)r[isade_terms[strategy][k]] * ISADE_ROW;
  for (int j = 0; j < ISADE_ROW; j += ISADE_STEP)
    ISADE_PUT(trial + j, ISADE_PART(term[0] + j) + F * ((ISADE_PART(term[1] + j) - ISADE_PART(term[2] + j)) +
                                                        (ISADE_PART(term[3] + j) - ISADE_PART(term[4] + j))));
  if (settings->repair != ISADE_CLIP) isade_repair(search, term[0], counter, trial);
  for (int j = 0; j < ISADE_ROW; j += ISADE_STEP) {
    const isade_part lower = ISADE_PART(search->lower + j), upper = ISADE_PART(search->upper + j);
    isade_part inside = ISADE_PART(trial + j);
    inside = ISADE_WHERE(inside > lower, inside, lower);
    inside = ISADE_WHERE(inside < upper, inside, upper);
    /* Binomial crossover: rand < CR, or j = j_rand. */
    ISADE_PUT(trial + j,
              ISADE_WHERE(ISADE_CROSSED(words + 5 + j, rate, forced + j), inside, ISADE_PART(own + j)));
  }
}

/* A trial replaces its parent if it is not worse. */
static inline void isade_select(struct isade_search *search) {
  for (int i = 0; i < search->settings->population; ++i) {
    real *restrict own = search->population + (ptrdiff_t)i * ISADE_ROW;
    const real *restrict trial = search->trials + (ptrdiff_t)i * ISADE_ROW;
    const real cost = search->cost[i], trial_cost = search->trial_cost[i];
    for (int j = 0; j < ISADE_ROW; j += ISADE_STEP)
      ISADE_PUT(own + j, ISADE_WHERE(ISADE_ALL(trial_cost) <= ISADE_ALL(cost), ISADE_PART(trial + j),
                                     ISADE_PART(own + j)));
    search->cost[i] = trial_cost <= cost ? trial_cost : cost;
  }
}

/* The first of the best, and the highest cost. */
static inline void isade_find_best(struct isade_search *search) {
  search->best = 0;
  search->worst = search->cost[0];
  for (int i = 1; i < search->settings->population; ++i) {
    if (search->cost[i] < search->cost[search->best]) search->best = i;
    search->worst = search->cost[i] > search->worst ? search->cost[i] : search->worst;
  }
}

/* Generation `iter` = 1 ... iter_max. */
static inline void isade_generation(struct isade_search *search, int iter) {
  const struct isade_settings *settings = search->settings;
  const int population = settings->population;
  const real mean = isade_mean_factor(settings, iter);
  const uint64_t first = (uint64_t)(iter - 1) * (uint64_t)population;
  for (int k = 0; k < population * ISADE_WORDS + ISADE_ROW; ++k)
    search->words[k] = random_bits(search->key_of_choices, first * ISADE_WORDS + (uint64_t)k);
  for (int i = 0; i < population; ++i) {
    const uint64_t *words = search->words + (ptrdiff_t)i * ISADE_WORDS;
    /* (15); printed with <=, but rand may be 0, and tau = 0 has to mean never. */
    search->rate[i] = random_unit(words[3]) < settings->tau ? words[4] >> 11 : search->rate[i];
    const real by_rank = search->by_rank[isade_rank(search->cost, population, search->cost[i])];
    const real F = (by_rank + settings->sign * mean) / 2;                                       /* (14) */
    isade_trial(search, i, F, words, first + (uint64_t)i, search->trials + (ptrdiff_t)i * ISADE_ROW);
  }
  isade_costs(search, search->trials, search->trial_cost);
  isade_select(search);
  isade_find_best(search);
}
