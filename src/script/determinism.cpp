// x ^ 2 in a script: LuaJIT's compiled code multiplies, its interpreter calls pow(), and the two differ in the last bit
// now and then. When a loop gets compiled depends on addresses, so a run would not repeat. The program's own pow(),
// which the dynamic linker prefers to the C library's for LuaJIT too, gives the product in both.
#include "base/system/process.h"

extern "C" double pow(double x, double y) noexcept;

extern "C" double pow(double x, double y) noexcept {
  using Function = double (*)(double, double);
  static const auto library = reinterpret_cast<Function>(limber::system::next_symbol("pow"));
  return y == 2 ? x * x : library(x, y);
}
