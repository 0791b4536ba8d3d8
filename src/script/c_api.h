// What the trusted Lua prelude calls in C++: a struct of function pointers, made from c_api.inc. [sim]
#pragma once

#include <cstdint>
#include <string>

namespace limber {

#define LIMBER_STRUCT(...) __VA_ARGS__
#define LIMBER_CALL(result, name, arguments)
#include "script/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT

/// What most calls answer.
inline constexpr std::int32_t kOk = 0;
inline constexpr std::int32_t kClamped = 1;   ///< Done, with the value brought into its range; how: the answer's text.
inline constexpr std::int32_t kRefused = -1;  ///< Nothing was done; why: the answer's text.
inline constexpr std::int32_t kGone = -2;     ///< The thing no longer exists.

struct LimberApi {
#define LIMBER_STRUCT(...)
#define LIMBER_CALL(result, name, arguments) result(*name) arguments;
#include "script/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT
};

/// The functions themselves, in calls_*.cpp.
namespace calls {
#define LIMBER_STRUCT(...)
#define LIMBER_CALL(result, name, arguments) result name arguments;
#include "script/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT
}  // namespace calls

/// The one table of them.
const LimberApi& limber_api();
/// The same declarations as text for LuaJIT's ffi.cdef.
const std::string& limber_cdef();

}  // namespace limber
