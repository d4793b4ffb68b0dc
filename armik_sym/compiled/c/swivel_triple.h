/* The three angles of shoulder or wrist, also where the outer two axes are parallel and share one angle. */

/* Angle of the first joint where only alpha + gamma, or alpha - gamma, is determined; `first` is the index
 * of the joint, `wish` its wished angle or NULL. */
static inline real swivel_first_at_pole(const swivel_arm *arm, int first, const real *Q, const real *wish) {
  const real middle0 = 0.5 * (arm->lower[first] + arm->upper[first]);
  if (!(Q[2] * Q[2] + Q[5] * Q[5] < SWIVEL_NEAR)) return wish ? *wish : middle0;
  const real middle2 = 0.5 * (arm->lower[first + 2] + arm->upper[first + 2]);
  const real half0 = 0.5 * (arm->upper[first] - arm->lower[first]);
  const real half2 = 0.5 * (arm->upper[first + 2] - arm->lower[first + 2]);
  const real sign = Q[8] < 0 ? -1.0 : 1.0;
  const real shared = atan2(sign * Q[3] - Q[1], sign * Q[0] + Q[4]);
  const real away = swivel_turned_back(shared - (middle0 + sign * middle2));
  const real split = swivel_clipped(0.5 * (half0 - half2 + fabs(away)), 0.0, fabs(away));
  real best = away < 0 ? -split : split;
  if (wish) {
    const real least = swivel_larger(-half0, away - half2), most = swivel_smaller(half0, away + half2);
    if (least <= most) best = swivel_clipped(swivel_turned_back(*wish - middle0), least, most);
  }
  return middle0 + best;
}

/* Angles of a triple on branch `side`, 1 or -1. Returns the sine of the second before its offset. */
static inline real swivel_triple_angles(const swivel_arm *arm, int triple, const real *Q, real side,
                                        const real *wish, real *angles) {
  real pole[2] = {1, 0}, pairs[6];
  if (Q[2] * Q[2] + Q[5] * Q[5] < SWIVEL_NEAR) {
    const real free_angle = swivel_first_at_pole(arm, 4 * triple, Q, wish);
    pole[0] = cos(free_angle);
    pole[1] = sin(free_angle);
  }
  armik_swivel_sides(Q, &side, pole, pairs);
  for (int i = 0; i < 3; ++i) angles[i] = atan2(pairs[2 * i], pairs[2 * i + 1]);
  angles[1] -= arm->offset[triple];
  return pairs[2];
}
