// Math functions with bit-identical results on all machines and with all compilers.
//
// sin(), exp() or pow() of the C library differ in the last bit between versions, processors and platforms. These
// functions use tables of constants and operations that IEEE 754 defines exactly (+ - * / and the square root of
// doubles), so that a result depends on the argument only. They require rounding to nearest and subnormal numbers (the
// defaults of a process), -ffp-contract=off, because a fused multiply-add rounds differently, and no -ffast-math;
// is_arithmetic_exact() checks this. They do not set errno; the floating-point exception flags are unspecified.
//
// Special cases follow C99 Annex F. All returned NaNs have the same bits: positive, quiet, no payload. Errors are below
// 0.55 ulp (0.75 ulp for subnormal results of hypot); tests/base/fixed_math_reference.h lists the bounds.
#pragma once

#include <cstddef>

namespace limber::fixed {

/// Checks the requirements on rounding, subnormal numbers and contraction for the calling thread.
bool is_arithmetic_exact();
/// Sets the calling thread to rounding to nearest and subnormal numbers, which a library may have changed.
void reset_arithmetic();
/// True if LuaJIT and the other libraries call these functions as sin(), powf() and so on (libm.cpp).
bool is_libm_replaced();
/// Makes LuaJIT and Bullet call these functions, for a shared library: unlike a program, it can't replace the C
/// library's functions for the process. Changes the addresses that the dynamic linker has written into these two
/// libraries, once. Returns the number of addresses, 0 if it failed. [any]
std::size_t bind_libm();

// Trigonometric functions, in radians. The argument reduction is exact for all doubles.
double sin(double x);
double cos(double x);
double tan(double x);

struct SinCos {
  double sin, cos;
};
/// Returns the same bits as sin() and cos(), faster than two calls.
SinCos sincos(double x);

double asin(double x);
double acos(double x);
double atan(double x);
/// The angle of the vector (x, y), in [-pi, pi].
double atan2(double y, double x);

double exp(double x);
double exp2(double x);
double log(double x);
double log2(double x);
double log10(double x);
double pow(double x, double y);

double sinh(double x);
double cosh(double x);
double tanh(double x);

double cbrt(double x);
double hypot(double x, double y);

// Single precision: the result of the double function, rounded to float. All but a few results are correctly rounded.
float sinf(float x);
float cosf(float x);
float tanf(float x);
float asinf(float x);
float acosf(float x);
float atanf(float x);
float atan2f(float y, float x);
float expf(float x);
float exp2f(float x);
float logf(float x);
float log2f(float x);
float log10f(float x);
float powf(float x, float y);
float sinhf(float x);
float coshf(float x);
float tanhf(float x);
float cbrtf(float x);
float hypotf(float x, float y);

}  // namespace limber::fixed
