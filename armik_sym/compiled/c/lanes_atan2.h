/* Arc tangents and what else a search among angles needs, on vectors.
 *
 * Arc tangent of several quotients at once, in the right quadrant, one per lane of a vector.
 *
 * The rational approximation is that of Cephes (S. L. Moshier, 1984-2000, atan.c), for |t| <= 0.66; larger
 * t go through (t - 1) / (t + 1). Error below 2e-16 of a turn. No branches. atan2(0, 0) is 0; infinite
 * arguments are not provided for.
 */
#if LANES > 1
static inline lanes lanes_select(lane_bits mask, lanes yes, lanes no) {
  return (lanes)(((lane_bits)yes & mask) | ((lane_bits)no & ~mask));
}

static inline lanes lanes_smaller(lanes a, lanes b) { return lanes_select((lane_bits)(a < b), a, b); }

static inline lanes lanes_sqrt(lanes x) {
  for (int i = 0; i < LANES; ++i) x[i] = sqrt(x[i]);
  return x;
}

/* |x - 2 pi k| for the nearest k, x below 1e5. */
static inline lanes lanes_turned_away(lanes x) {
  const lane_bits sign = (lane_bits){0} + 0x8000000000000000ULL;
  const lanes turns = (x * 1.59154943091895335769e-1 + LANES_ROUNDER) - LANES_ROUNDER;
  return (lanes)((lane_bits)(x - turns * 6.28318530717958647693) & ~sign);
}

static inline lanes lanes_atan_near_zero(lanes t) {
  const lanes z = t * t;
  lanes p = z * -8.750608600031904122785e-1 - 1.615753718733365076637e1;
  p = p * z - 7.500855792314704667340e1;
  p = p * z - 1.228866684490136173410e2;
  p = p * z - 6.485021904942025371773e1;
  lanes q = z + 2.485846490142306297962e1;
  q = q * z + 1.650270098316988542046e2;
  q = q * z + 4.328810604912902668951e2;
  q = q * z + 4.853903996359136964868e2;
  q = q * z + 1.945506571482613964425e2;
  return t + t * z * (p / q);
}

static inline lanes lanes_atan2(lanes y, lanes x) {
  const lane_bits sign = (lane_bits){0} + 0x8000000000000000ULL;
  const lanes a = (lanes)((lane_bits)x & ~sign), b = (lanes)((lane_bits)y & ~sign);
  const lane_bits steep = (lane_bits)(b > a), left = (lane_bits)(x < 0.0);
  const lanes more = lanes_select(steep, b, a), less = lanes_select(steep, a, b);
  const lane_bits middle = (lane_bits)(less > 0.66 * more), none = (lane_bits)(more == 0.0);
  const lanes numerator = lanes_select(middle, less - more, less);
  const lanes divisor = lanes_select(middle, less + more, lanes_select(none, lanes_of(1.0), more));
  lanes angle = lanes_atan_near_zero(numerator / divisor);
  angle += lanes_select(middle, lanes_of(7.85398163397448309616e-1), lanes_of(0.0));
  angle = lanes_select(steep, 1.57079632679489661923 - (angle - 6.123233995736765886130e-17), angle);
  angle = lanes_select(left, 3.14159265358979323846 - (angle - 1.224646799147353177226e-16), angle);
  return (lanes)((lane_bits)angle | ((lane_bits)y & sign));
}
#endif
