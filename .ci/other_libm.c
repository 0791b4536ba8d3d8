/* A math library with results that are off by one unit in the last place, which shows whether a program's results depend
   on the system's library. Preloaded by `./check --long hashes`. The functions that IEEE 754 defines exactly (sqrt, fma,
   rounding, fmod) are not replaced. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <float.h>
#include <stdint.h>
#include <string.h>

/* Returns the next number away from zero; zeros, infinities and NaN are unchanged. */
static double off(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  if (x != 0 && x - x == 0) bits++;
  memcpy(&x, &bits, sizeof bits);
  return x;
}

static float offf(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  if (x != 0 && x - x == 0) bits++;
  memcpy(&x, &bits, sizeof bits);
  return x;
}

#define ONE(name)                                            \
  double name(double x) {                                    \
    static double (*next)(double);                           \
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, #name);    \
    return off(next(x));                                     \
  }                                                          \
  float name##f(float x) {                                   \
    static float (*next)(float);                             \
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, #name "f"); \
    return offf(next(x));                                    \
  }
#define TWO(name)                                            \
  double name(double x, double y) {                          \
    static double (*next)(double, double);                   \
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, #name);    \
    return off(next(x, y));                                  \
  }                                                          \
  float name##f(float x, float y) {                          \
    static float (*next)(float, float);                      \
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, #name "f"); \
    return offf(next(x, y));                                 \
  }

ONE(sin) ONE(cos) ONE(tan) ONE(asin) ONE(acos) ONE(atan) ONE(sinh) ONE(cosh) ONE(tanh) ONE(asinh) ONE(acosh) ONE(atanh)
ONE(exp) ONE(exp2) ONE(exp10) ONE(expm1) ONE(log) ONE(log2) ONE(log10) ONE(log1p) ONE(cbrt)
TWO(pow) TWO(atan2) TWO(hypot)

void sincos(double x, double *s, double *c) {
  *s = sin(x);
  *c = cos(x);
}
void sincosf(float x, float *s, float *c) {
  *s = sinf(x);
  *c = cosf(x);
}
