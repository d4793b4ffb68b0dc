/* Damped least squares for many poses: what Python calls. */

/* Bring the hand to n targets.
 *
 *   first, seed  index of the first target in the whole path, and the seed: together they decide the random
 *                restarts, so that results do not depend on how a path is cut into calls
 *   targets      n x 12: position [m], rotation row by row
 *   starts       chain = 1: one posture, each pose starts from the posture before; chain = 0: n postures
 *   q            n x DOF (out), inside the range of motion
 *   error        n (out): |e| that is left [m]
 *   iterations   n (out): steps tried; evaluations  n (out): poses computed
 */
EXPORT void armik_damped_path(const damped_settings *settings, ptrdiff_t n, uint64_t first, uint64_t seed,
                              const real *targets, const real *lengths, const real *lower,
                              const real *upper, const real *starts, int chain, real *q, real *error,
                              int64_t *iterations, int64_t *evaluations) {
  damped_workspace w;
  for (ptrdiff_t i = 0; i < n; ++i) {
    const real *start = chain ? (i ? q + (i - 1) * DOF : starts) : starts + i * DOF;
    const uint64_t key = random_branch(seed, first + (uint64_t)i);
    error[i] =
        armik_damped_pose(settings, targets + 12 * i, lengths, lower, upper, start, key, q + i * DOF, &w);
    iterations[i] = w.iterations;
    evaluations[i] = w.evaluations;
  }
}
