/* Sine and cosine of several postures at once, one posture per lane of a vector.
 *
 * GCC and Clang turn arithmetic on vector types into SIMD instructions; other compilers get one lane,
 * which means the plain loop. Polynomials and the parts of pi/2 are those of fdlibm (Sun Microsystems,
 * 1993): error below 1 ulp of 1. No branches, so the processor has nothing to mispredict.
 */
#if (defined(__GNUC__) || defined(__clang__)) && (!defined(_WIN32) || defined(__clang__))
#if defined(__AVX512F__)
#define LANES 8
#elif defined(__AVX__)
#define LANES 4
#else
#define LANES 2
#endif
#else
#define LANES 1
#endif

#if LANES > 1
typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef unsigned long long lane_bits __attribute__((vector_size(8 * LANES)));

#define lanes_of(x) ((lanes){0} + (x))

/* Up to here n * (first part of pi/2) is exact; larger angles, infinities and NaN are left to libm. */
#define LANES_LARGEST_ANGLE 1e5

/* Adding 1.5 * 2^52 rounds to an integer and leaves it in the lowest bits. */
#define LANES_ROUNDER 6755399441055744.0

static inline lanes lanes_quarters(lanes x) { return x * 6.36619772367581382433e-01 + LANES_ROUNDER; }

static inline lanes lanes_reduce(lanes x, lanes quarters) {
  const lanes n = quarters - LANES_ROUNDER;
  lanes r = x - n * 1.57079632673412561417e+00;
  r = r - n * 6.07710050630396597660e-11;
  return r - n * 2.02226624879595063154e-21;
}

static inline lanes lanes_sin_near_zero(lanes r) {
  const lanes z = r * r;
  lanes s = z * 1.58969099521155010221e-10 - 2.50507602534068634195e-08;
  s = z * s + 2.75573137070700676789e-06;
  s = z * s - 1.98412698298579493134e-04;
  s = z * s + 8.33333333332248946124e-03;
  s = z * s - 1.66666666666666324348e-01;
  return r + r * z * s;
}

static inline lanes lanes_cos_near_zero(lanes r) {
  const lanes z = r * r, half = 0.5 * z, head = 1.0 - half;
  lanes c = z * -1.13596475577881948265e-11 + 2.08757232129817482790e-09;
  c = z * c - 2.75573143513906633035e-07;
  c = z * c + 2.48015872894767294178e-05;
  c = z * c - 1.38888888888741095749e-03;
  c = z * c + 4.16666666666666019037e-02;
  return head + (((1.0 - head) - half) + z * z * c);
}

/* Quarter turns k: odd ones swap sine and cosine, the second bit is the sign. */
static inline lanes lanes_turned(lanes s, lanes c, lane_bits k) {
  const lane_bits odd = -(k & 1), sign = (k & 2) << 62;
  return (lanes)((((lane_bits)c & odd) | ((lane_bits)s & ~odd)) ^ sign);
}

static inline lanes lanes_sin(lanes x) {
  const lanes quarters = lanes_quarters(x), r = lanes_reduce(x, quarters);
  return lanes_turned(lanes_sin_near_zero(r), lanes_cos_near_zero(r), (lane_bits)quarters);
}

static inline lanes lanes_cos(lanes x) {
  const lanes quarters = lanes_quarters(x), r = lanes_reduce(x, quarters);
  return lanes_turned(lanes_sin_near_zero(r), lanes_cos_near_zero(r), (lane_bits)quarters + 1);
}
#endif
