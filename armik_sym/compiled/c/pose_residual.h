/* How far a hand is from its target: Al-Faiz, eq. 50-53, corrected or as printed.
 *
 * A pose is 12 numbers: the position [m], then the rotation row by row.
 */

/* E = target * R^T, the rotation from the hand to the target (Al-Faiz, eq. 52); all row by row. */
static inline void armik_rotation_between(const real *R, const real *target, real *E) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      E[3 * i + j] =
          target[3 * i] * R[3 * j] + target[3 * i + 1] * R[3 * j + 1] + target[3 * i + 2] * R[3 * j + 2];
}

/* Axis times angle of a rotation, |w| <= pi: eq. 51 and 53 corrected.
 *
 * Through the unit quaternion, scaled by four times its largest component (Shepperd, 1978), so that it is
 * exact at 0, at half a turn, and everywhere between.
 */
static inline void armik_rotation_vector(const real *E, real *w) {
  const real trace = E[0] + E[4] + E[8];
  real scalar;
  if (trace > 0) {
    scalar = 1 + trace;
    w[0] = E[7] - E[5];
    w[1] = E[2] - E[6];
    w[2] = E[3] - E[1];
  } else {
    const int i = E[0] >= E[4] ? (E[0] >= E[8] ? 0 : 2) : (E[4] >= E[8] ? 1 : 2);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    scalar = E[3 * k + j] - E[3 * j + k];
    w[i] = 1 + E[4 * i] - E[4 * j] - E[4 * k];
    w[j] = E[3 * i + j] + E[3 * j + i];
    w[k] = E[3 * i + k] + E[3 * k + i];
  }
  const real length = REAL_SQRT(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  real factor; /* angle / length, with the sign that makes the scalar part positive */
  if (length > (real)1e-15)
    factor = 2 * REAL_ATAN2(length, REAL_FABS(scalar)) / (scalar < 0 ? -length : length);
  else
    factor = 2 / scalar;
  for (int i = 0; i < 3; ++i) w[i] *= factor;
}

/* Eq. 51 and 53 as printed: wrong signs and order of l, plain arc tangent, 0/0 read as 0.
 *
 * Only for repeating the paper's numbers.
 */
static inline void armik_printed_rotation_residual(const real *E, real *c) {
  const real cosine = E[0] + E[4] + E[8] - 1;
  c[0] = E[1] - E[3];
  c[1] = E[2] - E[6];
  c[2] = E[5] - E[7];
  const real length = REAL_SQRT(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
  const real half_pi = (real)1.57079632679489661923;
  const real angle = REAL_FABS(cosine) > 0 ? REAL_ATAN(length / cosine) : half_pi;
  const real factor = length > 0 ? angle / length : 0;
  for (int i = 0; i < 3; ++i) c[i] *= factor;
}

/* Residual e [m] of a pose, and the rows of the Jacobian J that change it (scaled in place).
 *
 * e = [p* - p; weight * axis-angle from R to R*], 6 rows, or 3 where only the position counts. `weight` is
 * the length [m] at which a turn of 1 rad counts like a shift. Returns |e|^2 [m^2]; infinite where the target
 * is no rotation.
 */
static inline real armik_pose_residual(const real *target, const real *pose, int rows, real weight,
                                       int printed, real *J, real *e) {
  for (int i = 0; i < 3; ++i) e[i] = target[i] - pose[i];
  real size = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
  if (rows == 3) return size;
  real E[9];
  armik_rotation_between(pose + 3, target + 3, E);
  real squares = 0; /* of a rotation: 3 */
  for (int i = 0; i < 9; ++i) squares += E[i] * E[i];
  if (!(squares > 2 && squares < 4)) return (real)HUGE_VAL;
  if (printed)
    armik_printed_rotation_residual(E, e + 3);
  else
    armik_rotation_vector(E, e + 3);
  for (int i = 3; i < 6; ++i) {
    e[i] *= weight;
    size += e[i] * e[i];
  }
  for (int i = 3 * DOF; i < 6 * DOF; ++i) J[i] *= weight;
  return size;
}
