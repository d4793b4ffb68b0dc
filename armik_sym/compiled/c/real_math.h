/* Functions of libm for the number type `real`: double, or float where REAL_IS_FLOAT is defined as 1. */
#ifndef REAL_IS_FLOAT
#define REAL_IS_FLOAT 0
#endif
#if REAL_IS_FLOAT
#define REAL_SQRT sqrtf
#define REAL_FABS fabsf
#define REAL_ATAN atanf
#define REAL_ATAN2 atan2f
#else
#define REAL_SQRT sqrt
#define REAL_FABS fabs
#define REAL_ATAN atan
#define REAL_ATAN2 atan2
#endif
#define REAL_INFINITY ((real)INFINITY)
