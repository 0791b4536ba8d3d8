// Math functions whose results have the same bits on every machine and with every compiler.
//
// The C library's sin(), exp() or pow() differ in the last bit between versions, processors and platforms. These use
// only operations that IEEE 754 defines exactly (+ - * / and the square root, on doubles) and tables of constants, so
// that a result depends on nothing but the argument. They assume what every program starts with: rounding to nearest,
// subnormal numbers, no contraction of a * b + c into a fused operation (-ffp-contract=off), none of -ffast-math; see
// is_arithmetic_exact(). They do not set errno, and raise floating-point exceptions in no defined way.
//
// Special cases follow C99 Annex F. Every NaN that is returned is the same: positive, quiet, without a payload.
// Errors are below 0.6 ulp; tests/base/fixed_math_test.cpp has the bound of each function.
#pragma once

namespace limber::fixed {

/// True if the processor and the flags of the compiler are as these functions need them.
bool is_arithmetic_exact();

// Trigonometric functions, in radians. Arguments are reduced with as many digits of pi as they need.
double sin(double x);
double cos(double x);
double tan(double x);

struct SinCos {
  double sin, cos;
};
/// The bits of sin() and cos(), in less time than two calls.
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

// Single precision: the double function's result, rounded once more, which is the correctly rounded value but for one
// argument in some hundred million.
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
