// Replaces the C library's mathematical functions in the whole process by those of fixed_math.h.
//
// The dynamic linker prefers a symbol of the program to that of a shared library. LuaJIT, Bullet and the other
// libraries therefore call these definitions too, and the results of math.sin in a script or of an angle that Bullet
// computes depend on neither the version of the C library nor on the processor. is_libm_replaced() checks this.
#include <array>
#include <cmath>
#include <string_view>

#include "base/math/fixed_math.h"
#include "base/system/process.h"
#include "base/system/symbol_binding.h"

#define LIMBER_LIBM_UNARY(name)                                                \
  extern "C" double name(double x) noexcept { return limber::fixed::name(x); } \
  extern "C" float name##f(float x) noexcept { return limber::fixed::name##f(x); }
#define LIMBER_LIBM_BINARY(name)                                                            \
  extern "C" double name(double x, double y) noexcept { return limber::fixed::name(x, y); } \
  extern "C" float name##f(float x, float y) noexcept { return limber::fixed::name##f(x, y); }

LIMBER_LIBM_UNARY(sin)
LIMBER_LIBM_UNARY(cos)
LIMBER_LIBM_UNARY(tan)
LIMBER_LIBM_UNARY(asin)
LIMBER_LIBM_UNARY(acos)
LIMBER_LIBM_UNARY(atan)
LIMBER_LIBM_UNARY(exp)
LIMBER_LIBM_UNARY(exp2)
LIMBER_LIBM_UNARY(log)
LIMBER_LIBM_UNARY(log2)
LIMBER_LIBM_UNARY(log10)
LIMBER_LIBM_UNARY(sinh)
LIMBER_LIBM_UNARY(cosh)
LIMBER_LIBM_UNARY(tanh)
LIMBER_LIBM_UNARY(cbrt)
LIMBER_LIBM_BINARY(atan2)
LIMBER_LIBM_BINARY(hypot)

// LuaJIT's compiled code computes x * x for x ^ 2, while its interpreter calls pow(). Both must give the same bits,
// because the addresses of code influence when a loop is compiled.
extern "C" double pow(double x, double y) noexcept { return y == 2 ? x * x : limber::fixed::pow(x, y); }
extern "C" float powf(float x, float y) noexcept { return y == 2 ? x * x : limber::fixed::powf(x, y); }

// GNU's functions, which compilers call for a sine and a cosine of the same argument
extern "C" void sincos(double x, double* sine, double* cosine) noexcept {
  const limber::fixed::SinCos both = limber::fixed::sincos(x);
  *sine = both.sin;
  *cosine = both.cos;
}
extern "C" void sincosf(float x, float* sine, float* cosine) noexcept {
  const limber::fixed::SinCos both = limber::fixed::sincos(double{x});
  *sine = static_cast<float>(both.sin);
  *cosine = static_cast<float>(both.cos);
}

namespace limber::fixed {
namespace {

using Unary = double (*)(double);
using Binary = double (*)(double, double);
using FloatUnary = float (*)(float);
using FloatBinary = float (*)(float, float);

template <class Function>
system::SymbolBinding binding(std::string_view name, Function* function) {
  return {name, reinterpret_cast<void*>(function)};
}

}  // namespace

// False if the linker left these symbols out of the table of exported ones.
bool is_libm_replaced() {
  return system::find_symbol("sin") == reinterpret_cast<void*>(static_cast<Unary>(&::sin)) &&
         system::find_symbol("exp") == reinterpret_cast<void*>(static_cast<Unary>(&::exp)) &&
         system::find_symbol("pow") == reinterpret_cast<void*>(static_cast<Binary>(&::pow)) &&
         system::find_symbol("acosf") == reinterpret_cast<void*>(static_cast<FloatUnary>(&::acosf)) &&
         system::find_symbol("sincosf") == reinterpret_cast<void*>(&::sincosf);
}

std::size_t bind_libm() {
  static const std::size_t count = [] {
#define LIMBER_BIND(name) \
  binding(#name, static_cast<Unary>(&::name)), binding(#name "f", static_cast<FloatUnary>(&::name##f))
#define LIMBER_BIND2(name) \
  binding(#name, static_cast<Binary>(&::name)), binding(#name "f", static_cast<FloatBinary>(&::name##f))
    const std::array bindings{LIMBER_BIND(sin),
                              LIMBER_BIND(cos),
                              LIMBER_BIND(tan),
                              LIMBER_BIND(asin),
                              LIMBER_BIND(acos),
                              LIMBER_BIND(atan),
                              LIMBER_BIND(exp),
                              LIMBER_BIND(exp2),
                              LIMBER_BIND(log),
                              LIMBER_BIND(log2),
                              LIMBER_BIND(log10),
                              LIMBER_BIND(sinh),
                              LIMBER_BIND(cosh),
                              LIMBER_BIND(tanh),
                              LIMBER_BIND(cbrt),
                              LIMBER_BIND2(atan2),
                              LIMBER_BIND2(hypot),
                              LIMBER_BIND2(pow),
                              binding("sincos", &::sincos),
                              binding("sincosf", &::sincosf)};
    return system::bind_symbols({"libluajit-5.1.", "libBulletDynamics", "libBulletCollision", "libLinearMath"},
                                bindings);
  }();
  return count;
}

}  // namespace limber::fixed
