/* The objective over one curve, half a sum of squares over all samples and joints:
 *
 *   speed_k (q_{k+1} - q_k),   bend_k0 q_k + bend_k1 q_{k+1} + bend_k2 q_{k+2},   hold_k (q_k - aim_k),
 *
 * with q_k = q(x_k), its gradient and the three upper bands of its Hessian. chart_k says what the coordinate
 * x_k is. Needs armik_angles_*, armik_second_* and CURVE_PARAMETERS. */

#define CURVE_JOINTS 7

static void curve_angles(int chart, const real *x, const real *parameters, real *q) {
  if (chart == 0) armik_angles_0(x, parameters, q);
  else if (chart == 1) armik_angles_1(x, parameters, q);
  else armik_angles_2(x, parameters, q);
}

static void curve_second(int chart, const real *x, const real *parameters, real *out) {
  if (chart == 0) armik_second_0(x, parameters, out);
  else if (chart == 1) armik_second_1(x, parameters, out);
  else armik_second_2(x, parameters, out);
}

static real curve_square(real *off, const real *weight, const real *const *q, ptrdiff_t terms) {
  real sum = 0;
  for (int j = 0; j < CURVE_JOINTS; ++j) {
    off[j] = 0;
    for (ptrdiff_t i = 0; i < terms; ++i) off[j] += weight[i] * q[i][j];
    sum += off[j] * off[j];
  }
  return sum;
}

/* One square at samples first ... first + terms - 1; its share of the force if somebody asks. */
static real curve_term(const real *q, ptrdiff_t first, const real *weight, ptrdiff_t terms, real *force) {
  real off[CURVE_JOINTS];
  const real *rows[3];
  for (ptrdiff_t i = 0; i < terms; ++i) rows[i] = q + (first + i) * CURVE_JOINTS;
  const real sum = curve_square(off, weight, rows, terms);
  if (force)
    for (ptrdiff_t i = 0; i < terms; ++i)
      for (int j = 0; j < CURVE_JOINTS; ++j) force[(first + i) * CURVE_JOINTS + j] += weight[i] * off[j];
  return sum;
}

/* The objective of postures; force = d(objective)/dq unless it is NULL. */
static real curve_squares(ptrdiff_t n, const real *q, const real *speed, const real *bend, const real *hold,
                          const real *aim, real *force) {
  real sum = 0;
  if (force)
    for (ptrdiff_t i = 0; i < n * CURVE_JOINTS; ++i) force[i] = 0;
  for (ptrdiff_t k = 0; k < n; ++k)
    for (int j = 0; j < CURVE_JOINTS; ++j) {
      const real off = hold[k] * (q[k * CURVE_JOINTS + j] - aim[k * CURVE_JOINTS + j]);
      sum += off * off;
      if (force) force[k * CURVE_JOINTS + j] += hold[k] * off;
    }
  for (ptrdiff_t k = 0; k + 1 < n; ++k) {
    const real weight[2] = {-speed[k], speed[k]};
    sum += curve_term(q, k, weight, 2, force);
  }
  for (ptrdiff_t k = 0; k + 2 < n; ++k) sum += curve_term(q, k, bend + 3 * k, 3, force);
  return 0.5 * sum;
}

EXPORT real armik_curve_value(ptrdiff_t n, const int *chart, const real *x, const real *parameters, const real *speed,
                              const real *bend, const real *hold, const real *aim, real *q) {
  for (ptrdiff_t k = 0; k < n; ++k)
    curve_angles(chart[k], x + k, parameters + k * CURVE_PARAMETERS, q + k * CURVE_JOINTS);
  return curve_squares(n, q, speed, bend, hold, aim, NULL);
}

static real curve_dot(const real *a, const real *b) {
  real sum = 0;
  for (int j = 0; j < CURVE_JOINTS; ++j) sum += a[j] * b[j];
  return sum;
}

/* Also the slopes and curvatures of the angles; band i of the Hessian begins at bands + i n. */
EXPORT real armik_curve_derivatives(ptrdiff_t n, const int *chart, const real *x, const real *parameters, const real *speed,
                                    const real *bend, const real *hold, const real *aim, real *q, real *slope,
                                    real *curvature, real *force, real *gradient, real *bands) {
  for (ptrdiff_t k = 0; k < n; ++k) {
    real out[3 * CURVE_JOINTS];
    curve_second(chart[k], x + k, parameters + k * CURVE_PARAMETERS, out);
    for (int j = 0; j < CURVE_JOINTS; ++j) {
      q[k * CURVE_JOINTS + j] = out[j];
      slope[k * CURVE_JOINTS + j] = out[CURVE_JOINTS + j];
      curvature[k * CURVE_JOINTS + j] = out[2 * CURVE_JOINTS + j];
    }
  }
  const real value = curve_squares(n, q, speed, bend, hold, aim, force);
  for (ptrdiff_t k = 0; k < n; ++k) {
    const real *s = slope + k * CURVE_JOINTS;
    const real v0 = k > 0 ? speed[k - 1] : 0, v1 = k + 1 < n ? speed[k] : 0;
    const real b0 = k > 1 ? bend[3 * (k - 2) + 2] : 0, b2 = k + 2 < n ? bend[3 * k] : 0;
    const real b1 = k > 0 && k + 1 < n ? bend[3 * (k - 1) + 1] : 0;
    const real own = v0 * v0 + v1 * v1 + b0 * b0 + b1 * b1 + b2 * b2 + hold[k] * hold[k];
    gradient[k] = curve_dot(s, force + k * CURVE_JOINTS);
    bands[k] = own * curve_dot(s, s) + curve_dot(curvature + k * CURVE_JOINTS, force + k * CURVE_JOINTS);
    if (k + 1 < n) {
      real next = -speed[k] * speed[k];
      if (k > 0) next += bend[3 * (k - 1) + 1] * bend[3 * (k - 1) + 2];
      if (k + 2 < n) next += bend[3 * k] * bend[3 * k + 1];
      bands[n + k] = next * curve_dot(s, s + CURVE_JOINTS);
    }
    if (k + 2 < n) bands[2 * n + k] = bend[3 * k] * bend[3 * k + 2] * curve_dot(s, s + 2 * CURVE_JOINTS);
  }
  return value;
}
