/* ISADE and Pro-ISADE along a path, one sample after another (Nguyen 2021, sections 3.3 and 4.2). */

/* First population: uniform inside the bounds; CR uniform in [0, 1). Rows that only fill up a block of lanes
 * hold the centre. */
static inline void isade_start(struct isade_search *search, uint64_t key, int centre_first) {
  const int population = search->settings->population;
  for (int i = 0; i < ISADE_PADDED(population); ++i) {
    real *row = search->population + (ptrdiff_t)i * ISADE_ROW;
    real *trial = search->trials + (ptrdiff_t)i * ISADE_ROW;
    const uint64_t counter = (uint64_t)i * (DOF + 1);
    for (int j = 0; j < ISADE_ROW; ++j) row[j] = trial[j] = search->centre[j];
    if (i >= population) continue;
    search->rate[i] = random_bits(key, counter + DOF) >> 11;
    if (i == 0 && centre_first) continue;
    for (int j = 0; j < DOF; ++j) {
      const real unit = random_unit(random_bits(key, counter + (uint64_t)j));
      const real value = search->lower[j] + unit * (search->upper[j] - search->lower[j]);
      row[j] = value < search->upper[j] ? value : search->upper[j];
    }
  }
}

/* One search inside search->lower ... upper, at most `iter_max` generations; adds those it took. The best is
 * row search->best. */
static inline void isade_run(struct isade_search *search, uint64_t key, int centre_first, int iter_max,
                             int *generations) {
  const struct isade_settings *settings = search->settings;
  search->key_of_choices = random_branch(key, 1);
  search->key_of_repairs = random_branch(key, 2);
  isade_start(search, random_branch(key, 0), centre_first);
  isade_factors_by_rank(search);
  isade_costs(search, search->population, search->cost);
  for (int i = settings->population; i < ISADE_PADDED(settings->population); ++i) search->cost[i] = REAL_INFINITY;
  isade_find_best(search);
  for (int iter = 1; iter <= iter_max; ++iter) {
    if (search->cost[search->best] < settings->stop) return;
    isade_generation(search, iter);
    ++*generations;
    const real best = search->cost[search->best];
    if (search->may_stall && search->worst - best < settings->stall * best) return;
  }
}

/* around + window; where that rounds to more than the window, one or two numbers nearer. */
static inline real isade_window_end(real around, real window) {
  const real end = around + window, ulp = (real)(REAL_IS_FLOAT ? 1.0 / (1 << 23) : 1.0 / (INT64_C(1) << 52));
  if (!(REAL_FABS(end - around) > REAL_FABS(window))) return end;
  return window > 0 ? end - REAL_FABS(end) * ulp : end + REAL_FABS(end) * ulp;
}

/* Bounds of a search: the window around a posture inside the range of motion. The difference of a posture
 * inside and that one, rounded, is never above the window. */
static inline void isade_bounds(struct isade_search *search, const real *around, const real *lower,
                                const real *upper, real window) {
  for (int j = 0; j < DOF; ++j) {
    const real below = isade_window_end(around[j], -window), above = isade_window_end(around[j], window);
    search->lower[j] = below > lower[j] ? below : lower[j];
    search->upper[j] = above < upper[j] ? above : upper[j];
  }
}

static inline void isade_move_to_best(struct isade_search *search) {
  const real *best = search->population + (ptrdiff_t)search->best * ISADE_ROW;
  for (int j = 0; j < DOF; ++j) search->centre[j] = best[j];
}

/* First sample: full range of motion, a >= 0, no stall, q_0 is the centre and one of the individuals. Returns b |hand
 * error| of the best, which becomes the centre. */
static inline real isade_first(struct isade_search *search, uint64_t key, const real *lower,
                               const real *upper, int *generations) {
  search->travel_weight = search->settings->travel_weight;
  search->may_stall = 0;
  isade_bounds(search, search->centre, lower, upper, REAL_INFINITY);
  isade_run(search, random_branch(key, 0), 1, search->settings->iter_max, generations);
  isade_move_to_best(search);
  return isade_hand_cost(search, search->centre);
}

/* Following samples: a = 0, in the window around the previous posture, the centre. A search that stalls hands
 * over to another one, within the same iter_max generations and the same window; with moving_window, and at
 * the first sample, which has no previous posture, in one around the best so far. Returns b |hand error| of
 * the best, which becomes the centre. */
static inline real isade_following(struct isade_search *search, uint64_t key, const real *lower,
                                   const real *upper, int centre_first, int *generations) {
  const struct isade_settings *settings = search->settings;
  const int seeded = isfinite(settings->window), moving = settings->moving_window || centre_first;
  real previous[DOF];
  int spent = 0;
  real error = REAL_INFINITY;
  search->travel_weight = 0;
  search->may_stall = 1;
  for (int j = 0; j < DOF; ++j) previous[j] = search->centre[j];
  for (uint64_t attempt = 1; spent < settings->iter_max && !(error < settings->stop); ++attempt) {
    isade_bounds(search, moving ? search->centre : previous, lower, upper, settings->window);
    isade_run(search, random_branch(key, attempt), attempt == 1 ? centre_first : seeded,
              settings->iter_max - spent, &spent);
    if (!(search->cost[search->best] < error)) continue;
    error = search->cost[search->best];
    isade_move_to_best(search);
  }
  *generations += spent;
  return error;
}

/* Sample number `sample` of a path: the posture of the sample before is the centre, and the one found becomes
 * the centre. Returns b |hand error|. */
static inline real isade_sample(struct isade_search *search, uint64_t seed, uint64_t sample, const real *lower,
                                const real *upper, int *generations) {
  const uint64_t key = random_branch(seed, sample);
  real error = REAL_INFINITY;
  search->evaluations = *generations = 0;
  if (sample == 0) error = isade_first(search, key, lower, upper, generations);
  if (!(error < search->settings->stop))
    error = isade_following(search, key, lower, upper, sample == 0, generations);
  return error;
}

#ifdef EXPORT
/* Samples first ... first + n - 1 of a path; `targets` and what is `_out` begin at sample `first`.
 * `previous` is the posture before sample `first`, inside the range of motion (at sample 0: q_0 of eq. (16));
 * afterwards it is that of the last sample, so that a path can be done in blocks. A sample is reached if its
 * entry of `error_out`, b |hand error|, is below the stop value; then it is no NaN either. */
EXPORT void armik_isade_path(const struct isade_settings *settings, uint64_t seed, ptrdiff_t first,
                             ptrdiff_t n, const real *targets, const real *lengths, const real *lower,
                             const real *upper, real *previous, real *reals, uint64_t *words, real *q_out,
                             real *error_out, int *generations_out, int *evaluations_out) {
  struct isade_search search = {0};
  search.settings = settings;
  search.lengths = lengths;
  isade_attach(&search, reals, words);
  for (int j = 0; j < DOF; ++j) search.centre[j] = previous[j];
  for (ptrdiff_t k = 0; k < n; ++k) {
    search.target = targets + 12 * k;
    error_out[k] = isade_sample(&search, seed, (uint64_t)(first + k), lower, upper, &generations_out[k]);
    for (int j = 0; j < DOF; ++j) q_out[k * DOF + j] = search.centre[j];
    evaluations_out[k] = search.evaluations;
  }
  for (int j = 0; j < DOF; ++j) previous[j] = search.centre[j];
}
#endif
