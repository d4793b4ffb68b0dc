/* Small positive definite systems A x = b, at most 6 x 6, by A = L D L^T: Cholesky without square roots.
 *
 * A damped step of an arm never needs more: with more than six free joints the dual form has one row per
 * tracked quantity.
 */
#define SMALL 6

/* Solve A x = b in place. A is n x n, rows SMALL apart; only its lower half is read, and becomes L, the upper
 * half becomes D L^T, and b becomes x.
 *
 * Returns 0 and leaves b unusable if A is not positive definite or holds a NaN, otherwise 1.
 */
static inline int armik_small_solve(int n, real A[SMALL][SMALL], real b[SMALL]) {
  real inverse[SMALL]; /* of D */
  for (int i = 0; i < n; ++i) {
    real pivot = A[i][i];
    for (int j = 0; j < i; ++j) {
      real sum = A[i][j];
      for (int k = 0; k < j; ++k) sum -= A[k][i] * A[j][k];
      A[j][i] = sum;
      A[i][j] = sum * inverse[j];
      pivot -= sum * A[i][j];
      b[i] -= A[i][j] * b[j]; /* L y = b on the way */
    }
    if (!(pivot > 0)) return 0;
    inverse[i] = (real)1 / pivot;
  }
  for (int i = n - 1; i >= 0; --i) { /* D L^T x = y */
    b[i] *= inverse[i];
    for (int k = i + 1; k < n; ++k) b[i] -= A[k][i] * b[k];
  }
  return 1;
}
