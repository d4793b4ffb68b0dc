/* What the loops over the swivel angle share: the arm, the curves of its samples, angles and their limits.
 *
 * Order of decisions and names are those of the Python package armik_sym.swivel, which says where the formulas come from.
 * SWIVEL_ROUNDING, SWIVEL_REACH, SWIVEL_POLE, SWIVEL_NEAR, SWIVEL_PARALLEL and SWIVEL_ROUNDS come from there.
 */
#include <stdint.h>
#define SWIVEL_PI 3.14159265358979323846
#define SWIVEL_TURN 6.28318530717958647693

/* An arm, as Python gives it. Triple 0 is joints 0 to 2 (shoulder), triple 1 is joints 4 to 6 (wrist). */
typedef struct {
  int64_t dof;
  int64_t triples; /* 2, or 1 where only positions are asked for */
  real lower[7], upper[7];
  real offset[2]; /* of the second joint of each triple */
} swivel_arm;

/* Curves of many samples with one side of the elbow; a step is the distance between samples, in numbers. */
typedef struct {
  const real *parts; /* C0, C1, C2 of each triple: 27 numbers each, row by row */
  const real *elbow;
  const real *shortfall;
  const real *rest; /* angles of the joints after the elbow, NULL for poses */
  ptrdiff_t parts_step, elbow_step, shortfall_step, rest_step;
} swivel_side;

static inline real swivel_smaller(real a, real b) { return a < b ? a : b; }

static inline real swivel_larger(real a, real b) { return a > b ? a : b; }

static inline real swivel_clipped(real x, real least, real most) {
  return swivel_smaller(swivel_larger(x, least), most);
}

/* x - 2 pi k for the nearest k. */
static inline real swivel_turned_back(real x) { return x - SWIVEL_TURN * rint(x / SWIVEL_TURN); }

/* How far the best of all angle + 2 pi k is inside the range. */
static inline real swivel_margin(const swivel_arm *arm, int j, real angle) {
  const real away = angle - 0.5 * (arm->lower[j] + arm->upper[j]);
  return 0.5 * (arm->upper[j] - arm->lower[j]) - fabs(swivel_turned_back(away));
}

/* Of all angle + 2 pi k the one inside the range nearest to a wish, or leaving the range least. */
static inline real swivel_nearest_in_range(const swivel_arm *arm, int j, real angle, real wish) {
  const real lower = arm->lower[j], upper = arm->upper[j];
  const real inside_wish = swivel_clipped(wish, lower, upper);
  const real q = angle + SWIVEL_TURN * floor((inside_wish - angle) / SWIVEL_TURN + 0.5);
  if (q > upper + SWIVEL_ROUNDING && lower - (q - SWIVEL_TURN) < q - upper) return q - SWIVEL_TURN;
  if (q < lower - SWIVEL_ROUNDING && q + SWIVEL_TURN - upper < lower - q) return q + SWIVEL_TURN;
  return q;
}

/* Rz Ry Rz at a swivel angle, row by row. */
static inline void swivel_rotation(const real *C, real c, real s, real *Q) {
  for (int i = 0; i < 9; ++i) Q[i] = C[i] + C[9 + i] * c + C[18 + i] * s;
}

#if LANES > 1
/* The same for several swivel angles or arms. */
static inline void swivel_rotation_lanes(const lanes *C, lanes c, lanes s, lanes *Q) {
  for (int i = 0; i < 9; ++i) Q[i] = C[i] + C[9 + i] * c + C[18 + i] * s;
}
#endif
