/* Random numbers without a state: number `counter` of the stream `key`, in any order.
 *
 * SplitMix64 (Steele, Lea & Flood, OOPSLA 2014): the output function of the generator at state
 * key + (counter + 1) * golden, with the mixer of its reference implementation (S. Vigna). Every draw has a
 * fixed place, so results depend neither on threads nor on the order of evaluation.
 */
#include <stdint.h>

/* Golden ratio times 2^64, odd. */
#define RANDOM_STEP UINT64_C(0x9E3779B97F4A7C15)

static inline uint64_t random_bits(uint64_t key, uint64_t counter) {
  uint64_t z = key + (counter + 1) * RANDOM_STEP;
  z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
  return z ^ (z >> 31);
}

/* The key of branch `number` of a stream: seed -> sample -> purpose. */
static inline uint64_t random_branch(uint64_t key, uint64_t number) { return random_bits(key, number); }

/* As many bits as the number type holds, as a number in [0, 1). */
#if defined(REAL_IS_FLOAT) && REAL_IS_FLOAT
static inline real random_unit(uint64_t bits) { return (real)(bits >> 40) * 0x1p-24f; }
#else
static inline real random_unit(uint64_t bits) { return (real)(bits >> 11) * 0x1p-53; }
#endif

/* A whole number in [0, n), n > 0, from 32 bits: the high part of a product (Lemire 2019), without rejection;
 * probabilities differ by less than n / 2^32 of themselves. */
static inline int random_below(uint32_t bits, int n) { return (int)(((uint64_t)bits * (uint64_t)n) >> 32); }
