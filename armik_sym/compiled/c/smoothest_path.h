/* The path through layers of postures that is best with accelerations counted, by dynamic programming over
 * pairs of postures from neighbouring layers.
 *
 *   sum_l cost + 1/2 |speed_l (q_{l+1} - q_l)|^2 + 1/2 |bend_l0 q_l + bend_l1 q_{l+1} + bend_l2 q_{l+2}|^2
 *
 * Written out, the last square has one term for each pair of the three layers, so that
 *
 *   total(b, c) = pair(b, c) + min_a total(a, b) + bend_0 bend_2 q_a . q_c
 *
 * with a, b, c from layers l, l + 1, l + 2. Steps on which a joint j moves more than most_lj are not there. */

#include <stdint.h>

static real smoothest_dot(ptrdiff_t joints, const real *a, const real *b) {
  real sum = 0;
  for (ptrdiff_t j = 0; j < joints; ++j) sum += a[j] * b[j];
  return sum;
}

static int smoothest_step(ptrdiff_t joints, const real *a, const real *b, const real *most, real *square) {
  real sum = 0;
  for (ptrdiff_t j = 0; j < joints; ++j) {
    const real d = b[j] - a[j];
    if (!(fabs(d) <= most[j])) return 0;
    sum += d * d;
  }
  *square = sum;
  return 1;
}

/* way_c = min_a arrived_a + corner_ac, best_c the a where it is least. Rows of `corner` are layers c. */
static void smoothest_least(ptrdiff_t before, ptrdiff_t after, const real *arrived, const real *corner, real *way,
                            real *best) {
  for (ptrdiff_t c = 0; c < after; ++c) {
    way[c] = HUGE_VAL;
    best[c] = 0;
  }
  for (ptrdiff_t a = 0; a < before; ++a) {
    if (!(arrived[a] < HUGE_VAL)) continue;
    const real here = arrived[a], number = (real)a;
    const real *row = corner + a * after;
    for (ptrdiff_t c = 0; c < after; ++c) {
      const real sum = here + row[c];
      best[c] = sum < way[c] ? number : best[c];
      way[c] = sum < way[c] ? sum : way[c];
    }
  }
}

/* Costs of all pairs (b, c) of one step, c after c for each b. */
static void smoothest_pairs(ptrdiff_t joints, ptrdiff_t count, const real *b, ptrdiff_t after, const real *c,
                            const real *cost, const real *most, real speed, real *pair) {
  for (ptrdiff_t i = 0; i < count; ++i)
    for (ptrdiff_t k = 0; k < after; ++k) {
      real square = 0;
      const int there = smoothest_step(joints, b + i * joints, c + k * joints, most, &square);
      pair[i * after + k] = there ? 0.5 * speed * speed * square + cost[k] : HUGE_VAL;
    }
}

/* Postures of layer l are first[l] ... first[l + 1] - 1, at most 255 in a layer, two layers at least. `before` has
 * room for the sum of the products of the sizes of neighbouring layers, `work` for 3 n n + 2 n numbers where n is
 * the size of the largest layer. Returns the cost, HUGE_VAL if there is no path; the path is in `way`. */
EXPORT real armik_smoothest_path(ptrdiff_t layers, const ptrdiff_t *first, ptrdiff_t joints, const real *q,
                                 const real *cost, const real *most, const real *speed, const real *bend,
                                 uint8_t *before, int64_t *way, real *work) {
  ptrdiff_t largest = 0, place = 0;
  for (ptrdiff_t l = 0; l < layers; ++l)
    if (first[l + 1] - first[l] > largest) largest = first[l + 1] - first[l];
  /* total: for each b of the later layer, over all a of the earlier one. */
  real *total = work, *pair = work + largest * largest, *corner = pair + largest * largest;
  real *row = corner + largest * largest, *best = row + largest;
  for (ptrdiff_t l = 0; l + 1 < layers; ++l) {
    const ptrdiff_t nb = first[l + 1] - first[l], nc = first[l + 2] - first[l + 1];
    const real *qb = q + first[l] * joints, *qc = q + first[l + 1] * joints;
    smoothest_pairs(joints, nb, qb, nc, qc, cost + first[l + 1], most + l * joints, speed[l], pair);
    if (l == 0) {
      for (ptrdiff_t c = 0; c < nc; ++c)
        for (ptrdiff_t b = 0; b < nb; ++b) total[c * nb + b] = pair[b * nc + c] + cost[first[0] + b];
      continue;
    }
    const ptrdiff_t na = first[l] - first[l - 1];
    const real *qa = q + first[l - 1] * joints, *w = bend + 3 * (l - 1);
    for (ptrdiff_t a = 0; a < na; ++a) {
      const real own = 0.5 * w[0] * w[0] * smoothest_dot(joints, qa + a * joints, qa + a * joints);
      for (ptrdiff_t c = 0; c < nc; ++c)
        corner[a * nc + c] = own + w[0] * w[2] * smoothest_dot(joints, qa + a * joints, qc + c * joints);
    }
    for (ptrdiff_t c = 0; c < nc; ++c) {
      const real own = 0.5 * w[2] * w[2] * smoothest_dot(joints, qc + c * joints, qc + c * joints);
      for (ptrdiff_t b = 0; b < nb; ++b) pair[b * nc + c] += own;
    }
    for (ptrdiff_t b = 0; b < nb; ++b) {
      const real *at = qb + b * joints;
      const real own = 0.5 * w[1] * w[1] * smoothest_dot(joints, at, at);
      for (ptrdiff_t a = 0; a < na; ++a)
        total[b * na + a] += own + w[0] * w[1] * smoothest_dot(joints, qa + a * joints, at);
      smoothest_least(na, nc, total + b * na, corner, row, best);
      for (ptrdiff_t c = 0; c < nc; ++c) {
        pair[b * nc + c] += row[c] + w[1] * w[2] * smoothest_dot(joints, at, qc + c * joints);
        before[place + b * nc + c] = (uint8_t)best[c];
      }
    }
    place += nb * nc;
    for (ptrdiff_t c = 0; c < nc; ++c)
      for (ptrdiff_t b = 0; b < nb; ++b) total[c * nb + b] = pair[b * nc + c];
  }
  const ptrdiff_t nb = first[layers - 1] - first[layers - 2], nc = first[layers] - first[layers - 1];
  ptrdiff_t b = 0, c = 0;
  real least = HUGE_VAL;
  for (ptrdiff_t k = 0; k < nc; ++k)
    for (ptrdiff_t i = 0; i < nb; ++i)
      if (total[k * nb + i] < least) {
        least = total[k * nb + i];
        b = i;
        c = k;
      }
  way[layers - 1] = first[layers - 1] + c;
  way[layers - 2] = first[layers - 2] + b;
  for (ptrdiff_t l = layers - 3; l >= 0; --l) {
    const ptrdiff_t size = first[l + 3] - first[l + 2];
    place -= (first[l + 2] - first[l + 1]) * size;
    const ptrdiff_t a = before[place + b * size + c];
    c = b;
    b = a;
    way[l] = first[l] + a;
  }
  return least;
}
