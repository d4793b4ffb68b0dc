/* Damped least squares, pose by pose: Levenberg-Marquardt and Sugihara's robust damping.
 *
 * LM, Al-Faiz, eq. 58-63: d = (J^T J + (mu + c) I)^-1 J^T e with e = target - F and J = dF/dq; mu falls
 * after a step that helps and rises after one that does not, which is undone. Eq. 63 as meant is the same
 * step with the constant c > 0; no singular value decomposition is needed for it.
 *
 * Sugihara (2011), doi:10.1109/TRO.2011.2148230: the damping is |e|^2 / 2 + w, every step is taken, the
 * best posture is kept.
 *
 * Every posture on the way lies inside the range of motion.
 */
enum { DAMPED_LM = 0, DAMPED_SUGIHARA = 1 };

/* A squared error of this many m^2 or more, infinite or no number means that the target is no target. */
#define DAMPED_SENSELESS ((real)1e20)

typedef struct {
  real tolerance;         /* reached where |e| is below [m] */
  real rotation_weight;   /* a turn of 1 rad counts like a shift of this length [m] */
  real damping;           /* LM: first mu; Sugihara: w [m^2] */
  real constant_damping;  /* c of eq. 63 [m^2] */
  real increase;          /* LM: mu times this after a step that does not help */
  real decrease;          /* LM: mu times this after a step that helps */
  real smallest, largest; /* LM: range of mu [m^2]; beyond the largest the try ends */
  real progress;          /* a try stalls while |e|^2 falls by less than this share */
  int method;             /* DAMPED_LM or DAMPED_SUGIHARA */
  int printed;            /* 1: rotation residual as printed */
  int rows;               /* 6: pose, 3: position only */
  int max_iterations;     /* steps per try */
  int max_stalled;        /* stalled steps in a row that end a try */
  int restarts;           /* further tries, from random postures */
} damped_settings;

typedef struct {
  real q[DOF];
  real pose[12 + 6 * DOF]; /* position, rotation, Jacobian */
  real e[6];
  real size; /* |e|^2 */
} damped_point;

typedef struct {
  damped_point point[2];
  real best[DOF];
  real best_size;
  real d[DOF];
  step_workspace step;
  int iterations, evaluations;
} damped_workspace;

static inline void armik_damped_evaluate(const damped_settings *s, const real *target, const real *lengths,
                                         damped_point *at, damped_workspace *w) {
  armik_pose_and_jacobian(at->q, lengths, at->pose);
  at->size = armik_pose_residual(target, at->pose, s->rows, s->rotation_weight, s->printed, at->pose + 12,
                                 at->e);
  ++w->evaluations;
}

static inline real armik_clipped(real x, real lower, real upper) {
  return x < lower ? lower : (x > upper ? upper : x);
}

/* One try from w->point[0].q; keeps the best posture seen in w->best. */
static inline void armik_damped_try(const damped_settings *s, const real *target, const real *lengths,
                                    const real *lower, const real *upper, damped_workspace *w) {
  damped_point *here = &w->point[0], *there = &w->point[1];
  const real solved = s->tolerance * s->tolerance;
  armik_damped_evaluate(s, target, lengths, here, w);
  real lowest = here->size; /* of this try */
  real mu = s->damping;
  int stalled = 0;
  if (w->evaluations == 1 || lowest < w->best_size) {
    w->best_size = lowest;
    for (int j = 0; j < DOF; ++j) w->best[j] = here->q[j];
  }
  for (int k = 0; k < s->max_iterations && lowest >= solved && lowest < DAMPED_SENSELESS; ++k) {
    const real damping = (s->method == DAMPED_LM ? mu : here->size / 2 + s->damping) + s->constant_damping;
    if (!armik_damped_step(here->pose + 12, here->e, s->rows, damping, here->q, lower, upper, w->d, &w->step))
      break;
    for (int j = 0; j < DOF; ++j) there->q[j] = armik_clipped(here->q[j] + w->d[j], lower[j], upper[j]);
    armik_damped_evaluate(s, target, lengths, there, w);
    ++w->iterations;
    const int helps = there->size < here->size;
    stalled = there->size < (1 - s->progress) * lowest ? 0 : stalled + 1;
    if (there->size < lowest) lowest = there->size;
    if (there->size < w->best_size) {
      w->best_size = there->size;
      for (int j = 0; j < DOF; ++j) w->best[j] = there->q[j];
    }
    if (helps || s->method == DAMPED_SUGIHARA) {
      damped_point *const swap = here;
      here = there;
      there = swap;
    }
    mu *= helps ? s->decrease : s->increase;
    if (mu < s->smallest) mu = s->smallest;
    if (stalled >= s->max_stalled || (s->method == DAMPED_LM && mu > s->largest)) break;
  }
}

/* One pose: from `start`, then from random postures drawn by `key`. Returns the |e| that is left [m].
 *
 * The posture q (out; it may be `start`) lies inside the range of motion whatever `start` is. If the
 * target or a length is not finite, q is the start, put inside, and the answer is no number or infinite.
 */
static inline real armik_damped_pose(const damped_settings *s, const real *target, const real *lengths,
                                     const real *lower, const real *upper, const real *start, uint64_t key,
                                     real *q, damped_workspace *w) {
  for (int j = 0; j < DOF; ++j) {
    const real x = start[j] == start[j] ? start[j] : (lower[j] + upper[j]) / 2;
    w->best[j] = w->point[0].q[j] = armik_clipped(x, lower[j], upper[j]);
  }
  w->iterations = w->evaluations = 0;
  for (int attempt = 0; attempt <= s->restarts; ++attempt) {
    if (attempt > 0)
      for (int j = 0; j < DOF; ++j) {
        const uint64_t counter = (uint64_t)(attempt - 1) * DOF + (uint64_t)j;
        const real x = lower[j] + (real)random_unit(random_bits(key, counter)) * (upper[j] - lower[j]);
        w->point[0].q[j] = armik_clipped(x, lower[j], upper[j]);
      }
    armik_damped_try(s, target, lengths, lower, upper, w);
    if (!(w->best_size >= s->tolerance * s->tolerance && w->best_size < DAMPED_SENSELESS)) break;
  }
  for (int j = 0; j < DOF; ++j) q[j] = w->best[j];
  return REAL_SQRT(w->best_size);
}
