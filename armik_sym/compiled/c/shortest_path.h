/* The shortest path through layers of postures, by dynamic programming.
 *
 *   total_b = cost_b + min_a total_a + 1/2 weight_l |q_b - q_a|^2 + change_l(side_a, side_b)
 *
 * over the nodes a of the layer before; edges on which a joint j moves more than
 * most_lj are not there. Joints with turns[j] take the shorter way round. Sides are 0 and 1.
 *
 * q is stored layer by layer, within a layer joint by joint, so that the inner loop runs over neighbours in
 * memory. */

#include <stdint.h>

#define PATH_NONE (-1)
#define PATH_TURN 6.283185307179586476925286766559

static void path_edges(ptrdiff_t count, const real *before, const real *total, const int *side_before,
                       const real *posture, int side, ptrdiff_t joints, const int *turns, real weight,
                       const real *most, const real *change, real *way) {
  for (ptrdiff_t a = 0; a < count; ++a) way[a] = 0;
  for (ptrdiff_t j = 0; j < joints; ++j) {
    const real *column = before + j * count;
    const real own = posture[j], allowed = most[j];
    if (turns[j])
      for (ptrdiff_t a = 0; a < count; ++a) {
        real d = own - column[a];
        d -= PATH_TURN * rint(d / PATH_TURN);
        way[a] += fabs(d) <= allowed ? d * d : HUGE_VAL;
      }
    else
      for (ptrdiff_t a = 0; a < count; ++a) {
        const real d = own - column[a];
        way[a] += fabs(d) <= allowed ? d * d : HUGE_VAL;
      }
  }
  for (ptrdiff_t a = 0; a < count; ++a)
    way[a] = total[a] + 0.5 * weight * way[a] + change[2 * side_before[a] + side];
}

/* layers + 1 numbers in `first`: nodes of layer l are first[l] ... first[l + 1] - 1. `work` has room for the
 * largest layer, `posture` for one posture. Nodes that cannot be reached have total HUGE_VAL, previous -1. */
EXPORT void armik_shortest_path(ptrdiff_t layers, const ptrdiff_t *first, ptrdiff_t joints, const real *q,
                                const real *cost, const int *side, const int *turns, const real *weight,
                                const real *most, const real *change, real *total, int64_t *previous, real *work) {
  real posture[16];
  for (ptrdiff_t b = first[0]; b < first[1]; ++b) {
    total[b] = cost[b];
    previous[b] = PATH_NONE;
  }
  for (ptrdiff_t l = 1; l < layers; ++l) {
    const ptrdiff_t begin = first[l - 1], count = first[l] - begin, size = first[l + 1] - first[l];
    for (ptrdiff_t b = first[l]; b < first[l + 1]; ++b) {
      for (ptrdiff_t j = 0; j < joints; ++j) posture[j] = q[first[l] * joints + j * size + (b - first[l])];
      path_edges(count, q + begin * joints, total + begin, side + begin, posture, side[b], joints, turns,
                 weight[l - 1], most + (l - 1) * joints, change + 4 * (l - 1), work);
      ptrdiff_t best = PATH_NONE;
      real least = HUGE_VAL;
      for (ptrdiff_t a = 0; a < count; ++a)
        if (work[a] < least) {
          least = work[a];
          best = a;
        }
      total[b] = least + cost[b];
      previous[b] = best == PATH_NONE ? PATH_NONE : begin + best;
    }
  }
}
