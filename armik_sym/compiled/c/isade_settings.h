/* ISADE and Pro-ISADE (Nguyen 2021, section 3): settings, sizes and workspace.
 *
 * Files in order: real_math.h, random_stream.h, isade_settings.h, isade_cost.h, isade_generation.h, isade.h.
 * Nothing is allocated: the caller gives arrays of armik_isade_reals() and armik_isade_words() entries.
 */

/* What of the hand's error counts, eq. (16). */
enum { ISADE_POSITION, ISADE_COSINES, ISADE_POSE };

/* What happens to a coordinate of a mutant outside its bounds. */
enum { ISADE_CLIP, ISADE_REFLECT, ISADE_RANDOM, ISADE_MIDPOINT };

struct isade_settings {
  int population;       /* NP, at least 5 */
  int iter_max;         /* generations per search */
  int measure;          /* ISADE_POSITION, ISADE_COSINES or ISADE_POSE */
  int repair;           /* ISADE_CLIP ... ISADE_MIDPOINT */
  int moving_window;    /* 1: after a stall the window moves to the best posture so far */
  real alpha;           /* gain of the sigmoid, eq. (12) */
  real f_min, f_max;    /* ends of F_mean, eq. (13) */
  real n_iter;          /* its exponent, eq. (13) */
  real sign;            /* before F_mean in eq. (14): -1 as printed, +1 for the average */
  real tau;             /* odds of a new crossover rate, eq. (15) */
  real travel_weight;   /* a of eq. (16) at the first sample [m/rad] */
  real hand_weight;     /* b of eq. (16) */
  real rotation_weight; /* length that weighs like one radian [m] */
  real stop;            /* a cost below this ends a search */
  real stall;           /* a search ends if costs differ by less than this many times the best; 0: never */
  real window;          /* half width around the previous posture [rad]; infinite: none (ISADE) */
};

/* Postures are rows of ISADE_ROW numbers, the last ones 0, so that a row fills vector registers. */
#define ISADE_ROW (((DOF) + LANES - 1) / LANES * LANES)
#define ISADE_PADDED(population) (((population) + 7) / 8 * 8)

/* Random words of one individual in one generation: strategy and crossover joint; r1 and r2; r3 and r4;
 * whether CR changes; the new CR; one per joint for the crossover. */
#define ISADE_WORDS (5 + (DOF))

/* Lengths of the two parts of the workspace; population of type ptrdiff_t. */
#define ISADE_REALS_FOR(population) (ISADE_PADDED(population) * (2 * ISADE_ROW + 3))
#define ISADE_WORDS_FOR(population) ((population) * (ISADE_WORDS + 1) + ISADE_ROW)

#ifdef EXPORT
EXPORT ptrdiff_t armik_isade_reals(int population) { return ISADE_REALS_FOR((ptrdiff_t)population); }
EXPORT ptrdiff_t armik_isade_words(int population) { return ISADE_WORDS_FOR((ptrdiff_t)population); }
#endif

/* One search: what is wanted, where, and the state of the population. */
struct isade_search {
  const struct isade_settings *settings;
  const real *target, *lengths; /* pose of the hand: p, then R row by row; segment lengths */
  real travel_weight;           /* a of eq. (16) in this search */
  int may_stall;                /* 1: this search ends if it stalls */
  real lower[ISADE_ROW], upper[ISADE_ROW], centre[ISADE_ROW];
  real *population, *trials;          /* rows */
  real *cost, *trial_cost, *by_rank;  /* by_rank: F_i of eq. (12) */
  uint64_t *words, *rate;             /* rate: CR times 2^53 */
  uint64_t key_of_choices, key_of_repairs;
  int best;   /* row of the best individual */
  real worst; /* the highest cost */
  int evaluations; /* of the cost, since the sample began */
};

static inline void isade_attach(struct isade_search *search, real *reals, uint64_t *words) {
  const ptrdiff_t padded = ISADE_PADDED(search->settings->population);
  search->population = reals;
  search->trials = search->population + padded * ISADE_ROW;
  search->cost = search->trials + padded * ISADE_ROW;
  search->trial_cost = search->cost + padded;
  search->by_rank = search->trial_cost + padded;
  search->rate = words;
  search->words = search->rate + search->settings->population;
}
