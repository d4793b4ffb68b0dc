/* The cost of eq. (16): a |q - q_0| + b |hand error|, for one posture and for all rows of a population. */

/* Squared hand error; out is p (3) for ISADE_POSITION, otherwise p and R row by row (12). Direction cosines:
 * the diagonal of R (the paper does not say which). Pose: |R - R*|_F / sqrt(2) = 2 sin(angle / 2). */
#define ISADE_HAND_SQUARED(number, name)                                                                  \
  static inline number name(const number *out, const real *target, int measure, real weight) {            \
    const number x = out[0] - target[0], y = out[1] - target[1], z = out[2] - target[2];                  \
    number squared = x * x + y * y + z * z, turned = x * 0;                                               \
    if (measure == ISADE_POSITION) return squared;                                                        \
    for (int k = 3; k < 12; k += measure == ISADE_COSINES ? 4 : 1) {                                      \
      const number off = out[k] - target[k];                                                              \
      turned = turned + off * off;                                                                        \
    }                                                                                                     \
    return squared + turned * (measure == ISADE_POSE ? weight * weight / 2 : weight * weight);            \
  }

ISADE_HAND_SQUARED(real, isade_hand_squared)

/* b |hand error| of one posture. */
static inline real isade_hand_cost(const struct isade_search *search, const real *q) {
  const struct isade_settings *settings = search->settings;
  real out[12];
  if (settings->measure == ISADE_POSITION) armik_position(q, search->lengths, out);
  else armik_pose(q, search->lengths, out);
  const real squared =
      isade_hand_squared(out, search->target, settings->measure, settings->rotation_weight);
  return settings->hand_weight * REAL_SQRT(squared);
}

static inline real isade_travel_cost(const struct isade_search *search, const real *q) {
  real squared = 0;
  for (int j = 0; j < DOF; ++j) squared += (q[j] - search->centre[j]) * (q[j] - search->centre[j]);
  return search->travel_weight * REAL_SQRT(squared);
}

#if LANES > 1 && defined(HAS_LANES_OF_position) && defined(HAS_LANES_OF_pose)
ISADE_HAND_SQUARED(lanes, isade_hand_squared_lanes)

static inline void isade_hand_costs(const struct isade_search *search, const real *rows, real *cost,
                                    int measure) {
  const struct isade_settings *settings = search->settings;
  lanes lengths[N_LENGTHS + 1], q[DOF], out[12];
  for (int j = 0; j < N_LENGTHS; ++j) lengths[j] = lanes_of(search->lengths[j]);
  for (int j = 0; j < DOF; ++j) q[j] = lanes_of(0.0); /* so that a compiler sees a value */
  for (int first = 0; first < settings->population; first += LANES) {
    const real *block = rows + (ptrdiff_t)first * ISADE_ROW;
    for (int j = 0; j < DOF; ++j)
      for (int i = 0; i < LANES; ++i) q[j][i] = block[i * ISADE_ROW + j];
    if (measure == ISADE_POSITION) armik_position_lanes(q, lengths, out);
    else armik_pose_lanes(q, lengths, out);
    const lanes squared =
        isade_hand_squared_lanes(out, search->target, measure, settings->rotation_weight);
    for (int i = 0; i < LANES; ++i) cost[first + i] = settings->hand_weight * REAL_SQRT(squared[i]);
  }
}
#else
static inline void isade_hand_costs(const struct isade_search *search, const real *rows, real *cost,
                                    int measure) {
  (void)measure;
  for (int i = 0; i < search->settings->population; ++i)
    cost[i] = isade_hand_cost(search, rows + (ptrdiff_t)i * ISADE_ROW);
}
#endif

/* Eq. (16) of all rows. */
static inline void isade_costs(struct isade_search *search, const real *rows, real *cost) {
  search->evaluations += search->settings->population;
  switch (search->settings->measure) { /* constants let the compiler drop what is not needed */
    case ISADE_POSITION: isade_hand_costs(search, rows, cost, ISADE_POSITION); break;
    case ISADE_COSINES: isade_hand_costs(search, rows, cost, ISADE_COSINES); break;
    default: isade_hand_costs(search, rows, cost, ISADE_POSE);
  }
  if (search->travel_weight == 0) return;
  for (int i = 0; i < search->settings->population; ++i)
    cost[i] += isade_travel_cost(search, rows + (ptrdiff_t)i * ISADE_ROW);
}
